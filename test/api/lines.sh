#!/bin/bash
# lines of a scene: their table, the same bits after a resume, messages.
# usage: lines.sh PROGRAM      works in a fresh folder that it removes; last line: "N passed, N failed"
set -uo pipefail
. "$(dirname "$0")/checks.sh" "$1"

cat > buoy.json <<'END'
{ "dimension": 2, "domain": { "min": [0, 0], "max": [1, 0.6] }, "spacing": 0.025, "end_time": 0.2,
  "fluids": [ { "name": "water", "fill": [ { "box": { "min": [0, 0], "max": [1, 0.3] } } ] } ],
  "bodies": [ { "name": "buoy", "box": { "min": [0.4, 0.2, -0.1], "max": [0.6, 0.4, 0.1] }, "dynamics": "free",
                "density": 300 } ],
  "lines": [ { "name": "chain", "kind": "catenary", "body": "buoy", "point": [0.5, 0.2], "to": [0.2, 0],
               "length": 0.4, "stiffness": 2000, "weight": 50, "rests": true },
             { "name": "spring", "body": "buoy", "point": [0.6, 0.3], "to": [1, 0.3], "stiffness": 200,
               "damping": 2 } ],
  "output": { "interval": 0.05 } }
END
expect 0 "" run buoy.json --out whole --quiet
check "a table of tensions and distances" \
    test "$(head -1 whole/lines.csv)" = "time [s],chain_tension [N per m],chain_distance [m],spring_tension [N per m],spring_distance [m]"
check "a row for each step, none without a number" \
    test "$(grep -c nan whole/lines.csv) $(($(wc -l < whole/lines.csv) > 20))" = "0 1"
expect 0 "" run buoy.json --out parts --quiet --until 0.1
expect 0 "" resume parts --quiet --until 0.2
check "the same tensions after a resume" cmp whole/lines.csv parts/lines.csv
check "resolved.json has the lines" grep -q '"rests": true' whole/resolved.json
expect 0 "" run whole/resolved.json --out again --quiet
check "and runs alike" cmp whole/lines.csv again/lines.csv

refuse() { expect 1 "$1" check buoy.json --set "$2"; }
refuse '"ship" is no body of the scene' lines.chain.body=ship
refuse '"pier" is no body of the scene' lines.chain.to_body=pier
refuse 'is the body at the other end too' lines.chain.to_body=buoy
refuse '"buoy" is prescribed; a line holds a free or controlled body' bodies.buoy.dynamics=prescribed
refuse '"spring" is already the name of lines[0]' lines.chain.name=spring
refuse 'weight: is 0 N/m, a catenary has a weight' lines.chain.weight=0
refuse 'damping: is of springs and ropes' lines.chain.damping=1
refuse 'weight: is of a catenary' lines.spring.weight=1
refuse 'rests: is of a catenary' lines.spring.rests=true
# Lines at the start, and what is seldom meant.
noted() { expect 0 "" check buoy.json --set "$2"; check "check says: $1" grep -qF "$1" out.txt; }
noted 'chain: 0.3606 m from end to end, tension 15.19 N per m at the start' lines.chain.length=0.4
noted "line 'chain': is 0.3 m long, and its ends are 0.3606 m apart: it starts taut, with" lines.chain.length=0.3
noted "line 'spring': 'point' is 0.4 m away from body 'buoy', which is 0.2 m across" "lines.spring.point=[0,0.3]"
noted "line 'spring': its stiffness, 1e+10 N/m, allows steps of" lines.spring.stiffness=1e10
expect 0 "" check buoy.json --set 'domain.min=[-0.3,-0.1]' --set lines.spring.stiffness=50000
check "a spring without force has 0 N, not what rounding leaves" \
    grep -qF 'spring: 0.4 m from end to end, tension 0 N per m at the start' out.txt
expect 0 "" check buoy.json
check "nothing is said of others" test "$(grep -c "^note.*line '" out.txt)" = 0
expect 0 "" describe lines
check "describe names the columns" grep -q "^  distance " out.txt
check "and the table" grep -q "The columns of lines.csv for each line" out.txt

expect 0 "" sweep buoy.json --set lines.spring.stiffness=100,200 --until 0.1 --out s
head=$(head -1 s/sweep.csv)
for column in "max chain_tension [N per m]" "min spring_distance [m]" "max buoy_position_y [m]" "min buoy_position_y [m]" \
    "max buoy_force_y [N per m]"; do
    check "a sweep has $column" grep -qF ",$column" <(echo "$head")
done
check "with the values of the tables" $python -c '
import csv
row = list(csv.DictReader(open("s/sweep.csv")))[0]
run = list(csv.DictReader(open("s/stiffness=100/lines.csv")))
buoy = [r for r in csv.DictReader(open("s/stiffness=100/bodies.csv")) if r["name"] == "buoy"]
heave = [float(r["position_y"]) for r in buoy]
force = [float(r["mean_pressure_force_y"]) + float(r["mean_viscous_force_y"]) for r in buoy]
most = max(float(r["chain_tension [N per m]"]) for r in run)
near = lambda text, value: abs(float(text) - value) <= 1e-5*abs(value)
raise SystemExit(not (near(row["max chain_tension [N per m]"], most) and near(row["min buoy_position_y [m]"], min(heave)) and
                      near(row["max buoy_force_y [N per m]"], max(force))))'
if command -v gnuplot > /dev/null; then
    for column in buoy_force_y buoy_mean_pressure_force_y; do
        expect 0 "" sweep buoy.json --set lines.spring.stiffness=100,200 --until 0.1 --out s --plot $column
        check "a plot of $column of a body" grep -q "$column, N per m" s/sweep.svg
    done
    for column in buoy buoy_nothing bu_force_y force_y; do
        expect 1 "no run has a column \"$column\" in" sweep buoy.json --set lines.spring.stiffness=100,200 \
            --until 0.1 --out s --plot $column
    done
fi
expect 0 "the run has reached its end, 0.1 s; --until S takes it on" resume s/stiffness=100
expect 0 "the run is at 0.1 s, beyond 0.05 s: there is nothing to do" resume s/stiffness=100 --until 0.05

echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
