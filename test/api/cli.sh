#!/bin/bash
# The program as users meet it: exit codes, messages, files, stopping and going on.
# usage: cli.sh PROGRAM      works in a fresh folder that it removes; last line: "N passed, N failed"
set -uo pipefail
here=$(cd "$(dirname "$0")" && pwd)
. "$here/checks.sh" "$1"

value() { $python -c 'import json, sys; print(json.load(open(sys.argv[1]))[sys.argv[2]])' "$1" "$2"; }
hash_of() { value "$1/summary.json" state_hash; }
same_hash() { [ "$(hash_of "$1")" = "$(hash_of "$2")" ]; }
# same_results A B: tables and every file of the series, byte for byte
same_results() {
    cmp "$1/history.csv" "$2/history.csv" && cmp "$1/bodies.csv" "$2/bodies.csv" || return 1
    local part
    for part in fluid bodies surfaces; do diff -r "$1/$part" "$2/$part" || return 1; done
    for part in "$1"/*.pvd; do cmp "$part" "$2/$(basename "$part")" || return 1; done
}
# vtk WHAT FILE [KEY=VALUE...]: VTK reads it and finds that (without VTK, code 77, nothing is checked)
vtk() {
    local code=0 what=$1
    shift
    /usr/bin/python3 "$here/read_vtk.py" "$@" > out.txt || code=$?
    check "$what: $(tail -1 out.txt)" test $code = 0 -o $code = 77
}
newest() { find "$1/checkpoints" -name '*.h5' | sort | tail -n 1; }
same_checkpoint() { cmp "$(newest "$1")" "$(newest "$2")"; }
no_parts() { [ -z "$(find "$1" -name '*.part')" ]; }
# A step takes milliseconds here, so tests that stop a run in the middle need a run of about a second.
cat > make_scene.py <<'END'
import sys
name, end, mesh = sys.argv[1:4]
open(mesh, "w").write("\n".join(
    ["v %g %g %g" % (x, y, z) for z in (-.02, .02) for y in (-.02, .02) for x in (-.02, .02)] +
    ["f " + f for f in ("1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6")]) + "\n")
open(name, "w").write("""{   # a small tank with a box that swings in it
  "domain": {"min": [-0.1, -0.1, 0], "max": [0.1, 0.1, 0.2]},
  "gravity": [0, 0, -9.81], "spacing": 0.01, "end_time": %s,
  "fluids": [{"name": "water", "density": 1000, "viscosity": 0.001,
              "fill": [{"box": {"min": [-0.1, -0.1, 0], "max": [0.1, 0.1, 0.1]}}]}],
  "bodies": [{"name": "box", "mesh": "%s", "translation": [0, 0, 0.05], "density": 1000,
              "motion": {"script": "swing.lua", "params": {"way": 0.02}}}],
  "output": {"interval": 0.01, "checkpoint_interval": 0.02}
}""" % (end, mesh))
open("swing.lua", "w").write(
    "function place(t) return params.way * (1 - math.cos(20 * t)), 0, 0, 0, 0, 1, 100 * t end\n")
END
$python make_scene.py tank.json 0.1 box.obj
old=${TOBIUO_SOURCE:-$here/../..}/test/scenes/taichi

# --- usage ------------------------------------------------------------------------------------------
expect 2 "usage: tobiuo"
expect 0 "" --help
expect 0 "" --version
expect 2 "no command 'fly'" fly
expect 2 "no command 'rnu'; did you mean run?" rnu
expect 0 "" -h
check "every command is listed" test "$(grep -cE '^  (run|resume|check|scenes|new|import|plot|inspect|describe|bench|info) ' out.txt)" = 11
for word in "help run" "run --help" "run -h"; do
    expect 0 "" $word
    check "$word lists the options" grep -q -- "--spacing=M" out.txt
done
expect 2 "no command 'rnu'" help rnu
expect 0 "" help resume
check "help says when a run that goes on stops" grep -q "that of the run" out.txt
expect 2 "which SCENE?" run
expect 2 "--nonsense" run --nonsense tank.json
expect 2 "not a positive number" run tank.json --until soon
expect 2 "not a positive number" run tank.json --spacing -1
expect 2 "--threads" run tank.json --threads many
expect 2 "PATH=VALUE" run tank.json --set spacing
expect 2 "which DIR?" resume
expect 2 "DIR is empty" resume ""
expect 2 "SCENE is empty" run ""
expect 0 "" new dam_break "a folder"
check "the command that it names can be pasted" grep -qF "tobiuo run 'a folder'" out.txt
expect 0 "" describe dfsph
check "describe names the unit" grep -q "default" out.txt
expect 1 "nothing is called 'magic'" describe magic
expect 1 "nothing is called 'camra'; did you mean camera?" describe camra
expect 0 "" describe camera
check "any key is found" grep -q "camera.look_at" out.txt
expect 0 "" describe mean_pressure_force_z
check "any column is found" grep -q "bodies.csv, unit N" out.txt
expect 0 "" info
check "info names the version" grep -q "^tobiuo " out.txt
check "info fits on a screen" test "$(wc -l < out.txt)" -le 24
for command in "" describe info scenes; do
    "$program" $command > out.txt 2>&1
    check "no colours in a file: $command" test -z "$(grep $'\033' out.txt)"
done
"$program" --completion > complete.bash
check "the completion is bash" bash -n complete.bash
# complete WORD...: what bash offers for the last word
complete() { bash -c '. ./complete.bash; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _tobiuo
                      echo "${COMPREPLY[@]}"' - tobiuo "$@"; }
check "commands are completed" test "$(complete re)" = "resume report"
check "options are completed" test "$(complete run --sp)" = --spacing
"$program" --man > tobiuo.1
for word in 'tobiuo resume DIR' 'spacing' 'NO_COLOR'; do check "the man page has $word" grep -q "$word" tobiuo.1; done
if command -v man > /dev/null; then
    check "man reads it" test -z "$(man --warnings -l tobiuo.1 2>&1 > /dev/null)"
fi
check "nothing was made so far" test ! -e out

# --- shipped scenes ---------------------------------------------------------------------------------
expect 0 "" scenes
check "scenes have a sentence" grep -q "^  dam_break  *A column of water collapses" out.txt
expect 1 "dam_brake: there is no such scene; did you mean" run dam_brake
expect 1 "dam_break: there is no such scene; did you mean" check dam_break
expect 1 "tnak.json: there is no such scene; did you mean tank.json?" run tnak.json
expect 0 "" new
check "new lists the families" grep -q -- "--gate-speed" out.txt
expect 1 "no shipped scene or family 'dam_brake'; did you mean dam_break?" new dam_brake
expect 1 "no shipped scene or family 'elephant'; \"tobiuo scenes\"" new elephant
expect 0 "" new dam_break
check "new makes a scene" test -s dam_break/scene.json -a ! -e dam_break/README.md
expect 1 "dam_break is there already" new dam_break
(trap '' XFSZ; ulimit -f 4; "$program" new apple_cut cut_short) 2> err.txt && bad "a copy without room succeeds"
check "a copy without room tells the file" grep -q "cut_short/meshes/apple.obj: File too large" err.txt
check "a copy without room leaves nothing" test ! -e cut_short
for scene in twisted_knife floating_box apple_quarters; do      # with files from other folders
    expect 0 "" new $scene copy
    check "a copy of $scene stands alone" test -z "$(grep '"\.\./' copy/scene.json)"
    expect 0 "" check copy
    rm -rf copy
done
rm -rf dam_break

# --- broken input -----------------------------------------------------------------------------------
expect 1 "nowhere.json" run nowhere.json
expect 1 "nowhere.json" check nowhere.json
echo '{ "domain": ' > broken.json
expect 1 "broken.json:" run broken.json
sed 's/"spacing"/"spacng"/; s/"density": 1000, "visc/"density": -5, "visc/' tank.json > wrong.json
expect 1 "spacing" check wrong.json
check "every mistake at once, with its line" test "$(grep -c 'wrong.json:[0-9]*:' err.txt)" -ge 2
sed 's/box.obj/no_such.obj/' tank.json > no_mesh.json
expect 1 "no_such.obj" run no_mesh.json
sed 's/swing.lua/bad.lua/' tank.json > bad_script.json
printf 'function place(t)\n  return oops, 0, 0\nend\n' > bad.lua
expect 1 "bad.lua:2:" run bad_script.json --quiet
printf 'function place(t) while true do end end\n' > bad.lua       # other loops: test_script, with a shorter limit
expect 1 "bad.lua:1: endless loop" check bad_script.json
rm bad.lua && mkfifo bad.lua
for command in check run; do expect 1 "bad.lua: is a pipe; only plain files are read" $command bad_script.json; done
sed 's/"fill": .*/"fill": [] }],/' tank.json > dry.json
expect 1 "fill" run dry.json
expect 1 "particles" check tank.json --set spacing=1e-5 --set 'bodies=[]'
expect 1 "make spacing or output.interval larger" run tank.json --set spacing=1e-5 --set 'bodies=[]'
expect 1 "particles" run tank.json --set spacing=1e-5 --set 'bodies=[]' --force
expect 1 "viscosity" run tank.json --set 'fluids[0].viscosity=thick'
check "nothing was made by runs that cannot start" test ! -e out/tank/fluid
rm -rf out

# --- check ------------------------------------------------------------------------------------------
expect 0 "" check tank.json
check "check counts particles" grep -q "fluid particles  [1-9]" out.txt
expect 0 "" check tank.json --set method=mlsmpm --set 'fluids=[]' \
    --set 'bodies=[{"name": "a", "box": {"min": [0, 0, 0.1], "max": [0.05, 0.05, 0.15]}, "dynamics": "free"}]'
check "check leaves out particles that a scene has none of" test -z "$(grep '^[a-z]* particles  0' out.txt)"
expect 0 "" check tank.json
check "a good mesh needs no note but of the water in its place" test -z "$(grep ^note out.txt |
    grep -v 'water.*particles that would start inside bodies were cut out')"
grep -v "^f 1 3 4 2" box.obj > open.obj
sed 's/box\.obj/open.obj/' tank.json > open.json
expect 0 "" check open.json
check "check says what was repaired" grep -q "^note  .*'box': 1 hole (4 open edges)" out.txt
expect 1 "Multiply its scale by 0.001" check tank.json --set 'bodies[0].scale=[1000,1000,1000]'

# --- scripts that fail in the middle of a run -------------------------------------------------------
rm -f bad.lua; printf 'function place(t) return t < 0.005 and 0 or oops, 0, 0 end\n' > bad.lua
rm -rf failing
expect 1 "bad.lua:1: unknown name 'oops'" run bad_script.json --quiet -o failing
check "a motion that fails is no divergence" test "$(value failing/summary.json outcome)" = failed
sed 's/"motion": {.*}}/"dynamics": "controlled", "control": {"script": "bad.lua"}}/' tank.json > bad_control.json
printf 'function control(t, body) if t > 0.005 then oops() end end\n' > bad.lua
rm -rf failing
expect 1 "bad.lua:1: unknown name 'oops'" run bad_control.json --quiet -o failing
check "nor is a control program that fails" test "$(value failing/summary.json outcome)" = failed
rm -rf failing

# --- size and time ----------------------------------------------------------------------------------
expect 0 "" check tank.json
check "check tells bytes and files" grep -qE "^outputs +11, every 0.01 s: about [0-9.]+ MB in 56 files" out.txt
check "check tells the steps as a range" grep -qE "^time step +[0-9.e-]+ to [0-9.e-]+ s: [0-9]+ to [0-9]+ steps to" out.txt
check "check tells the time of a run" grep -qE "^wall clock +about .* on this machine" out.txt
check "nothing is dear here" test -z "$(grep -e '--force' -e '"adaptive"' out.txt)"
expect 0 "" check tank.json --set time_step=1e-5
check "check tells what a fixed step costs" \
    grep -qE '^time step +fixed, 1e-05 s, about 10000 steps to 0.1 s: up to [0-9.e+]+ times .*"adaptive"' out.txt
huge=(--set output.interval=1e-5 --until 9 --out huge)     # 6 million files
expect 0 "" check tank.json "${huge[@]:0:4}"
check "check says that a run will ask" grep -q "^note .* output.interval larger.* --force" out.txt
expect 1 "make spacing or output.interval larger, output.fields fewer or output.compression zlib, or run with --force" \
    run tank.json "${huge[@]}"
check "nothing was made without --force" test ! -e huge
"$program" run tank.json "${huge[@]}" --force --quiet 2> /dev/null &
pid=$!
while [ ! -e huge/fluid/fluid_000002.vtu ] && kill -0 $pid 2> /dev/null; do sleep 0.01; done
kill -KILL $pid 2> /dev/null
wait $pid 2> /dev/null
check "with --force it runs" test -e huge/fluid/fluid_000002.vtu
rm -rf huge

# --- keyframes --------------------------------------------------------------------------------------
printf 'time,x,yaw\n0,0,0\n0.01,0.0002,1\n0.02,0.0008,2\n' > rows.csv
sed 's/"motion": {.*}}/"motion": {"keyframes": {"file": "rows.csv", "pivot": [0, 0, 0.05]}}}/' tank.json > rows.json
expect 0 "" run rows.json --quiet -o rows --until 0.02
check "the body is where the rows say" $python - rows/bodies.csv <<'END'
import csv, sys
rows = list(csv.DictReader(open(sys.argv[1])))
x = [float(v) for k, v in rows[-1].items() if k.startswith("position_x") or k == "x"]
assert len(x) == 1 and abs(x[0] - 0.0008) < 1e-9, rows[-1]
END
echo "0.02,1,1" >> rows.csv
expect 1 "rows.csv:5: time 0.02 s does not come after" check rows.json
rm -rf rows

# --- a vessel full of liquid ------------------------------------------------------------------------
full=(--quiet --set 'fluids[0].fill[0].box.max=[0.1,0.1,0.2]' --set 'bodies[0].translation=[0,0,0.1]'
      --set 'bodies[0].motion.params.way=0.1')
expect 0 "" run tank.json -o full --until 0.05 "${full[@]}"
expect 0 "the liquid has cavities" run tank.json -o cavity --until 0.05 "${full[@]}" \
       --set dfsph.support=2 --set dfsph.density_tolerance=0.1
rm -rf full cavity

# --- a run ------------------------------------------------------------------------------------------
expect 0 "" run tank.json --quiet
a=out/tank
for file in resolved.json history.csv bodies.csv fluid.pvd bodies.pvd box.pvd all.pvd summary.json \
            fluid/fluid_000000.vtu fluid/fluid_000010.vtu bodies/bodies_000010.vtu \
            surfaces/box_000010.vtp surfaces/box_000010.stl; do
    check "a run leaves $file" test -s $a/$file
done
check "no output beyond the end" test ! -e $a/fluid/fluid_000011.vtu
check "11 rows of history" test "$(wc -l < $a/history.csv)" = 12
check "11 rows of bodies" test "$(wc -l < $a/bodies.csv)" = 12
check "two checkpoints are kept" test "$(find $a/checkpoints -name '*.h5' | wc -l)" = 2
check "no unfinished files" no_parts $a
check "output times are exact" $python - <<END
import csv
rows = list(csv.DictReader(open("$a/history.csv")))
assert [float(r["time"]) for r in rows] == [k * 0.01 for k in range(11)]
END
check "summary.json is whole" $python - <<END
import json
s = json.load(open("$a/summary.json"))
for key in ("steps time wall_s fluid_particles body_particles particle_steps_per_s density_iterations_mean "
            "divergence_iterations_mean density_error_mean density_error_max particles_lost put_back "
            "peak_rss_bytes threads version").split():
    assert key in s, key
assert s["outcome"] == "complete" and abs(s["time"] - 0.1) < 1e-12 and s["steps"] > 10
assert s["fluid_particles"] > 100 and s["threads"] >= 1 and s["peak_rss_bytes"] > 1e6
END

# --- the progress line ------------------------------------------------------------------------------
on_terminal='import pty, sys; pty.spawn(sys.argv[1:])'
progress=("$program" run tank.json --force --out progress --until 0.02 --set spacing=0.006)
"${progress[@]}" > out.txt 2> err.txt
check "no bar in a file" test -z "$(grep -E $'\033|[[]#' err.txt)"
TERM=xterm $python -c "$on_terminal" "${progress[@]}" > tty.txt < /dev/null
check "a bar and the end on a terminal" grep -qaE '\[#*-*\].* left, ends [0-9][0-9]:[0-9][0-9]' tty.txt
check "in colours" grep -qa $'\033\[32m\[' tty.txt
NO_COLOR=1 TERM=xterm $python -c "$on_terminal" "${progress[@]}" > tty.txt < /dev/null
check "NO_COLOR is heeded" test -z "$(grep -a $'\033' tty.txt)"
check "the bar stays without colours" grep -qa '\[#*-*\]' tty.txt
rm -rf progress

# --- streams that are closed or full ----------------------------------------------------------------
sed 's/box\.obj/open.obj/' tank.json > noted.json      # a scene with a note
expect 0 "1 hole" run noted.json --until 0.02 --out streams
for closed in '<&-' '>&-' '2>&-' '<&- >&- 2>&-'; do
    eval '"$program" run noted.json --until 0.02 --out closed > out.txt 2> err.txt '"$closed"; got=$?
    check "closed $closed: exit code 0 (was $got)" test $got = 0
    check "closed $closed: the same results" same_results streams closed
    rm -rf closed
done
ln -s "$old" old_scenes        # the words of a command have no spaces
for command in --help --version "run --help" "describe scene" "check tank.json" info \
               "import old_scenes/rigid_blocks.json --out full.json" \
               "run tank.json --until 0.01 --out full"; do
    got=0; "$program" $command > /dev/full 2> err.txt || got=$?
    check "$command to a full device: exit code 1 (was $got)" test $got = 1
    check "$command to a full device: said so" grep -q "tobiuo: cannot write to standard output" err.txt
done
rm -rf full full.json streams

expect 1 "out/tank: holds the results of a run, and no scene.json; \"tobiuo resume out/tank\"" run out/tank
expect 1 "out/tnak: there is no run to resume (no resolved.json); did you mean out/tank?" resume out/tnak
expect 1 "out/tnak: there is no run to draw (no history.csv); did you mean out/tank?" plot out/tnak
mkdir begun && cp out/tank/resolved.json begun
for path in begun ./begun begun//; do
    expect 1 "there is no run to draw (no history.csv)" plot $path
    check "$path is not told to mean itself" test "$(grep -c 'did you mean' err.txt)" = 0
done
rm -r begun

expect 1 "output.surface: is true or false, must be an object { ... } with write, cell, smoothing, fields" \
    check tank.json --set output.surface=true

# --- never over existing results --------------------------------------------------------------------
before=$(hash_of $a)
echo mine > $a/notes.txt
expect 1 "holds the results of a run" run tank.json --quiet
expect 1 "holds the results of a run" run tank.json
check "a refused run announces no outputs" test ! -s out.txt
check "old results are untouched" test "$(hash_of $a)" = "$before" -a -s $a/history.csv
expect 1 "broken.json:" run broken.json --quiet --force --out $a
check "a broken scene costs nothing, even by force" test -s $a/summary.json
expect 0 "" run tank.json --quiet --force --until 0.02
check "force replaces" test "$(wc -l < $a/history.csv)" = 4 -a ! -e $a/fluid/fluid_000003.vtu
check "force keeps what is not ours" grep -q mine $a/notes.txt
touch a_file
expect 1 "a_file" run tank.json --quiet --out a_file
expect 1 "a_file" run tank.json --quiet --out a_file/below
expect 1 "/proc" run tank.json --quiet --out /proc/tobiuo
mkdir strange && ln -s "$PWD/$a/fluid" strange/fluid
expect 1 "strange/fluid is a symbolic link" run tank.json --quiet --out strange --force
ln -s "$PWD/strange" by_link && rm strange/fluid
expect 0 "" run tank.json --quiet --out by_link --until 0.01
check "a link to the directory itself is followed" test -s strange/history.csv
mkdir locked && chmod a-w locked
if [ ! -w locked ]; then expect 1 "cannot" run tank.json --quiet --out locked/here; fi
# A disk that cannot be written to: that is told, not how much of it is free.
mkdir fixed
if unshare -rm mount -t tmpfs -o ro,size=16k none fixed 2> err.txt; then
    unshare -rm sh -c 'mount -t tmpfs -o ro,size=16k none fixed && exec "$0" run tank.json --out fixed/here' \
        "$program" > out.txt 2> err.txt
    check "a disk that is read-only is told" grep -q "Read-only file system" err.txt
fi

# A full disk, played by a limit on the size of files.
got=0
(trap '' XFSZ; ulimit -f 24; exec "$program" run tank.json --quiet --out full) > out.txt 2> err.txt || got=$?
check "full disk: exit code 1 (was $got)" test $got = 1
check "full disk: said so" grep -q "^tobiuo: .*full/" err.txt
check "full disk: no unfinished files" no_parts full
# Room for all but checkpoints: the run goes on. Then for all.
largest=$(find $a -name "*.vtu" -printf "%k\n" | sort -n | tail -1)
smallest=$(find $a -name "*.h5" -printf "%k\n" | sort -n | head -1)
check "checkpoints are the largest files" test $smallest -gt $((largest + 4))
got=0
(ulimit -f $((largest + 4)); exec "$program" run tank.json --quiet --until 0.02 --out going) > out.txt 2> err.txt || got=$?
check "a checkpoint without room: exit code 3 (was $got)" test $got = 3
check "a checkpoint without room: said once" test "$(grep -c "h5: File too large; the checkpoint of before" err.txt)" = 1
check "a checkpoint without room: said at the end" grep -q "going: not written: the last checkpoint" err.txt
check "a checkpoint without room: all else is there" same_results $a going
check "a checkpoint without room: no unfinished files" no_parts going
expect 0 "" resume going --quiet
check "resumed with room" test -n "$(ls going/checkpoints)"

expect 0 "" check tank.json --set 'solids=[{"name":"s","fill":[{"box":{"min":[0,0,0],"max":[0.1,0.1,0.1]}}]}]'
check "of water and solids together it counts particles" grep -q "^particles        [1-9]" out.txt

# --- scenes of the Taichi program -------------------------------------------------------------------
expect 0 "" check "$old/fish.json" --set end_time=0
check "check tells what the old keys became" grep -q "fluids\[0\].viscosity = 2.0 Pa s" out.txt
check "the particles of the old scene" grep -q "fluid particles  480102" out.txt
expect 0 "" run "$old/rigid_blocks.json" --quiet --out old
check "an old scene's OBJ" test -s old/obj/block_7_000005.obj -a ! -e old/ply
check "five outputs of two fixed steps" test "$(value old/summary.json steps)" = 10
expect 2 "--out says where" import "$old/rigid_blocks.json"
expect 2 "which SCENE?" import
expect 0 "" import "$old/rigid_blocks.json" --out new.json
check "import tells what became of it" grep -q "10000 times water" out.txt
expect 1 "new.json exists" import "$old/rigid_blocks.json" --out new.json
expect 0 "" import "$old/rigid_blocks.json" --out new.json --force --quiet
mkfifo fifo && ln -s new.json link      # like a device: what is no plain file is never replaced
cp "$old/rigid_blocks.json" own.json
expect 1 "own.json: is what the scene is read from; choose another name" import own.json --out ./own.json --force
check "the old scene is whole" cmp own.json "$old/rigid_blocks.json"
expect 1 "it is a FIFO" import "$old/rigid_blocks.json" --out fifo --force --quiet
expect 1 "it is a symbolic link" import "$old/rigid_blocks.json" --out link --force --quiet
expect 1 "native scene already" import new.json --out newer.json
echo '{}' > nothing.json
expect 1 "native scene already, or none" import nothing.json --out newer.json
check "and nothing else" test "$(wc -l < err.txt)" = 1
expect 1 "nowhere.json" import nowhere.json --out newer.json
expect 0 "" run new.json --quiet --out imported
check "an imported scene gives the same results" same_results old imported
check "an imported scene gives the same state" same_hash old imported
expect 0 "" run "$old/blocks_y_up.json" --quiet --out blocks --frames --until 0.02
check "an old scene's PLY and pictures" test -s blocks/ply/fluid_000002.ply -a -s blocks/frames/frame_000002.png
# Meshes: beside the scene, in the working directory, in the folders above the scene.
mkdir -p deep/data/scenes deep/data/models deep/elsewhere
sed 's/"RigidBlocks": .*/"RigidBodies": [ { "geometryFile": ".\/data\/models\/it.obj", "translation": [0.6, 0.2, 0.2] } ] }/; /"RigidBodies"/q' \
    "$old/rigid_blocks.json" > deep/data/scenes/it.json
expect 1 "RigidBodies[0].geometryFile (here bodies[0].mesh): cannot find" check deep/data/scenes/it.json
mkdir -p data/models && cp box.obj data/models/it.obj
expect 0 "" check deep/data/scenes/it.json
check "a mesh in the working directory" grep -q "$PWD/data/models/it.obj" out.txt
cp box.obj deep/data/models/it.obj && rm -r data
expect 0 "" check deep/data/scenes/it.json
check "a mesh above the scene" grep -q "deep/data/models/it.obj" out.txt
expect 0 "" import deep/data/scenes/it.json --out deep/it.json --quiet
check "a mesh below the new scene has a relative path" grep -q '"data/models/it.obj"' deep/it.json

expect 0 "" import "$old/parameters.py" --out cut.json
check "import tells what Python numbers became" grep -q "output.interval = 0.002 s" out.txt
expect 0 "" check cut.json
check "the blade has an edge" grep -q "cuts with an edge of 0.24 m" out.txt
sed 's/^dt = 1e-4/dt = 1e-4 + ms/' "$old/parameters.py" > bad.py
expect 1 'bad.py:7:13: the name "ms" is given nowhere above' check bad.py

# --- the same bits ----------------------------------------------------------------------------------
expect 0 "" run tank.json --quiet --out one --threads 1
expect 0 "" run tank.json --quiet --out two --threads 2
check "1 thread = 2 threads" same_results one two
check "1 thread = 2 threads, state" same_hash one two
check "1 thread = 2 threads, checkpoint" same_checkpoint one two
expect 0 "" run one/resolved.json --quiet --out again
check "resolved.json gives the same results" same_results one again
check "resolved.json gives the same state" same_hash one again
check "resolved.json resolves to itself" diff <(sed '/threads/d' one/resolved.json) <(sed '/threads/d' again/resolved.json)

# --- stopping and going on --------------------------------------------------------------------------
$python make_scene.py long.json 0.2 box.obj
expect 0 "" run long.json --quiet --out whole
expect 0 "" run long.json --quiet --out gap --until 0.1
sed -i -e 3d -e 6d gap/history.csv
expect 0 "results in gap: history.csv lacks rows of earlier outputs: 2" resume gap --quiet --until 0.2
check "which is said once" test "$(grep -c lacks err.txt)" = 1
expect 0 "" run long.json --quiet --out halves --until 0.1
cp -p swing.lua good.lua && echo 'params.none()' > swing.lua
expect 1 "swing.lua:1: " resume halves
mv good.lua swing.lua
expect 0 "" resume halves --quiet --until 0.15
expect 1 "end_time: is 1e+300, allowed is 0 to 1e9 s" resume halves --quiet --until 1e300
expect 0 "" resume halves --quiet --until 0.2
check "run = run + resume" same_results whole halves
check "run = run + resume, state" same_hash whole halves
check "run = run + resume, checkpoint" same_checkpoint whole halves
check "same number of steps" test "$(value whole/summary.json steps)" = "$(value halves/summary.json steps)"

# start_run DIR OUTPUT: starts a run and waits for an output or for its end; in $pid its number and its group's
start_run() {
    setsid "$program" run long.json --quiet --out "$1" > out.txt 2> err.txt &
    pid=$!
    while [ ! -e "$1/fluid/fluid_$2.vtu" ] && kill -0 $pid 2> /dev/null; do sleep 0.01; done
}
for signal in INT TERM; do
    start_run stopped_$signal 000007
    kill -$signal -- -$pid      # as a terminal does: the script's process gets it too
    got=0; wait $pid || got=$?
    check "SIG$signal: exit code 130 (was $got)" test $got = 130
    check "SIG$signal: summary says interrupted" grep -q '"interrupted"' stopped_$signal/summary.json
    check "SIG$signal: no unfinished files" no_parts stopped_$signal
    expect 0 "" resume stopped_$signal --quiet --threads 2
    check "SIG$signal + resume = run" same_results whole stopped_$signal
    check "SIG$signal + resume = run, state" same_hash whole stopped_$signal
    check "SIG$signal + resume = run, checkpoint" same_checkpoint whole stopped_$signal
done
for output in 000001 000005 000012; do
    start_run killed_$output $output
    sleep 0.0$((RANDOM % 10))
    kill -KILL $pid 2> /dev/null
    wait $pid 2> /dev/null
    vtk "kill -9 after $output: all.pvd names whole files" killed_$output/all.pvd
    expect 0 "" resume killed_$output --quiet
    check "kill -9 after $output + resume = run" same_results whole killed_$output
    check "kill -9 after $output + resume = run, state" same_hash whole killed_$output
    check "kill -9 after $output + resume = run, checkpoint" same_checkpoint whole killed_$output
    check "kill -9 after $output: no unfinished files" no_parts killed_$output
done

# A signal within a solve that takes minutes: the step is given up, the state is that of the step before.
cat > solve.json << 'END'
{ "dimension": 2, "domain": { "min": [0, 0], "max": [1, 1] }, "spacing": 0.01, "end_time": 1,
  "dfsph": { "divergence_iterations_min": 1000000, "divergence_iterations_max": 1000000 },
  "fluids": [ { "name": "water", "fill": [ { "box": { "min": [0, 0], "max": [0.5, 0.5] } } ] } ] }
END
"$program" run solve.json --quiet --out solve > out.txt 2> err.txt &
pid=$!
while [ ! -e solve/fluid.pvd ] && kill -0 $pid 2> /dev/null; do sleep 0.01; done
sleep 0.5
kill -TERM $pid
for _ in $(seq 30); do kill -0 $pid 2> /dev/null && sleep 0.1; done
kill -KILL $pid 2> /dev/null
got=0; wait $pid || got=$?
check "SIGTERM within a solve: exit code 130 within 3 s (was $got)" test $got = 130
check "SIGTERM within a solve: summary says interrupted" grep -q '"interrupted"' solve/summary.json
check "SIGTERM within a solve: no step was made" test "$(value solve/summary.json steps)" = 0

# Steps that would take years.
expect 1 "allowed is 1e-7 to 1e5 m" check long.json --spacing 5e-324
expect 1 "gets nowhere" run long.json --quiet --out stalled --set 'fluids[0].viscosity=1e9'
check "a run that gets nowhere: summary says stalled" grep -q '"stalled"' stalled/summary.json

start_run busy 000002
expect 1 "another run" resume busy --quiet
kill -INT $pid; wait $pid

# --- deleted results --------------------------------------------------------------------------------
start_run deleted 000003
rm -r deleted/fluid
got=0; wait $pid || got=$?
check "deleted during a run: exit code 0 (was $got)" test $got = 0
check "deleted during a run: said so" grep -q "results in deleted: missing files of earlier outputs: [1-9]" err.txt
check "deleted during a run: the state is there" same_hash whole deleted
rm deleted/history.csv
expect 0 "results in deleted: history.csv was deleted and begins anew; missing files" resume deleted --until 0.21

# --- damaged checkpoints ----------------------------------------------------------------------------
expect 0 "" run long.json --quiet --out damaged --until 0.1
truncate -s 1000 "$(newest damaged)"
expect 0 "is damaged" resume damaged --until 0.2
check "the checkpoint before is used" same_results whole damaged
expect 0 "" run long.json --quiet --out ruined --until 0.1
for file in ruined/checkpoints/*.h5; do echo nonsense > "$file"; done
expect 1 "no whole checkpoint" resume ruined
check "a ruined run keeps its finished files" cmp whole/fluid/fluid_000010.vtu ruined/fluid/fluid_000010.vtu
expect 1 "no run to resume" resume nowhere
mkdir empty
expect 1 "no run to resume" resume empty
expect 0 "" resume whole --quiet
check "resuming a finished run changes nothing" same_results whole halves

# --- solids -----------------------------------------------------------------------------------------
cat > solids.json <<'END'
{ "method": "mlsmpm",   # a jelly and a ball of snow fall onto a steel plate that lies on sand
  "domain": { "min": [0, 0, 0], "max": [0.6, 0.4, 0.4], "friction": 0.4,
              "walls": { "x": "separate", "y": "separate", "z": ["no-slip", "separate"] } },
  "spacing": 0.02, "end_time": 0.2,
  "solids": [
    { "name": "jelly", "density": 900, "youngs_modulus": 5e4, "color": [200, 60, 60],
      "fill": [ { "sphere": { "centre": [0.15, 0.2, 0.25], "radius": 0.1 }, "spin": [0, 8, 0] } ] },
    { "name": "snow", "model": "snow", "density": 400, "youngs_modulus": 1e5, "hardening": 10,
      "fill": [ { "sphere": { "centre": [0.42, 0.2, 0.25], "radius": 0.1 }, "velocity": [-1, 0, -2] } ] },
    { "name": "sand", "model": "sand", "mass": 30,
      "fill": [ { "box": { "min": [0, 0, 0], "max": [0.6, 0.4, 0.08] } } ] } ],
  "bodies": [ { "name": "plate", "box": { "min": [0.1, 0.1, 0.08], "max": [0.5, 0.3, 0.11] } } ],
  "output": { "interval": 0.02, "checkpoint_interval": 0.04, "grid": true, "fields": ["usual", "stress", "J"] }
}
END
same_solids() {
    cmp "$1/history.csv" "$2/history.csv" && same_hash "$1" "$2" || return 1
    local part
    for part in fluid grid; do diff -r "$1/$part" "$2/$part" && cmp "$1/$part.pvd" "$2/$part.pvd" || return 1; done
}
expect 0 "" check solids.json
check "check names the solids" grep -q "solid  *jelly: [0-9]* particles, 3.77 kg, 900 kg/m3, time step" out.txt
check "a mass makes the density" grep -q "sand: 2400 particles, 30 kg, 1563" out.txt
cat > covered.json <<'END'
{ "method": "mlsmpm", "domain": { "min": [0, 0, 0], "max": [1, 1, 1] }, "spacing": 0.1, "end_time": 0.1,
  "solids": [ { "name": "core", "fill": [ { "sphere": { "centre": [0.5, 0.5, 0.5], "radius": 0.01 } } ] } ],
  "bodies": [ { "name": "lid", "box": { "min": [0.3, 0.3, 0.3], "max": [0.6, 0.6, 0.7] } } ] }
END
for does in check run; do
    expect 1 "solid 'core': of the 1 that it would start with, 1 lie inside bodies" $does covered.json
    expect 0 "" $does covered.json --set 'bodies[0].translation=[0.3,0,0]'
done
expect 0 "is longer than" run solids.json --out cut --set time_step=0.01 --until 0.001
expect 0 "" run solids.json --quiet --out solids --threads 1
expect 0 "" run solids/resolved.json --quiet --out solids_2 --threads 2
check "solids: 1 thread = 2 threads, resolved.json = scene" same_solids solids solids_2
"$program" run solids.json --quiet --out solids_int > out.txt 2> err.txt &
pid=$!
while [ ! -e solids_int/fluid/fluid_000003.vtu ] && kill -0 $pid 2> /dev/null; do sleep 0.01; done
kill -INT $pid
got=0; wait $pid || got=$?
check "solids, SIGINT: exit code 130 (was $got)" test $got = 130
expect 0 "" resume solids_int --quiet --threads 2
check "solids, SIGINT + resume = run" same_solids solids solids_int
# A blade: neither checkpoints nor a restart may make it find its cut anew.
slicing=${TOBIUO_SOURCE:-$here/../..}/scenes/slicing
cut() { expect 0 "" run "$slicing" --quiet --spacing 0.007 --set end_time=0.2 --threads 1 "$@"; }
same_cut() { cmp "$1/history.csv" "$2/history.csv" && cmp "$1/bodies.csv" "$2/bodies.csv" && same_hash "$1" "$2"; }
cut --out cut_whole
cut --out cut_halves --until 0.1
expect 0 "" resume cut_halves --quiet --until 0.2 --threads 2
check "cut: run = run + resume" same_cut cut_whole cut_halves
cut --out cut_often --set output.checkpoint_interval=0.003
check "cut: checkpoints change nothing" same_cut cut_whole cut_often
vtk "VTK reads the grid" solids/grid/grid_000010.vtu 'arrays={"velocity": 3, "mass": 1, "stress": 6}'
vtk "VTK reads the solids" solids/fluid/fluid_000010.vtu 'arrays={"velocity": 3, "pressure": 1, '\
'"density": 1, "object_id": 1, "particle_id": 1, "von_mises": 1, "material": 1, "stress": 6, "J": 1}' \
    'ranges={"object_id": [0, 0]}'
vtk "VTK reads the bodies" solids/bodies/bodies_000010.vtu 'ranges={"object_id": [1, 1]}' \
    'arrays={"velocity": 3, "density": 1, "particle_id": 1}' 'lacks=["pressure", "material", "stress", "J", "von_mises"]'
vtk "one list of all" solids/all.pvd \
    "times=$($python -c 'print([t*0.02 for t in range(11) for part in range(4)])')" \
    "parts=$($python -c 'print(list(range(4))*11)')" \
    "names=$($python -c 'import json; print(json.dumps(["fluid", "bodies", "grid", "plate"]*11))')"
expect 1 "there is no field \"surface\"" check solids.json --set output.fields=surface
expect 0 "" bench wcsph --spacing 0.04 --steps 3 --settle 1
check "bench wcsph: a hash" grep -q "^state  *[0-9a-f]*$" out.txt
expect 0 "" bench ball --spacing 0.04 --steps 3 --settle 1 --csv bench.csv
check "bench ball: ns" grep -q "ns per particle and step and core" out.txt
check "bench ball: a hash" grep -q "^state  *[0-9a-f]*$" out.txt
expect 0 "" bench small --spacing 0.04 --steps 3 --settle 1 --csv bench.csv
check "bench --csv: a header and a row each" test "$(awk -F, '{ printf "%s ", $1 }' bench.csv)" = "case ball small "
check "bench --csv: the hash that is printed" grep -q ",$(sed -n 's/^state *//p' out.txt)\$" bench.csv
expect 1 "none/bench.csv: No such file or directory" bench ball --spacing 0.04 --steps 3 --settle 1 --csv none/bench.csv

echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
