#!/bin/bash
# solids.csv: the force of the water on each solid; the same bits after a resume and for other numbers of threads.
# usage: solids_table.sh PROGRAM     works in a fresh folder that it removes; last line: "N passed, N failed"
set -uo pipefail
. "$(dirname "$0")/checks.sh" "$1"

cat > pool.json <<'END2'
{ "dimension": 2, "domain": { "min": [0, 0], "max": [0.4, 0.3] }, "spacing": 0.01, "end_time": 0.1,
  "fluids": [ { "name": "water", "fill": [ { "box": { "min": [0, 0], "max": [0.4, 0.15] } } ] } ],
  "solids": [ { "name": "cork", "youngs_modulus": 1e5, "density": 300,
                "fill": [ { "box": { "min": [0.05, 0.1], "max": [0.15, 0.2] } } ] },
              { "name": "dry", "youngs_modulus": 1e5,
                "fill": [ { "box": { "min": [0.25, 0.2], "max": [0.35, 0.25] } } ] } ],
  "output": { "interval": 0.01 } }
END2
for method in dfsph isph; do
    expect 0 "" run pool.json --out whole --quiet --force --threads 1 --set method=$method
    check "$method: a row per output and solid" test "$(grep -c . whole/solids.csv)" = 23
    check "$method: columns" test "$(head -1 whole/solids.csv | cut -d, -f1,2,3,9,12)" = \
        "time,name,position_x,liquid_force_x,mean_liquid_force_x"
    check "$method: water lifts the cork, in the mean by more than its weight" \
        awk -F, '$2 == "cork" && $1 > 0 { sum += $13; n++ } END { exit !(sum/n > 3*9.81 && sum/n < 60) }' whole/solids.csv
    check "$method: it does not touch what is above it" \
        awk -F, '$2 == "dry" && $1 < 0.05 && ($9 != 0 || $10 != 0) { bad = 1 } END { exit bad }' whole/solids.csv
    expect 0 "" run pool.json --out parts --quiet --force --threads 2 --until 0.045 --set method=$method
    expect 0 "" resume parts --quiet --threads 2 --until 0.1
    expect 0 "" run pool.json --out threads --quiet --force --threads 2 --set method=$method
    check "$method: the same forces with two threads" cmp whole/solids.csv threads/solids.csv
    check "$method: rows after a resume, and those of the first end" test "$(grep -c . parts/solids.csv)" = 25
    expect 0 "" run pool.json --out parts --quiet --force --threads 2 --until 0.05 --set method=$method
    expect 0 "" resume parts --quiet --until 0.1
    check "$method: the same forces after a resume" cmp whole/solids.csv parts/solids.csv
done
check "describe" grep -q "Of the fluids on the solid" <("$program" describe mean_liquid_force_x; "$program" describe liquid_force_x)
sed 's/1e5,$/1e15,/' pool.json > stiff.json
expect 1 "stiff.json:5:15: solids[1]: solid 'dry' needs 2" run stiff.json --out stiff --quiet
cat > jelly.json <<'END2'
{ "dimension": 2, "method": "mlsmpm", "domain": { "min": [0, 0], "max": [0.4, 0.3] }, "spacing": 0.02, "end_time": 0.02,
  "solids": [ { "name": "jelly", "youngs_modulus": 1e5, "fill": [ { "box": { "min": [0.1, 0.1], "max": [0.2, 0.2] } } ] } ] }
END2
expect 0 "" run jelly.json --out jelly --quiet
check "without fluids the place and velocity alone" test "$(head -1 jelly/solids.csv)" = \
    time,name,position_x,position_y,position_z,velocity_x,velocity_y,velocity_z
check "it falls" awk -F, 'END { exit !(NR > 2 && $7 < -0.15 && $7 > -0.25 && $4 < 0.15 && $4 > 0.147) }' jelly/solids.csv
echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
