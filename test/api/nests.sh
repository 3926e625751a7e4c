#!/bin/bash
# nests of a scene: the same bits by any number of threads and after a resume, messages, what a run leaves and
# what it never touches, commands on their results.
# usage: nests.sh PROGRAM      works in a fresh folder that it removes; last line: "N passed, N failed"
set -uo pipefail
. "$(dirname "$0")/checks.sh" "$1"

cat > tank.json <<'EOF'
{ "method": "isph", "dimension": 2, "domain": { "min": [0, 0], "max": [1.2, 0.5] }, "spacing": 0.025,
  "end_time": 0.3, "threads": 1,
  "fluids": [ { "name": "water", "viscosity": 1e-3, "fill": [ { "box": { "min": [0.1, 0], "max": [1.2, 0.3] } } ] } ],
  "bodies": [ { "name": "piston", "box": { "min": [0.05, 0], "max": [0.1, 0.5] },
                "motion": { "piston": { "depth": 0.3, "absorb": true, "ramp": 0.1, "direction": [1, 0],
                              "regular": { "height": 0.04, "period": 0.8 } } } },
              { "name": "buoy", "box": { "min": [0.5, 0.25], "max": [0.6, 0.35] }, "density": 500,
                "dynamics": "free" } ],
  "probes": [ { "name": "low", "position": [0.55, 0.1] }, { "name": "far", "position": [1.1, 0.1] },
              { "name": "gauge", "kind": "level", "position": [0.4, 0] } ],
  "nests": [ { "name": "buoy", "box": { "min": [0.3, 0], "max": [0.8, 0.5] }, "follow": "buoy", "feedback": true },
             { "name": "end", "box": { "min": [0.9, 0], "max": [1.2, 0.5] }, "refinement": 2 } ],
  "output": { "interval": 0.1, "probe_interval": 0.02, "fields": "velocity,pressure" } }
EOF
tables="history.csv probes.csv bodies.csv nests/buoy/history.csv nests/buoy/probes.csv nests/buoy/bodies.csv
        nests/end/history.csv nests/end/probes.csv nests/end/bodies.csv"
same() { local f; for f in $tables; do cmp "$1/$f" "$2/$f" || return 1; done; }
same_particles() { local f; for f in "" nests/buoy/ nests/end/; do cmp "$1/${f}fluid/fluid_000003.vtu" \
    "$2/${f}fluid/fluid_000003.vtu" || return 1; done; }
for method in isph dfsph; do
    expect 0 "" run tank.json --out whole_$method --quiet --set method=$method
    expect 0 "" run tank.json --out two_$method --quiet --set method=$method --threads 2
    check "$method: the same tables by two threads" same whole_$method two_$method
    check "$method: and the same particles" same_particles whole_$method two_$method
    expect 0 "" run tank.json --out parts_$method --quiet --set method=$method --until 0.1
    expect 0 "" resume parts_$method --quiet --threads 2 --until 0.3
    check "$method: the same tables after a resume" same whole_$method parts_$method
    check "$method: and the same particles" same_particles whole_$method parts_$method
done

check "a buoy is moved by its nest: isph" sh -c 'tail -1 whole_isph/bodies.csv |
    awk -F, "{exit !(\$NF != 0)}" && head -1 whole_isph/bodies.csv | grep -q ",nest_work$"'
check "and measured alone: dfsph" sh -c '! head -1 whole_dfsph/bodies.csv | grep -q nest_'

# Steps of nests take most of the time, so that a stop at any time hits one.
for k in 1 2 3 4 5; do
    rm -rf stop
    timeout -s INT --preserve-status "0.$k" "$program" run tank.json --out stop --quiet > out.txt 2> err.txt || true
    [ -s stop/nests/end/resolved.json ] || continue
    expect 0 "" resume stop --quiet
    check "the same tables after Ctrl-C at 0.$k s" same whole_isph stop
done

# A nest is saved before the scene: with a power cut between them its newest checkpoint is too new.
expect 0 "" run tank.json --out cut --quiet --set output.checkpoint_interval=0.1 --until 0.25
newest=$(ls cut/checkpoints/*.h5 | tail -1)
rm "$newest" "${newest%.h5}.json"
expect 0 "" resume cut --quiet --until 0.3
check "the same tables after a power cut" same whole_isph cut
expect 0 "" run tank.json --out gap --quiet --set output.checkpoint_interval=0.1 --until 0.25
newest=$(ls gap/nests/end/checkpoints/*.h5 | tail -1)
rm "$newest" "${newest%.h5}.json"
expect 1 "remove that, for an earlier one" resume gap --quiet
newest=$(ls gap/checkpoints/*.h5 | tail -1)
rm "$newest" "${newest%.h5}.json"
expect 0 "" resume gap --quiet --until 0.3
check "the same tables from the earlier one" same whole_isph gap
cp -r cut early
rm early/checkpoints/*
expect 1 "has no checkpoint that is as early" resume early --quiet

# A nest is no run that goes on alone.
expect 1 "is a nest, which goes on with the run around it: tobiuo resume" resume whole_isph/nests/end
cp -r whole_isph/nests/end alone
expect 1 "is of a nest, which goes on with the run of the world around it" resume alone

# What is there stays, unless --force: then nests of another scene go, and what is not a run's stays.
cp -r whole_isph kept
rm -r kept/*.* kept/fluid kept/bodies kept/surfaces kept/checkpoints
find kept -type f -exec md5sum {} + > before.txt
expect 1 "holds the results of a run; nothing was changed" run tank.json --out kept --quiet
find kept -type f -exec md5sum {} + > after.txt
check "nothing was changed" cmp before.txt after.txt
cp -r whole_isph forced
echo mine > forced/nests/end/notes.txt
mkdir -p forced/nests/mine
echo mine > forced/nests/mine/history.csv
mkdir out_of_it
echo mine > out_of_it/history.csv
expect 0 "" run tank.json --out forced --quiet --force --set 'nests=[]' --until 0.02
check "the nest of before is gone" test ! -e forced/nests/buoy
check "but not a file of the user in one" test "$(ls forced/nests/end)" = notes.txt
check "nor a folder that was no nest" test -s forced/nests/mine/history.csv
cp -r whole_isph strange
rm -r strange/nests/end
ln -s "$PWD/out_of_it" strange/nests/end
expect 1 "end is a symbolic link" run tank.json --out strange --quiet --force --until 0.02
check "the old results stay" test -s strange/history.csv
expect 0 "" run tank.json --out strange --quiet --force --set 'nests=[]' --until 0.02
check "no link is followed" test -s out_of_it/history.csv
cp -r whole_isph odd
rm -r odd/nests/end
echo mine > odd/nests/end
expect 1 "end is no folder" run tank.json --out odd --quiet --force
sed 's|"name": "end"|"name": "../../out_of_it"|' whole_isph/resolved.json > strange/resolved.json
expect 0 "" run tank.json --out strange --quiet --force --set 'nests=[]' --until 0.02
check "no name leads elsewhere" test -s out_of_it/history.csv

# Mistakes have a place.
$python - <<'EOF'
import json
scene = json.load(open("tank.json"))
scene["nests"] = [{"name": f"n{k}", "box": {"min": [0.9, 0], "max": [1.2, 0.5]}} for k in range(5)]
json.dump(scene, open("five.json", "w"))
EOF
sed 's/"name": "end"/"name": "buoy"/' tank.json > twice.json
expect 1 "twice.json:1" check twice.json
sed 's/"name": "end"/"name": "a\/b"/' tank.json > slash.json
expect 1 "slash.json:12:24: nests[1].name: is not usable as a name" check slash.json
sed 's/"name": "end"/"name": "a b"/' tank.json > blank.json
expect 1 "blank.json:12:24: nests[1].name: \"a b\" names a folder: allowed are letters, digits, _ and -" check blank.json
sed 's/"follow": "buoy"/"follow": "whale"/' tank.json > whale.json
expect 1 "\"whale\" is no body of the scene" check whale.json
for command in check run; do
    refuse() { local text=$1; shift; expect 1 "$text" $command tank.json "$@"; }
    refuse "the box reaches from 0.9 to 1.3 m in x, the domain from 0 to 1.2 m" --set nests.end.box.max=[1.3,0.5]
    refuse "allowed are 4 spacings of the scene, 0.1 m, or more" --set nests.end.box.max=[0.95,0.5]
    refuse "the method wcsph has no nests" --set method=wcsph
    refuse "nests.end.refinement" --set nests.end.refinement=5
    refuse "nests are for liquids alone" --set 'solids=[{"name":"jelly","youngs_modulus":1e4,"fill":[{"box":{"min":[0.9,0.1],"max":[1,0.2]}}]}]'
    expect 1 "five.json" $command five.json
done
check "no refused run leaves a folder" test ! -e out
expect 0 "" check tank.json
check "check names the nests" grep -q "^nest  *end: spacing 0.0125 m, [0-9]* particles" out.txt
cat > dry.json <<'EOF'
{ "method": "isph", "dimension": 2, "domain": { "min": [0, 0], "max": [2, 1] }, "spacing": 0.02, "end_time": 1,
  "fluids": [ { "name": "water", "fill": [ { "box": { "min": [0, 0], "max": [0.4, 0.4] } } ] } ],
  "nests": [ { "name": "wall", "box": { "min": [1.5, 0], "max": [2, 1] }, "refinement": 2 } ] }
EOF
expect 0 "" check dry.json
check "check says what a dry nest may have" grep -q "0 particles at the start, at most 1600 when liquid has come" out.txt
check "and the time until then" grep -q "^wall clock .* to .*, nests by their particles" out.txt
outputs=$(grep "^outputs" out.txt)
expect 0 "" check tank.json --set 'nests=[]'
check "and counts their files" test "$outputs" != "$(grep "^outputs" out.txt)"

# Commands.
if command -v gnuplot > /dev/null; then
    expect 0 "" report whole_isph
    check "nothing is told of bodies that are not in the box" test ! -s err.txt
    check "the report lists its nests" grep -q '<a href="nests/end/report.html">end</a>' whole_isph/report.html
    check "and the time that their steps took" grep -q ', those of nests [0-9.]* s' whole_isph/report.html
    check "which have reports" test -s whole_isph/nests/end/report.html -a -s whole_isph/nests/buoy/report.html
    check "without nests of their own" sh -c '! grep -q "<h2>Nests" whole_isph/nests/end/report.html'
    expect 1 "report.html exists" report whole_isph
    rm -r parts_isph/nests/end
    expect 0 "" report parts_isph
    check "a nest that was deleted is said to be" grep -q "<td>end<td>deleted" parts_isph/report.html
fi
for results in whole_isph whole_isph/nests/end; do
    rm -f p.png
    expect 0 "" picture $results --output 3 --out p.png
    check "a picture of $results" test -s p.png
    expect 0 "" sample $results --line "1,0.1 to 1.1,0.1"
    expect 0 "" foam $results
    expect 1 "is a run in 2-D, which has no surface" surface $results
done
# Pictures show nests in their boxes, of which one goes along with the buoy, or the scene alone.
expect 0 "" picture whole_isph --output 3 --out both.png
check "nothing is told" test ! -s err.txt
expect 0 "" picture whole_isph --output 3 --out alone.png --set output.picture.nests=false
check "nests change the picture" test "$(cmp -s both.png alone.png; echo $?)" = 1
cp -r whole_isph lost
rm -r lost/nests/end lost/surfaces
expect 0 "note: nest 'end' is not drawn at 0.3 s: " picture lost --out lost.png
expect 0 "note: nest 'buoy' is not drawn at 0.3 s: the output has no surface of the body" picture lost --out lost.png
expect 0 "" picture lost --out scene.png --set output.picture.nests=false
check "the scene alone is drawn instead" cmp lost.png scene.png
cp -r whole_isph late
sed -i '/fluid_000003/d' late/nests/end/all.pvd
expect 0 "note: nest 'end' is not drawn at 0.3 s: it has no results of that time" picture late --out late.png
expect 0 "" picture late --output 2 --out late.png
check "but earlier" test ! -s err.txt
expect 0 "" picture whole_isph/nests/end --out own.png
expect 0 "" picture alone --out rim.png
check "a picture of a nest has no rim" test "$(cmp -s own.png rim.png; echo $?)" = 1
expect 0 "" run tank.json --out drawn --quiet --frames --until 0.1
for results in drawn drawn/nests/end drawn/nests/buoy; do
    for k in 0 1; do
        expect 0 "" picture $results --output $k --out r.png
        check "$results: the run draws the same picture $k" cmp r.png $results/frames/frame_00000$k.png
    done
done
expect 0 "" run tank.json --out one --quiet --frames --until 0.01 --set output.picture.nests=false
check "or the scene alone" test "$(cmp -s drawn/frames/frame_000000.png one/frames/frame_000000.png; echo $?)" = 1

# In a nest a body with a program goes as in the scene, and its scene is one that can be read.
echo 'function control(t, body) return { force = { 5, 0, 0 } } end' > push.lua
expect 0 "" run tank.json --out pushed --quiet --until 0.1 --set bodies.buoy.dynamics=controlled \
    --set 'bodies.buoy.control={"script": "push.lua"}'
expect 0 "" picture pushed/nests/buoy --out pushed.png
check "as far as in the scene" $python -c "
import csv
ends = [[row for row in csv.DictReader(open(f'pushed/{folder}bodies.csv')) if row['name'] == 'buoy'][-1]
        for folder in ('', 'nests/buoy/')]
moved, followed = (float(row['position_x']) for row in ends)
raise SystemExit(not (moved > 0.5501 and abs(moved - followed) < 1e-9))"
expect 1 "there is no whole wave" waves whole_isph/nests/buoy
expect 1 "has no sensors of the kind level" waves whole_isph/nests/end
expect 0 "" sweep tank.json --set nests.end.refinement=2,3 --until 0.02 --out s
check "a sweep has the sensors of nests" grep -q "^run,refinement,outcome.*,max end/far_pressure \[Pa\]" s/sweep.csv
expect 0 "" sweep tank.json --set nests.end.refinement=2,3 --until 0.02 --out s --plot end/far_pressure
check "and draws one" grep -q "shows end/far_pressure of all runs" out.txt
echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
