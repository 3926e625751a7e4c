#!/bin/bash
# sensors and pistons go on after a resume as if nothing had been; what a tank may not be is told in words.
# usage: sensors.sh PROGRAM    works in a fresh folder that it removes; last line: "N passed, N failed"
set -uo pipefail
. "$(dirname "$0")/checks.sh" "$1"

cat > dam.json <<'END'
{ "dimension": 2, "domain": { "min": [0, 0], "max": [0.6, 0.4] }, "spacing": 0.02, "end_time": 0.3,
  "fluids": [ { "name": "water", "fill": [ { "box": { "min": [0, 0], "max": [0.2, 0.3] } } ] } ],
  "probes": [ { "name": "wall", "position": [0.6, 0.05], "filter": { "cutoff": 30, "order": "butterworth" } },
              { "name": "floor", "position": [0.3, 0], "rate": 200, "filter": { "cutoff": 20, "order": "first" } },
              { "name": "gauge", "kind": "level", "position": [0.3, 0], "filter": { "cutoff": 10 } } ],
  "output": { "interval": 0.05 } }
END
for method in dfsph wcsph; do
    check "$method runs" "$program" run dam.json --set method=$method --out whole_$method
    check "$method stops" "$program" run dam.json --set method=$method --out parts_$method --until 0.15
    check "$method resumes" "$program" resume parts_$method --until 0.3
    check "$method: the same filtered values after a resume" cmp whole_$method/probes.csv parts_$method/probes.csv
done
check "another filter" "$program" run dam.json --set probes.wall.filter.cutoff=1000 --out sharp
check "a filter does something" test "$(cmp -s whole_dfsph/probes.csv sharp/probes.csv; echo $?)" = 1

cat > tank.json <<'END'
{ "dimension": 2, "domain": { "min": [-0.3, -0.1], "max": [1, 0.4] }, "spacing": 0.02, "end_time": 1,
  "fluids": [ { "name": "water", "fill": [ { "box": { "min": [0, -0.1], "max": [1, 0.1] } } ] } ],
  "bodies": [ { "name": "maker", "box": { "min": [-0.1, -0.1], "max": [0, 0.35] },
                "motion": { "piston": { "depth": 0.2, "regular": { "height": 0.02, "period": 0.8 } } } } ],
  "probes": [ { "name": "p", "position": [0.5, 0] } ] }
END
expect 0 "" check tank.json
# refuse TEXT SCENE TEXT-IN-IT REPLACEMENT
refuse() {
    sed "s#$3#$4#" "$2" > wrong.json
    check "$2 has $3" test "$(cmp -s "$2" wrong.json; echo $?)" = 1
    expect 1 "$1" run wrong.json --out wrong --force --quiet
}
refuse "waves 0.2 m high with a period of 0.8 s break on water 0.2 m deep" tank.json '"height": 0.02' '"height": 0.2'
refuse "the stroke of 'maker' is beyond the tank" tank.json '"min": \[-0.3' '"min": [-0.102'
sed 's#"piston": { "depth": 0.2,#"flap": { "hinge": [-0.05, -0.1], "depth": 0.2,#' tank.json > flap.json
expect 0 "" check flap.json
refuse "the stroke of 'maker' is beyond the tank" flap.json '"min": \[-0.3' '"min": [-0.102'
refuse 'probes[0].position: is 0.6 m in y, the domain reaches from -0.1 to 0.4 m' tank.json '"position": \[0.5, 0\]' '"position": [0.5, 0.6]'
printf 'time,speed\n0,1\n1,1\n0.5,1\n' > back.csv
inlet='"inlets": [ { "name": "in", "centre": [0.5, 0.2], "normal": [0, -1], "width": 0.1, "file": "back.csv" } ]'
sed "s#\"probes\"#$inlet, \"probes\"#" tank.json > inlet.json
at="inlets[0]"
refuse "$at.file: flow $PWD/back.csv:4: time 0.5 s does not come after 1 s of the row before" inlet.json '"width": 0.1' '"width": 0.12'
refuse "$at.centre: inlet 'in' lies inside body 'maker'" inlet.json \
    '"centre": \[0.5, 0.2\], \(.*\)"file": "back.csv"' '"centre": [-0.05, 0.2], \1"speed": 1'
echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
