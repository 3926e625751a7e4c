#!/bin/bash
# temperature and concentration of a scene: their table, the same bits after a resume, balances, messages.
# usage: scalars.sh PROGRAM      works in a fresh folder that it removes; last line: "N passed, N failed"
set -uo pipefail
. "$(dirname "$0")/checks.sh" "$1"

cat > tank.json <<'END_OF_SCENE'
{ "dimension": 2, "method": "isph", "domain": { "min": [0, 0], "max": [0.4, 0.3] },
  "spacing": 0.02, "end_time": 0.2,
  "fluids": [ { "name": "water", "fill": [ { "box": { "min": [0, 0], "max": [0.4, 0.2] } } ] } ],
  "bodies": [ { "name": "heater", "box": { "min": [0.16, 0.06], "max": [0.24, 0.12] } } ],
  "scalars": [ { "field": "temperature", "value": 20, "diffusivity": 0.001, "capacity": 4182, "expansion": 0.01 },
               { "field": "concentration", "diffusivity": 1e-5, "expansion": -0.001 } ],
  "scalar_values": [
    { "field": "temperature", "side": "y_min", "value": 60, "name": "floor" },
    { "field": "temperature", "body": "heater", "flux": 1e6 },
    { "field": "concentration", "box": { "min": [0, 0], "max": [0.2, 0.2] }, "value": 35 } ],
  "probes": [ { "name": "P", "position": [0.1, 0.1] }, { "name": "L", "kind": "level", "position": [0.1, 0.1] } ],
  "output": { "interval": 0.05, "probe_interval": 0.01, "frames": true, "picture": { "field": "temperature" } } }
END_OF_SCENE
for method in isph dfsph wcsph eisph; do
    expect 0 "" run tank.json --out whole_$method --quiet --set method=$method --threads 1
    expect 0 "" run tank.json --out parts_$method --quiet --set method=$method --threads 1 --until 0.1
    expect 0 "" resume parts_$method --quiet --threads 2 --until 0.2
    check "$method: the same table after a resume" cmp whole_$method/scalars.csv parts_$method/scalars.csv
    check "$method: and the same work" cmp whole_$method/history.csv parts_$method/history.csv
    check "$method: walls give what the water gains, salt stays, buoyancy works" $python -c "
import csv
rows = list(csv.DictReader(open('whole_$method/scalars.csv')))
last = {k.split(' ')[0]: float(v) for k, v in rows[-1].items()}
first = {k.split(' ')[0]: float(v) for k, v in rows[0].items()}
given = last['floor_temperature_passed'] + last['heater_temperature_passed']
work = float(list(csv.DictReader(open('whole_$method/history.csv')))[-1]['buoyancy_work'])
raise SystemExit(not (abs(last['temperature_amount']/given - 1) < 1e-5 and given > 0 and work > 0 and
                      abs(last['concentration_amount']/first['concentration_amount'] - 1) < 1e-5 and
                      0 <= last['concentration_min'] and last['concentration_max'] <= 35))"
done
columns="time [s]"
for field in temperature concentration; do
    unit=$([ $field = temperature ] && echo " [degC]"); amount=$([ $field = temperature ] && echo J || echo kg)
    columns+=",${field}_min$unit,${field}_mean$unit,${field}_max$unit,${field}_amount [$amount per m]"
done
for wall in floor heater; do
    columns+=",${wall}_temperature_flow [W per m],${wall}_temperature_passed [J per m]"
done
check "a table of ranges, amounts and flows" test "$(head -1 whole_isph/scalars.csv)" = "$columns"
check "a sensor has both" test "$(head -1 whole_isph/probes.csv | cut -d, -f5-)" = \
    "P_velocity_z [m/s],P_temperature [degC],P_concentration,L_level [m]"
check "of the water there" $python -c "
import csv
last = list(csv.DictReader(open('whole_isph/probes.csv')))[-1]
raise SystemExit(not (20 <= float(last['P_temperature [degC]']) < 30 and 34 < float(last['P_concentration']) < 35.5))"
check "the same after a resume" cmp whole_isph/probes.csv parts_isph/probes.csv
check "fields of the particles" grep -q 'Name="temperature"' whole_isph/fluid/fluid_000002.vtu
check "resolved.json has the values" grep -q '"flux": 1000000' whole_isph/resolved.json
expect 0 "" run whole_isph/resolved.json --out again --quiet --threads 1
check "and runs alike" cmp whole_isph/scalars.csv again/scalars.csv
printf "x,y\n0.1,0.1\n" > places.csv
expect 0 "" sample whole_isph --points places.csv --fields temperature
expect 0 "" report whole_isph
check "the report has the heat of the liquid and of each wall" \
    test "$(grep -c "Liquid: temperature\|Liquid: concentration\|Wall floor_temperature\|Wall heater_temperature" whole_isph/report.html)" = 4
expect 0 "" check tank.json
check "check tells the range" grep -q "temperature      20 to " out.txt

# Eddies that mix faster than a step can, and an inlet that is named before the fluid that it lets in.
cat > eddies.json <<'END_OF_SCENE'
{ "dimension": 2, "method": "dfsph", "domain": { "min": [0, 0], "max": [0.4, 0.3] },
  "spacing": 0.02, "end_time": 0.3, "implicit_viscosity": true,
  "fluids": [ { "name": "water", "viscosity": 0.001, "smagorinsky": 0.3,
                "fill": [ { "box": { "min": [0, 0], "max": [0.16, 0.24] } } ] } ],
  "inlets": [ { "name": "hose", "fluid": "water", "centre": [0.3, 0.22], "normal": [0, -1], "width": 0.06,
                "speed": 0.5 } ],
  "scalars": [ { "field": "temperature", "value": 20, "diffusivity": 1e-6, "turbulent_number": 0.01 } ],
  "scalar_values": [
    { "field": "temperature", "inlet": "hose", "value": 40 },
    { "field": "temperature", "fluid": "water", "value": 30 },
    { "field": "temperature", "box": { "min": [0, 0], "max": [0.08, 0.24] }, "value": 10 } ],
  "output": { "interval": 0.2, "probe_interval": 0.01 } }
END_OF_SCENE
for method in dfsph isph wcsph; do
    expect 0 "" run eddies.json --out eddies_$method --quiet --set method=$method --threads 1
    check "$method: mixed by eddies within what liquid and inlet had" $python -c "
import csv
rows = [{k.split(' ')[0]: float(v) for k, v in r.items()}
        for r in csv.DictReader(open('eddies_$method/scalars.csv'))]
raise SystemExit(not (all(r['temperature_min'] > 10 - 1e-4 for r in rows) and
                      all(abs(r['temperature_max'] - 40) < 1e-4 for r in rows)))"
done

refuse() { local text=$1; shift; expect 1 "$text" check tank.json --set "$@"; }
refuse "of 2 scalars at most" 'scalars={"field": "temperature"}'
refuse "there is no body 'stove'" scalar_values[1].body=stove
refuse 'is "floor", allowed is none, x_min' scalar_values[0].side=floor
refuse "temperature is given already" scalars[1].field=temperature
expect 1 'field: is "temperature", and the scene has none; scalars are to have it' check tank.json \
    --set "scalars=[]" --set "scalar_values=[]"
refuse "diffusivity" scalars[0].diffusivity=-1
refuse "scalar_values[0].box: min is 0 and max is 0 in x, max must be greater" \
    'scalar_values[0].box={"min": [0, 0], "max": [0, 0]}'
refuse "scalar_values[2].box: min is 0 and max is 0 in y, max must be greater" 'scalar_values[2].box.max=[1, 0]'
refuse "scalar_values[2].box: must have two corners, min and max" 'scalar_values[2].box={"max": [0.2, 0.2]}'
expect 0 "" sweep tank.json --set scalar_values[0].value=40,60 --set output.frames=false --until 0.05 --out s
check "a sweep has the largest flow" grep -q ",max floor_temperature_flow \[W per m\]" s/sweep.csv
expect 0 "" describe scalars
check "describe names the columns" grep -q "^  passed " out.txt
echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
