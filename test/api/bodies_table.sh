#!/bin/bash
# bodies.csv: the angle of bodies in 2-D over whole turns, also after a resume; checkpoints that know no works.
# usage: bodies_table.sh PROGRAM     works in a fresh folder that it removes; last line: "N passed, N failed"
set -uo pipefail
. "$(dirname "$0")/checks.sh" "$1"

cat > spin.json <<'END2'
{ "dimension": 2, "domain": { "min": [0, 0], "max": [2, 1] }, "spacing": 0.05, "end_time": 2, "gravity": [0, 0],
  "method": "mlsmpm",
  "bodies": [ { "name": "top", "box": { "min": [0.3, 0.4], "max": [0.7, 0.6] }, "dynamics": "free",
                "angular_velocity": [0, 0, -10], "density": 1000 },
              { "name": "rotor", "box": { "min": [1.3, 0.4], "max": [1.7, 0.6] },
                "motion": { "rotation": { "axis": [0, 0, 1], "center": [1.5, 0.5], "rate": 450 } } } ],
  "output": { "interval": 0.25 } }
END2
# Columns by name: 10 rad/s are 572.957795 degrees/s, and 80 kg of 0.4 m by 0.2 m have 80/60 kg m2.
rows='FNR == 1 { for (k = 1; k <= NF; k++) at[$k] = k; next }'
expect 0 "" run spin.json --out whole --quiet
check "angles go on over whole turns" \
    awk -F, "$rows"' { due = ($2 == "top" ? -572.957795 : 450)*$1 } ($at["angle"] - due)^2 > 1e-10 { bad = 1 }
                     END { exit bad || NR != 19 }' whole/bodies.csv
check "a top has half of I w^2" \
    awk -F, "$rows"' $2 == "top" && ($at["kinetic_energy"] - 200.0/3)^2 > 1e-10 { bad = 1 } END { exit bad }' \
    whole/bodies.csv
expect 0 "" run spin.json --out parts --quiet --until 1
cp -r parts older
expect 0 "" resume parts --quiet --until 2
check "and after a resume" cmp whole/bodies.csv parts/bodies.csv
# A checkpoint from before works and turns were kept: both count from there on.
for file in older/checkpoints/*.json; do
    $python -c 'import json, sys
state = json.load(open(sys.argv[1])); del state["works"]; json.dump(state, open(sys.argv[1], "w"))' "$file"
done
expect 0 "" resume older --quiet --until 2
check "an older checkpoint goes on, but for whole turns" \
    awk -F, "$rows"' $1 == 2 { off = ($at["angle"] - ($2 == "top" ? -1145.91559 : 900))/360; whole = int(off + (off < 0 ? -0.5 : 0.5)) }
                     $1 == 2 && (off - whole)^2 > 1e-10 { bad = 1 } END { exit bad }' older/bodies.csv
expect 0 "" run spin.json --out solid --quiet --until 0.1 --set dimension=3 --set domain.max='[2,1,1]' \
    --set domain.min='[0,0,0]' --set gravity='[0,0,0]' --set bodies.top.box='{"min":[0.3,0.4,0.4],"max":[0.7,0.6,0.6]}' \
    --set bodies.rotor.box='{"min":[1.3,0.4,0.4],"max":[1.7,0.6,0.6]}' --set bodies.rotor.motion.rotation.center='[1.5,0.5,0.5]'
check "in 3-D there is none" test "$(head -1 solid/bodies.csv | tr , '\n' | grep -cx angle)" = 0
printf 'time,roll,pitch,yaw\n0,0,0,0\n0.1,20,-30,140\n' > turn.csv
expect 0 "" run spin.json --out turned --quiet --until 0.1 --set dimension=3 --set domain.max='[2,1,1]' \
    --set domain.min='[0,0,0]' --set gravity='[0,0,0]' --set bodies.top.box='{"min":[0.3,0.4,0.4],"max":[0.7,0.6,0.6]}' \
    --set bodies.rotor.box='{"min":[-0.2,-0.1,-0.1],"max":[0.2,0.1,0.1]}' --set bodies.rotor.translation='[1.5,0.5,0.5]' \
    --set bodies.rotor.motion='{"keyframes":{"file":"turn.csv","pivot":[1.5,0.5,0.5]}}'
check "roll, pitch and yaw are those of keyframes" \
    awk -F, "$rows"' $1 > 0 && $2 == "rotor" { good = ($at["roll"] - 20)^2 + ($at["pitch"] + 30)^2 + ($at["yaw"] - 140)^2 < 1e-18 }
                     END { exit !good }' turned/bodies.csv
check "in 2-D there are none" test "$(head -1 whole/bodies.csv | tr , '\n' | grep -cx 'roll\|pitch\|yaw')" = 0
check "but the works" test "$(head -1 solid/bodies.csv | tr , '\n' | grep -cx 'work\|contact_work\|motion_work\|force_work')" = 4

# force_work: 6 N along x from rest on 2 kg are 36/4 t^2 J; 4 N of a program on 2 kg against 1 m/s take 4 t - 4 t^2.
cat > pushed.json <<'END2'
{ "dimension": 2, "domain": { "min": [0, 0], "max": [8, 1] }, "spacing": 0.05, "end_time": 0.5, "gravity": [0, 0],
  "method": "mlsmpm", "time_step_max": 0.01,
  "bodies": [ { "name": "pushed", "box": { "min": [0.3, 0.1], "max": [0.7, 0.3] }, "dynamics": "free", "mass": 2,
                "force": [6, 0] },
              { "name": "braked", "box": { "min": [0.3, 0.6], "max": [0.7, 0.8] }, "dynamics": "controlled", "mass": 2,
                "velocity": [1, 0, 0], "control": { "script": "brake.lua" } } ],
  "output": { "interval": 0.1 } }
END2
echo "function control(t, b) return { force = { -4, 0, 0 } } end" > brake.lua
expect 0 "" run pushed.json --out whole --quiet --force
check "the work of a force and of a program" \
    awk -F, "$rows"' { due = $2 == "pushed" ? 9*$1^2 : 4*$1^2 - 4*$1 }
                     ($at["force_work"] - due)^2 > 1e-18 { bad = 1 } END { exit bad || NR != 13 }' whole/bodies.csv
check "and their sum" \
    awk -F, "$rows"' ($at["force_work"] - (13*$1^2 - 4*$1))^2 > 1e-18 { bad = 1 } END { exit bad || NR != 7 }' \
    whole/history.csv
expect 0 "" run pushed.json --out parts --quiet --force --until 0.2
rm -rf older && cp -r parts older
expect 0 "" resume parts --quiet --until 0.5
check "and after a resume" cmp whole/bodies.csv parts/bodies.csv
for file in older/checkpoints/*.json; do
    $python -c 'import json, sys
state = json.load(open(sys.argv[1]))
state["works"].update(bodies=[row[:3] for row in state["works"]["bodies"]])
json.dump(state, open(sys.argv[1], "w"))' "$file"
done
expect 0 "" resume older --quiet --until 0.5
check "a checkpoint that knows no force_work counts from there" \
    awk -F, "$rows"' $1 == 0.5 && $2 == "pushed" && ($at["force_work"] - 9*(0.25 - 0.04))^2 < 1e-18 { good = 1 }
                     END { exit !good }' older/bodies.csv

# air_work and field_work are of runs that have them. What bodies gain is what all works give; it goes on over a resume.
check "without air and frames there are no columns of theirs" test "$(cat whole/bodies.csv whole/history.csv |
    grep -c 'air_work\|field_work')" = 0
moved=(--set 'gravity_in_time={"amplitude": [3, 0], "period": 0.4}' --set bodies.pushed.air_resistance=3)
expect 0 "" run pushed.json --out whole --quiet --force "${moved[@]}"
check "they are the last columns" test "$(for f in bodies history; do head -1 whole/$f.csv | tr , '\n' |
    tail -2 | tr '\n' ' '; done)" = "air_work field_work air_work field_work "
check "they close the balance" \
    awk -F, "$rows"' { off = $at["body_kinetic_energy"] - 1 - $at["force_work"] - $at["air_work"] - $at["field_work"] }
                     off^2 > 1e-12 || ($1 > 0 && !($at["air_work"] < 0)) { bad = 1 } END { exit bad || NR != 7 }' \
    whole/history.csv
expect 0 "" run pushed.json --out parts --quiet --force --until 0.2 "${moved[@]}"
expect 0 "" resume parts --quiet --until 0.5
check "and go on over a resume" cmp whole/bodies.csv parts/bodies.csv
check "in both tables" cmp whole/history.csv parts/history.csv
echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
