#!/bin/bash
# porous zones of a scene: their table, the same bits after a resume, the balance of energy, messages.
# usage: porous.sh PROGRAM      works in a fresh folder that it removes; last line: "N passed, N failed"
set -uo pipefail
. "$(dirname "$0")/checks.sh" "$1"

cat > channel.json <<'END'
{ "dimension": 2, "method": "isph", "domain": { "min": [0, 0], "max": [1, 0.2], "walls": { "x": "periodic" } },
  "gravity": [0, 0], "spacing": 0.025, "end_time": 0.2,
  "fluids": [ { "name": "water", "fill": [ { "box": { "min": [0, 0], "max": [1, 0.2] }, "velocity": [1, 0] } ] } ],
  "porous_zones": [ { "name": "kelp", "box": { "min": [0, 0], "max": [0.5, 0.2] }, "direction": [0, 1],
                      "stems": { "number": 400, "diameter": 0.01 } },
                    { "name": "mound", "box": { "min": [0.5, 0], "max": [1, 0.2] },
                      "stones": { "size": 0.1, "porosity": 0.5 } } ],
  "output": { "interval": 0.05, "probe_interval": 0.01, "frames": true } }
END
for method in isph dfsph wcsph; do
    expect 0 "" run channel.json --out whole_$method --quiet --set method=$method --threads 1
    expect 0 "" run channel.json --out parts_$method --quiet --set method=$method --threads 1 --until 0.1
    expect 0 "" resume parts_$method --quiet --threads 2 --until 0.2
    check "$method: the same table after a resume" cmp whole_$method/porous_zones.csv parts_$method/porous_zones.csv
    check "$method: and the same work" cmp whole_$method/history.csv parts_$method/history.csv
    check "$method: the work of both zones is the energy lost" $python -c "
import csv
rows = list(csv.DictReader(open('whole_$method/history.csv')))
zones = list(csv.DictReader(open('whole_$method/porous_zones.csv')))[-1]
lost = float(rows[0]['kinetic_energy']) - float(rows[-1]['kinetic_energy'])
both = float(zones['kelp_work [J per m]']) + float(zones['mound_work [J per m]'])
total = float(rows[-1]['porous_work'])
raise SystemExit(not (abs(both/total - 1) < 1e-6 and abs(lost/total - 1) < 0.02 and lost > 20))"
done
# A dam breaks onto fine stones, which stop it within a few steps: the work is part of the energy lost.
cat > dam.json <<'END'
{ "dimension": 2, "domain": { "min": [0, 0], "max": [2, 0.6] }, "spacing": 0.03, "end_time": 1,
  "fluids": [ { "name": "water", "fill": [ { "box": { "min": [0, 0], "max": [0.6, 0.42] } } ] } ],
  "porous_zones": [ { "name": "sand", "box": { "min": [0.72, 0], "max": [1.02, 0.3] },
                      "stones": { "size": 0.004, "porosity": 0.44 } } ],
  "output": { "interval": 0.25 } }
END
for method in isph eisph dfsph; do
    expect 0 "" run dam.json --out dam_$method --quiet --set method=$method
done
check "the work of a strong zone, by three methods" $python -c "
import csv
def look(method):
    rows = list(csv.DictReader(open(f'dam_{method}/history.csv')))
    energy = [float(r['kinetic_energy']) + float(r['potential_energy']) for r in (rows[0], rows[-1])]
    return float(rows[-1]['porous_work']), energy[0] - energy[1]
found = {m: look(m) for m in ('isph', 'eisph', 'dfsph')}
print(found)
raise SystemExit(not all(60 < work < lost for work, lost in found.values()) or
                 abs(found['isph'][0]/found['eisph'][0] - 1) > 0.2)"
check "a table of forces, power, work and volume" test "$(head -1 whole_isph/porous_zones.csv | cut -d, -f1-7)" = \
    "time [s],kelp_force_x [N per m],kelp_force_y [N per m],kelp_force_z [N per m],kelp_power [W per m],kelp_work [J per m],kelp_volume [m2]"
check "resolved.json has the zones" grep -q '"porosity": 0.5' whole_isph/resolved.json
expect 0 "" run whole_isph/resolved.json --out again --quiet --threads 1
check "and runs alike" cmp whole_isph/porous_zones.csv again/porous_zones.csv
expect 0 "" report whole_isph
check "the report has each zone" grep -q "Porous zone kelp" whole_isph/report.html
expect 0 "" check channel.json
check "check tells what resists" grep -q "porous zone      kelp: 0 1/s, 2 1/m across (0, 1, 0)" out.txt
check "and what a zone of stones is not" grep -q "has stones of a porosity of 0.5" out.txt

# A float and a paddle carry zones: the same bits after a resume.
cat > carried.json <<'END'
{ "dimension": 2, "domain": { "min": [0, 0], "max": [1.2, 0.6] }, "gravity": [0, -9.81], "spacing": 0.03, "end_time": 0.3,
  "fluids": [ { "name": "water", "fill": [ { "box": { "min": [0, 0], "max": [1.2, 0.4] } } ] } ],
  "bodies": [ { "name": "float", "box": { "min": [0.3, 0.34], "max": [0.5, 0.46] }, "dynamics": "free", "density": 300,
                "velocity": [0.3, 0] },
              { "name": "axle", "sphere": { "centre": [0.9, 0.2], "radius": 0.06 },
                "motion": { "rotation": { "centre": [0.9, 0.2], "rate": 200 } } } ],
  "porous_zones": [ { "name": "net", "body": "float", "box": { "min": [0.3, 0.1], "max": [0.5, 0.34] },
                      "resistance": { "linear": 100, "quadratic": 50 } },
                    { "name": "mesh", "body": "axle", "box": { "min": [0.98, 0.14], "max": [1.1, 0.26] }, "screen": { "loss": 5 } } ],
  "output": { "interval": 0.05, "probe_interval": 0.01, "frames": true } }
END
for method in isph dfsph wcsph eisph; do
    expect 0 "" run carried.json --out carried_$method --quiet --set method=$method --threads 1
    expect 0 "" run carried.json --out carried_parts_$method --quiet --set method=$method --threads 1 --until 0.15
    expect 0 "" resume carried_parts_$method --quiet --threads 2 --until 0.3
    for table in porous_zones bodies history; do
        check "$method: the same $table.csv after a resume" cmp carried_$method/$table.csv carried_parts_$method/$table.csv
    done
    last=$(ls carried_$method/frames | tail -1)
    check "$method: and the same picture" cmp carried_$method/frames/$last carried_parts_$method/frames/$last
done
expect 0 "" run carried_isph/resolved.json --out carried_again --quiet --threads 1
check "zones of bodies: resolved.json runs alike" cmp carried_isph/porous_zones.csv carried_again/porous_zones.csv
expect 1 "porous zone 'net' goes along with 'flote', which is no body" check carried.json --set porous_zones.net.body=flote

# A mound with slopes, its armour from a table.
printf 'y [cm],x [cm],note\n0,30,toe\n15,45,\n15,55,\n0,70,heel\n0,60,\n10,50,\n0,40,\n' > armour.csv
cat > mound.json <<'END'
{ "dimension": 2, "domain": { "min": [0, 0], "max": [1, 0.2] }, "spacing": 0.0125, "end_time": 0.1,
  "fluids": [ { "name": "water", "fill": [ { "box": { "min": [0, 0], "max": [0.4, 0.2] } } ] } ],
  "porous_zones": [ { "name": "core", "outline": { "points": [[0.4, 0], [0.5, 0.1], [0.6, 0]] },
                      "stones": { "size": 0.02, "porosity": 0.4 } },
                    { "name": "armour", "outline": { "file": "armour.csv" },
                      "stones": { "size": 0.05, "porosity": 0.45 } } ],
  "output": { "interval": 0.05, "probe_interval": 0.01, "frames": true } }
END
expect 0 "" run mound.json --out mound --quiet --threads 1
expect 0 "" run mound.json --out mound_parts --quiet --threads 1 --until 0.05
expect 0 "" resume mound_parts --quiet --threads 2 --until 0.1
check "outlines: the same table after a resume" cmp mound/porous_zones.csv mound_parts/porous_zones.csv
check "the table of the armour is an input" grep -q armour.csv mound/inputs.json
expect 0 "" run mound/resolved.json --out mound_again --quiet --threads 1
check "resolved.json runs alike" cmp mound/porous_zones.csv mound_again/porous_zones.csv
expect 0 "" check mound.json
check "check tells the area" grep -q "porous zone      armour: .*, in 0.0275 m2" out.txt
expect 1 "the section of porous zone 'armour' overlaps that of 'core'" check mound.json \
    --set 'porous_zones.core.outline.points=[[0.3,0],[0.5,0.1],[0.6,0]]'

refuse() { local text=$1; shift; expect 1 "$text" check channel.json --set "$@"; }
refuse "has more than one of stones, stems, screen and resistance" porous_zones.kelp.screen.loss=1
refuse "stones.porosity" porous_zones.mound.stones.porosity=1
refuse "outside of the domain" porous_zones.kelp.box.min=[3,0] --set porous_zones.kelp.box.max=[4,1]
refuse "a direction is of stems" porous_zones.mound.direction=[1,0]
expect 0 "" sweep channel.json --set porous_zones.kelp.stems.number=200,400 --set output.frames=false --until 0.05 --out s
check "a sweep has the largest force" grep -q ",max kelp_force_x \[N per m\]" s/sweep.csv
expect 0 "" describe zones
check "describe names the columns" grep -q "^  volume " out.txt
echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
