#!/bin/bash
# tobiuo new, sweep and import of folders: every family is checked and stepped, a sweep goes on and compares.
# usage: tanks.sh PROGRAM      works in a fresh folder that it removes; last line: "N passed, N failed"
set -uo pipefail
. "$(dirname "$0")/checks.sh" "$1"

# rows FILE: its lines
rows() { wc -l < "$1"; }

# --- families ---------------------------------------------------------------------------------------
expect 0 "" new
families=$(sed -n 's/^  \([a-z_]*\)  .*/\1/p' out.txt | grep -v '^of$')
check "eight families" test "$(echo "$families" | wc -w)" = 8
coarse() { case $1 in wave_impact) echo 0.08 ;; wave_tank | sloshing) echo 0.05 ;; hose) echo 0.005 ;; *) echo 0.025 ;; esac; }
for family in $families; do
    for method in isph eisph dfsph wcsph; do
        expect 0 "" new $family --spacing "$(coarse $family)" --method $method "$family.$method"
        expect 0 "" run "$family.$method" --quiet --until 0.02 --out "out_$family.$method"
        check "$family by $method ran" grep -q '"outcome": "complete"' "out_$family.$method/summary.json"
        check "$family by $method lost nothing" grep -q '"particles_lost": 0' "out_$family.$method/summary.json"
    done
    expect 0 "" check "$family.isph"
done
expect 0 "" new static_pressure --spacing 0.0125 --support=2.4
check "as users name it" test -s static_pressure_PS0d0125_CSML2d4_RK2/scene.json
expect 0 "" check static_pressure_PS0d0125_CSML2d4_RK2
expect 1 "cannot make the folder '': No such file or directory" new static_pressure ""
expect 1 "is there already" new static_pressure --spacing 0.0125 --support=2.4
expect 0 "" new --dimension 2 --method dfsph dam_break --spacing 0.02
check "2-D and another method" test -s dam_break_2d_PS0d02_dfsph/scene.json
expect 0 "" new lobovsky --gate-speed 3 --spacing 0.03 gated
expect 0 "" run gated --quiet --until 0.01 --out out_gated
expect 2 "there is no family 'slosing'; did you mean sloshing?" new slosing --spacing 1
expect 2 "ball_drop is a shipped scene: it takes no options" new ball_drop --spacing 0.02 ball
expect 2 "sloshing has no option --spcing; did you mean --spacing?" new sloshing --spcing 0.1
expect 2 "--spacing wants a value" new sloshing --spacing
expect 2 "--dimension: '4' is not a whole number from 2 to 3" new sloshing --dimension 4
expect 2 "--dimension: '2.5' is not a whole number from 2 to 3" new sloshing --dimension 2.5
expect 2 "--support: '1' is not a number from 2 to 4 spacings" new sloshing --support 1
expect 0 "" new static_pressure --support 0 own
check "no blank at the end of a message" test "$(grep -c ' $' err.txt)" = 0
expect 2 "--angle: '50' is not a number from -45 to 45 degrees" new sloshing --angle 50
expect 2 "'isp' is no method of liquids; did you mean isph?" new sloshing --method isp
expect 2 "one FAMILY and one DIR only" new sloshing --angle 5 a b
expect 2 "one SCENE only; a value is changed by --set cfl=0.2,0.4" sweep scene.json cfl=0.2,0.4
expect 1 "kamra is 3-D only" new kamra --dimension 2
expect 1 "the water is higher than the tank, --height" new static_pressure --depth 9
expect 1 "the water is longer than the tank, --length" new dam_break --water-length 1
expect 1 "the water reaches the post" new kamra --water-length 0.7
expect 2 "--post: '0.5' is not a whole number from 0 to 2" new kamra --post 0.5
expect 1 "the box does not fit" new wave_impact --box-at 3.2
expect 1 "the box is wider" new wave_impact --box-width 2
expect 1 "--wave-height is more than 0.78 of --depth: such waves break" new wave_tank --wave-height 0.3
expect 1 "the piston stands beyond the tank" new wave_tank --length 4 --maker-at 5
expect 1 "piston and beach fill the tank" new wave_tank --length 2
expect 1 "the far end has --slope or --beach, not both" new wave_tank --slope 10 --beach 1
expect 1 "piston and slope fill the tank: give more --length" new wave_tank --slope 10 --length 4
expect 1 "a solitary wave, --period 0, has neither --ramp nor --beach" new wave_tank --period 0 --beach 2
expect 1 "the glass is full before" new hose --depth 0.1
expect 1 "the hose is wider than the glass" new hose --diameter 0.1
for more in "sloshing --period 1.4" "sloshing --dimension 2 --period 1.4" "wave_tank --dimension 2 --period 0" \
        "wave_tank --dimension 2 --slope 5" "wave_tank --slope 4 --period 0" "hose --dimension 2"; do
    expect 0 "" new $more --spacing "$(coarse ${more%% *})" --method dfsph more
    expect 0 "" run more --quiet --until 0.02 --force --out out_more
    rm -rf more
done
# Air in the rest of the tank: all of it is full, by isph alone.
for more in "sloshing --dimension 2 --spacing 0.05" "dam_break --dimension 2 --spacing 0.025" "dam_break --spacing 0.05"; do
    expect 0 "" new $more --air 1.2 more
    expect 0 "" run more --quiet --until 0.01 --force --out out_more
    case $more in sloshing*) full=0.45 ;; *2*) full=0.5 ;; *) full=0.075 ;; esac
    check "$more: air fills the tank" python3 -c 'import json, sys
d = json.load(open("out_more/resolved.json"))["spacing"]; n = json.load(open("out_more/summary.json"))["fluid_particles"]
sys.exit(abs(n*d**int(sys.argv[2])/float(sys.argv[1]) - 1) > 0.05)' $full "$(case $more in *--dimension*) echo 2 ;; *) echo 3 ;; esac)"
    rm -rf more
done
expect 1 "1 : 10" new sloshing --air 1.2 --method dfsph more
# A wave tank by its defaults: steady waves in front of the beach, little behind it.
expect 0 "" new wave_tank --dimension 2 --spacing 0.03 waves
for text in '"ramp": 2.4,' '"damping_zones": \[ { "box": { "min": \[3.9, 0\], "max": \[5.7, 0.5\]' '"end_time": 13.2,'; do
    check "the wave tank has $text" grep -q "$text" waves/scene.json
done
expect 0 "" run waves --quiet --until 10.8 --out out_waves
height() {     # COLUMN PERIOD-NUMBER: its largest less its least value, mm
    awk -F, -v name="$1" -v n="$2" 'NR == 1 { for (k = 1; k <= NF; k++) if ($k == name) c = k; next }
        $1 >= (n - 1)*1.2 && $1 < n*1.2 { if (!seen++ || $c > high) high = $c; if (seen == 1 || $c < low) low = $c }
        END { printf "%.1f\n", 1000*(high - low) }' out_waves/probes.csv
}
check "waves of 60 mm, steady" python3 -c 'import sys; h = [float(x) for x in sys.argv[1:]]
sys.exit(not (0.9*60 < min(h) and max(h) < 1.1*60 and max(h) - min(h) < 0.06*60))' "$(height "G1_level [m]" 7)" \
    "$(height "G1_level [m]" 8)" "$(height "G1_level [m]" 9)"
check "the beach takes them" python3 -c 'import sys; sys.exit(not float(sys.argv[1]) < 0.5*60)' "$(height "end_level [m]" 9)"
expect 0 "" new wave_tank --dimension 2 --period 2.5 --wave-height 0.1 long_waves
check "long waves by the first order" grep -q '"order": 1' long_waves/scene.json
expect 0 "" new wave_tank --beach 0 --length 4 --spacing 0.1 walled
check "a tank without a beach" test "$(grep -c damping_zones walled/scene.json)" = 0
# The far end goes down first in both dimensions: the water rises there.
for dimension in 2 3; do
    expect 0 "" new sloshing --period 1.4 --spacing 0.05 --dimension $dimension more
    expect 0 "" run more --quiet --until 0.5 --force --out out_more
    check "the far end is lowered in $dimension-D" awk -F, 'NR == 1 { for (k = 1; k <= NF; k++) at[$k] = k }
        END { exit !($at["right_level [m]"] > $at["left_level [m]"]) }' out_more/probes.csv
    rm -rf more
done
expect 1 "the water reaches the box" new wave_impact --water-length 2.5
expect 1 "static_pressure: spacing: is 10 m, the domain has only 0.2 m in x" new static_pressure --spacing 10
expect 2 "--width: a 2-D scene has no width; leave it out" new dam_break --dimension 2 --width 0.3 flat_wide
expect 2 "--box-width: a 2-D scene has no width" new wave_impact --box-width=0.3 --dimension=2 flat_wide
check "no scene is written of an option that is not used" test ! -e flat_wide
for family in $families; do
    expect 1 "no scene is written; given: --spacing 10" new $family --spacing 10 absurd
    expect 2 "--spacing: 'nan' is not a number from 1e-07 to 100000 m" new $family --spacing nan absurd
    check "$family left no folder" test ! -e absurd
done
expect 1 "no scene is written; given: --spacing 0.0001" new wave_tank --spacing 1e-4
(trap '' XFSZ; ulimit -f 1; exec "$program" new lobovsky none) > out.txt 2> err.txt
check "a scene without room: said so" grep -q "none/scene.json: File too large" err.txt
check "a scene without room: nothing is left" test ! -e none
(trap '' XFSZ; ulimit -f 1; exec "$program" new raft none) > out.txt 2> err.txt
check "a copy without room: said so" grep -q "none/.*: File too large" err.txt
check "a copy without room: no scene is left" test ! -e none/scene.json
expect 2 "--until: '1e9' is not a number from 1e-06 to 100000 s" new hose --until 1e9

# --- sweeps -----------------------------------------------------------------------------------------
expect 2 "which SCENE?" sweep
expect 2 "--set wants PATH=A,B" sweep x --set spacing
expect 2 "a value is empty" sweep x --set spacing=1,,2
expect 2 "--set spacing=1,2,1: 1 is there twice" sweep x --set spacing=1,2,1
expect 2 "--set spacing is given twice" sweep x --set spacing=1 --set spacing=2
expect 2 "--jobs: '0' is not a number from 1 to 256" sweep x --jobs 0
flat=dam_break_2d_PS0d02_dfsph
expect 1 "--until and --set end_time: one of them" sweep $flat --set end_time=0.01,0.02 --until 0.03
expect 1 "a sweep varies something" sweep $flat
expect 1 'did you mean "spacing"?' sweep $flat --set spacng=1,2
expect 1 "run 1 of 2, method=mlsmpm, cannot be" sweep $flat --set method=dfsph,mlsmpm
check "a wrong sweep runs nothing" test ! -e out/${flat}_sweep
expect 1 "allowed are 10000" sweep $flat --set spacing=0.02,0.03 $(for k in a b c d e f g h i j k l m n; do
    echo --set "x.$k=1,2"; done)
touch file
expect 1 "cannot make the directory file: Not a directory" sweep $flat --set spacing=0.02,0.025 --out file
expect 1 "--only 9: the runs have numbers from 0 to 3" sweep $flat --set spacing=0.02,0.025 --set method=dfsph,wcsph --only 9
sweep=(sweep $flat --set spacing=0.02,0.025 --set method=dfsph,wcsph --until 0.02 --out s)
expect 0 "" "${sweep[@]}" --slurm
check "an array job" grep -q "^#SBATCH --array=0-3" s/sweep.slurm
check "that is a shell script" sh -n s/sweep.slurm
check "whose output may have blanks in its name" grep -q '^#SBATCH --output="s/slurm_%a.txt"' s/sweep.slurm
check "and runs one of them" env SLURM_ARRAY_TASK_ID=1 sh s/sweep.slurm
check "only that one" test -s s/spacing=0.02_method=wcsph/summary.json -a ! -e s/spacing=0.02_method=dfsph
(trap '' XFSZ; ulimit -f 0; exec "$program" sweep $flat --set spacing=0.02,0.025 --out narrow) 2>&1 | cat > out.txt
check "a sweep without room: said so" grep -q "could not write the reason to narrow/spacing=0.02.log" out.txt
check "a sweep without room: no empty table" test -d narrow -a ! -e narrow/sweep.csv
rm -rf narrow
many=$(seq -s, 0.01 0.00001 0.02)
expect 0 "" sweep $flat --set time_step_max=$many --out many --slurm
check "an array job of many runs" grep -q "^#SBATCH --array=0-1000" many/sweep.slurm
check "knows all of them" grep -qF "'time_step_max=$many'" many/sweep.slurm
kept=$(stat -c %Y.%i s/spacing=0.02_method=wcsph/summary.json)
"$program" "${sweep[@]}" --table > out.txt 2> err.txt
check "the table of what there is" test "$(grep -c 'not run' s/sweep.csv)" = 3
if command -v gnuplot > /dev/null; then
    expect 0 "" "${sweep[@]}" --jobs 2 --plot wall_pressure
    check "a plot of all" grep -q "spacing=0.025_method=wcsph" s/sweep.svg
    "$program" "${sweep[@]}" --plot weight > out.txt 2> err.txt
    check "units of 2-D" grep -q "weight, N per m" s/sweep.svg
    "$program" "${sweep[@]}" --plot wall_pressure > out.txt 2> err.txt
    check "means over the spacing" grep -q "s/sweep_means.svg shows its mean over spacing" out.txt
    check "a curve per method" grep -q "method=wcsph" s/sweep_means.svg
    check "of the means" grep -q "mean wall_pressure, Pa" s/sweep_means.svg
    expect 1 'no run has a column "nothing"' "${sweep[@]}" --plot nothing
    expect 0 "" sweep $flat --set probes.wall.name=weight --until 0.02 --out named --plot weight_pressure
    check "a name says nothing of the unit" grep -q "weight_pressure, Pa" named/sweep.svg
else
    "$program" "${sweep[@]}" --jobs 2 > out.txt 2> err.txt
fi
"$program" "${sweep[@]}" --table --from 0.01 > out.txt 2> err.txt
check "means and extremes from a time on" $python - <<'END'
import csv
row = next(csv.DictReader(open("s/sweep.csv")))
probes = list(csv.DictReader(open("s/spacing=0.02_method=dfsph/probes.csv")))
points = [(float(p["time [s]"]), float(p["wall_pressure [Pa]"])) for p in probes if float(p["time [s]"]) >= 0.01]
mean = sum((b[0] - a[0])*(a[1] + b[1])/2 for a, b in zip(points, points[1:]))/(points[-1][0] - points[0][0])
high, low = max(p for _, p in points), min(p for _, p in points)
for due, word in ((mean, "mean"), (high, "max"), (low, "min")):
    if not abs(float(row[word + " wall_pressure [Pa]"]) - due) <= 1e-5*abs(due): raise SystemExit(word)
END
cat > stir.json <<'END'
{ "dimension": 2, "domain": { "min": [0, 0], "max": [0.4, 0.2] }, "spacing": 0.02, "end_time": 0.05,
  "fluids": [ { "name": "oil", "viscosity": 0.1, "fill": [ { "box": { "min": [0, 0], "max": [0.4, 0.16] } } ] } ],
  "bodies": [ { "name": "post", "box": { "min": [0.3, 0], "max": [0.34, 0.2] } },
              { "name": "stirrer", "box": { "min": [0.1, 0.08], "max": [0.2, 0.12] },
                "motion": { "rotation": { "centre": [0.15, 0.1], "rate": 90 } } } ],
  "output": { "interval": 0.01 } }
END
expect 0 "" sweep stir.json --set bodies.stirrer.motion.rotation.rate=90,180 --plot stirrer_motion_power --out stir
check "torque and power of a stirrer, none of a post" $python - <<'END'
import csv
for run in csv.DictReader(open("stir/sweep.csv")):
    rows = list(csv.DictReader(open(f"stir/rate={run['rate']}/bodies.csv")))
    rows = [row for row in rows if row["name"] == "stirrer"]
    if not float(rows[-1]["motion_work"]) > 0: raise SystemExit("no work")
    power = float(rows[-1]["motion_work"])/float(rows[-1]["time"])
    if not abs(float(run["mean stirrer_motion_power [W per m]"])/power - 1) < 1e-5: raise SystemExit("power")
    due = [sum(float(row[f"mean_{part}_torque_z"]) for part in ("pressure", "viscous")) for row in rows[1:]]
    if not abs(float(run["mean stirrer_torque_z [N m per m]"])/(sum(due)/5) - 1) < 1e-5: raise SystemExit("torque")
    if "mean post_motion_power [W per m]" in run: raise SystemExit("post")
END
check "a picture of the power" grep -q "stirrer_motion_power, W per m" stir/sweep.svg
expect 1 "--from 9: no run has values from this time on" "${sweep[@]}" --table --from 9
expect 2 "--from: 'x' is not a number from 0 on" "${sweep[@]}" --from x
check "a row for each" test "$(rows s/sweep.csv)" = 5
check "all complete" test "$(grep -c ',complete,' s/sweep.csv)" = 4
check "the same as text" test "$(rows s/sweep.txt)" = 5
check "what was complete was not run again" test "$kept" = "$(stat -c %Y.%i s/spacing=0.02_method=wcsph/summary.json)"
# A run that was killed is resumed, one of another scene refused, one that failed told.
one=s/spacing=0.025_method=dfsph
rm $one/summary.json
"$program" "${sweep[@]}" > out.txt 2> err.txt
check "a killed run goes on" grep -q "resumed\|complete" $one/summary.json
longer=(sweep $flat --set spacing=0.02,0.025 --set method=dfsph,wcsph --until 0.03 --out s)
expect 1 "s/spacing=0.02_method=dfsph has run to 0.02 s already, beyond 0.01 s" "${sweep[@]}" --until 0.01
expect 0 "" "${longer[@]}"
check "a longer sweep goes on with what there is" test "$(cat s/*/resolved.json | grep -c '"end_time": 0.02,')" = 4
check "to its end" test "$(grep -c ',complete,0.03,' s/sweep.csv)" = 4
sed 's/"end_time"/"time_step_max": 0.001, "end_time"/' $flat/scene.json > other.json
expect 1 "holds results of another scene" sweep other.json "${longer[@]:2}"
sweep=("${longer[@]}")
sed -i 's/"outcome": "complete"/"outcome": "diverged"/' $one/summary.json
"$program" "${sweep[@]}" > out.txt 2> err.txt
check "a failed run is told" grep -q "has failed before; remove s/spacing=0.025_method=dfsph" err.txt

# --- folders of the tank program ----------------------------------------------------------------------
# box FILE X Y Z: a box from 0 to X Y Z, as CAD writes it
box() {
    { for z in 0 $4; do for y in 0 $3; do for x in 0 $2; do echo "v $x $y $z"; done; done; done
      echo "f 1 3 4 2"; echo "f 5 6 8 7"; echo "f 1 2 6 5"; echo "f 3 7 8 4"; echo "f 1 5 7 3"; echo "f 2 4 8 6"
    } > "$1"
}
mkdir -p case obj
box obj/water.obj 0.2 0.1 0.1
box obj/plug.obj 0.4 0.1 0.02
cat > case/setting.json << 'END'
{ "RK_order": 1, "max_dt": 0.002, "end_time_step": 10, "end_time": 2, "CSML": 2.4, "particle_spacing": 0.02,
  "initial_surface_z_position": 0.1, "output_directory": "/Users/x/SPH/case", "input_files": ["tank.json", "water.json"] }
END
echo '{ "name": "tank", "type": "RigidBody", "objfile": "/Users/x/code/../obj/plug.obj" }' > case/tank.json
echo '{ "name": "water", "type": "Fluid", "objfile": "/Users/x/code/../obj/water.obj" }' > case/water.json
expect 0 "" check case
check "check tells whose scene it is" grep -q "A scene of the tank program" out.txt
check "and what became of its keys" grep -q "isph.support = 2.4" out.txt
expect 0 "" run case --quiet
expect 0 "" import case
check "a scene beside the setting" grep -q "# Translated from setting.json, a scene of the tank program" case/scene.json
expect 1 "case/scene.json exists" import case
expect 0 "" import case/setting.json --out case/other.json --quiet
expect 0 "" check case/other.json
expect 1 "case/tank.json: is what the scene is read from" import case --out case/tank.json --force
check "the object is as it was" grep -q RigidBody case/tank.json
rm obj/water.obj
expect 1 'cannot find "/Users/x/code/../obj/water.obj"' import case --force

echo "$passed passed, $failed failed"
[ $failed = 0 ]
