#!/bin/bash
# tobiuo waves --response: gains and phases of motions that are known, messages.
# usage: wave_responses.sh PROGRAM      works in a fresh folder that it removes; last line: "N passed, N failed"
set -uo pipefail
. "$(dirname "$0")/checks.sh" "$1"

cat > flume.py <<'PY'
import json
probes = [{"name": n, "kind": "level", "position": [x, 0.1, 0.4]} for n, x in {"G1": 1, "G2": 1.3, "G3": 1.75}.items()]
box = {"density": 500, "dynamics": "free"}
json.dump({"domain": {"min": [0, 0, 0], "max": [6, 0.2, 0.6]}, "spacing": 0.1, "end_time": 0.01,
           "fluids": [{"name": "water", "fill": [{"box": {"min": [0, 0, 0], "max": [6, 0.2, 0.4]}}]}],
           "bodies": [{"name": "raft", "box": {"min": [3, 0, 0.3], "max": [3.4, 0.2, 0.5]}, **box},
                      {"name": "post", "box": {"min": [5, 0, 0], "max": [5.2, 0.2, 0.6]}}],
           "lines": [{"name": "rope", "kind": "rope", "body": "raft", "point": [3, 0.1, 0.4], "to": [2, 0.1, 0.4],
                      "length": 1, "stiffness": 10}],
           "probes": probes, "output": {"interval": 0.01}}, open("flume.json", "w"))
PY
$python flume.py
expect 0 "" run flume.json --out whole --quiet

# A sea that goes on and by 30 % comes back; the raft follows what goes on: x with gain 0.6, 40 degrees early, z with
# 1.2 and 25 late; it turns about y by 90 degrees per m, from 3 degrees on. At (3.2, 0.1). The rope pulls 5 N and 200 N
# per m of wave at G1.
cat > records.py <<'PY'
import math, random, sys
regular = "regular" in sys.argv
random.seed(5)
def number(f):
    k = deep = (2*math.pi*f)**2/9.81
    for _ in range(200): k = 0.5*(k + deep/math.tanh(k*0.4))
    return k
def density(f):
    r = f*1.4
    return r**-5*math.exp(-1.25*r**-4)*3.3**math.exp(-(r - 1)**2/(2*(0.07 if r <= 1 else 0.09)**2))
frequencies = [1/1.3] if regular else [0.36 + 0.012*(k + random.random()) for k in range(100)]
sizes = [0.03] if regular else [math.sqrt(2*density(f)) for f in frequencies]
scale = 1 if regular else 0.015/math.sqrt(sum(0.5*a*a for a in sizes))
parts = [(scale*a, 2*math.pi*f, number(f), 7*random.random()) for a, f in zip(sizes, frequencies)]
end = 20.5 if regular else 300
def wave(t, x, early=0, back=0):
    turn = math.radians(early)
    return sum(a*(math.cos(w*t - k*x + s + turn) + back*math.cos(w*t + k*x + 1.7*s)) for a, w, k, s in parts)
with open("whole/probes.csv", "w") as out:
    out.write("time [s],G1_level [m],G2_level [m],G3_level [m]\n")
    for n in range(int(end/0.05)):
        t = 0.05*n
        out.write(f"{t:.6g}," + ",".join(f"{0.4 + wave(t, x, back=0.3):.9g}" for x in (1, 1.3, 1.75)) + "\n")
with open("whole/lines.csv", "w") as out:
    out.write("time [s],rope_tension [N],rope_distance [m]\n")
    for n in range(int(end/0.05)):
        out.write(f"{0.05*n:.6g},{5 + 200*wave(0.05*n, 1):.9g},\n")
with open("whole/bodies.csv", "w") as out:
    out.write("time,name,position_x,position_y,position_z,orientation_w,orientation_x,orientation_y,orientation_z\n")
    for n in range(int(end/0.1) + 1):
        t = 0.1*n
        half = math.radians(0.5*(3 + 90*wave(t, 3.2)))
        # turned about y by 3 degrees and the wave, after half a turn about z at the start
        q = (0, math.sin(half), 0, math.cos(half))
        if n % 2: q = tuple(-c for c in q)          # the same attitude
        out.write(f"{t:.6g},raft,{3.2 + 0.6*wave(t, 3.2, 40):.9g},0.1,{0.4 + 1.2*wave(t, 3.2, -25):.9g}," +
                  ",".join(f"{c:.9g}" for c in q) + f"\n{t:.6g},post,5.1,0.1,0.3,1,0,0,0\n")
PY
# near LABEL COLUMN VALUE ERROR: a row of wave_responses.csv
cat > near.py <<'PY'
import csv, sys
label, column, value, error = sys.argv[1:]
row = {r["response"]: r for r in csv.DictReader(open("whole/wave_responses.csv"))}[label]
sys.exit(not abs(float(row[column]) - float(value)) <= float(error))
PY
near() { check "$1 $2 is $3, not $(grep "^$1," whole/wave_responses.csv)" $python near.py "$@"; }
gains="gain [unit per m]"
for sea in regular irregular; do
    $python records.py $sea
    expect 0 "" waves whole --gauges G1,G2,G3 --response raft --response rope_tension
    near raft_x "$gains" 0.6 0.02
    near raft_x "phase [degrees]" 40 2
    near raft_z "$gains" 1.2 0.04
    near raft_z "phase [degrees]" -25 2
    near raft_turn_y "$gains" 90 3
    near raft_turn_y "phase [degrees]" 0 2
    near rope_tension "$gains" 200 6
    near rope_tension "phase [degrees]" 0 2
    near rope_tension mean 5 0.2
    check "what is at rest has no row" test "$(grep -c raft whole/wave_responses.csv)" = 3
done
near rope_tension significant 12 0.8
near raft_x coherence 1 0.02
check "gains at all frequencies" $python -c '
import csv
rows = [r for r in csv.DictReader(open("whole/wave_gains.csv")) if r["raft_z_gain [m per m]"]]
worst = max(abs(float(r["raft_z_gain [m per m]"]) - 1.2) for r in rows)
turns = max(abs(float(r["raft_z_phase [degrees]"]) + 25) for r in rows)
raise SystemExit(not (len(rows) > 50 and worst < 0.12 and turns < 6))'
if command -v gnuplot > /dev/null; then check "a picture" test -s whole/plots/wave_gains.svg; fi
cp whole/bodies.csv anchored.csv
awk -F, -v OFS=, '$2 == "raft" && $1 < 20 { $3 += 3 } { print }' anchored.csv > whole/bodies.csv
check "heads of the lists" test "$(grep -cE '^(gauge +H_m0 m .*waves|gauges +on, H_m0 m .*|response +unit .* phase)$' out.txt)" = 3
expect 0 "" waves whole --gauges G1,G2,G3 --response raft --from 20 --language ja
check "in Japanese" test "$(grep -cE '^(センサー +H_m0 m .*波|センサー +入射H_m0 m .*|応答 +単位 .* 位相)$' out.txt)" = 3
near raft_x "phase [degrees]" 40 3
expect 0 "periods of the waves; gains and phases of fewer than 8 are rough" waves whole --response raft --from 290
mv anchored.csv whole/bodies.csv
cp whole/lines.csv taut.csv
awk -F, -v OFS=, 'NR > 1 && $2 < 8 { $2 = 0 } { print }' taut.csv > whole/lines.csv        # a rope that snatches
expect 0 "" waves whole --gauges G1,G2,G3 --response rope_tension
near rope_tension least 0 0
mv taut.csv whole/lines.csv
expect 0 "" waves whole --response raft
check "without --gauges the first gauge" grep -q "^waves: G1" out.txt

# --- of all runs of a sweep -------------------------------------------------------------------------
cat > small.json <<'JSON'
{ "dimension": 2, "domain": { "min": [0, 0], "max": [4, 0.6] }, "spacing": 0.05, "end_time": 6, "method": "isph",
  "fluids": [ { "name": "water", "fill": [ { "box": { "min": [0, 0], "max": [4, 0.4] } } ] } ],
  "frame": { "surge": { "amplitude": 0.02, "period": 1.2 } },
  "bodies": [ { "name": "raft", "box": { "min": [0.8, 0.3], "max": [1, 0.5] }, "dynamics": "free", "density": 500,
                "locked": "x,turn" } ],
  "probes": [ { "name": "G1", "kind": "level", "position": [0.5, 0.4] } ],
  "output": { "interval": 0.05 } }
JSON
sweep="sweep small.json --out swept --set frame.surge.period=0.9,1.2"
expect 2 "unrecognized option '--gages'" $sweep --waves "--gages G1,G2"
expect 2 "--from: 'x' is not a number from 0 on" $sweep --waves "--from x"
expect 1 "--gauges G1,G9: there is no sensor 'G9' of the kind level" $sweep --waves "--gauges G1,G9"
check "such options are told before the runs" test ! -e swept
expect 0 "note: --response: 5 periods of the waves; gains" $sweep --waves "--from 1.2 --response raft"
check "a note has the name of its run" grep -q "^period=1.2: tobiuo: note: --response" err.txt
check "a row for each gauge of each run" test "$(cut -d, -f1-3 swept/sweep_waves.csv | paste -sd ' ')" = \
    "run,period,gauge 0,0.9,G1 1,1.2,G1"
check "and each response" test "$(cut -d, -f1-3 swept/sweep_wave_responses.csv | paste -sd ' ')" = \
    "run,period,response 0,0.9,raft_y 1,1.2,raft_y"
check "no groups" test ! -e swept/sweep_wave_groups.csv
expect 0 "" $sweep --table --waves " --from  1.2"
check "no responses of an earlier call" test ! -e swept/sweep_wave_responses.csv
expect 1 "--waves '--from 99': swept/period=1.2 could not be analysed" $sweep --table --waves "--from 99"
expect 0 "" $sweep --slurm --waves "--from 0.5"
check "the array job knows of it" grep -q "sweep.* --waves '--from 0.5' --table" swept/sweep.slurm

# --- messages ---------------------------------------------------------------------------------------
expect 1 "--response keel: whole has no body of this name, and no such column in probes.csv, lines.csv or joints.csv; \
there are raft, post, G1_level, G2_level, G3_level, rope_tension, rope_distance" waves whole --response keel
expect 1 "did you mean raft?" waves whole --response raft_x
expect 1 "--response raft: is asked for twice" waves whole --response raft --response raft
expect 1 "--response post: the body does not move" waves whole --response post
expect 1 "--response rope_distance: its rows do not cover" waves whole --response rope_distance
expect 2 "--response: at most 16 times" waves whole $(for k in $(seq 17); do echo --response raft; done)
cp whole/bodies.csv kept.csv
awk -F, 'NR == 1 || $1 == int($1)' kept.csv > whole/bodies.csv
expect 0 "--response raft: 1.3 rows in a period of the waves; take an interval of the output of 0.13 s" waves whole --response raft
cut -d, -f1-5 kept.csv > whole/bodies.csv
expect 1 "it lacks places and attitudes of bodies" waves whole --response raft
sed -i '1s/time/when/' whole/lines.csv
expect 1 'has no column "time"' waves whole --response rope_tension

echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
