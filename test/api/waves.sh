#!/bin/bash
# tobiuo waves: heights and periods of known levels, waves that come back, messages.
# usage: waves.sh PROGRAM      works in a fresh folder that it removes; last line: "N passed, N failed"
set -uo pipefail
. "$(dirname "$0")/checks.sh" "$1"

# 17 gauges: G1 to G3 and B1 to B3 as in a flume, C, D and S near to G1, A aside, the rest to be too many.
cat > flume.py <<'END'
import json
at = {"G1": 1, "G2": 1.3, "G3": 1.75, "B1": 5, "B2": 5.3, "B3": 5.75, "C": 1.001, "D": 1.1}
probes = [{"name": n, "kind": "level", "position": [x, 0.1, 0.4]} for n, x in at.items()]
probes += [{"name": "S", "kind": "level", "position": [1, 0.1, 0.3]}, {"name": "A", "kind": "level",
           "position": [1.4, 0.15, 0.4]}, {"name": "floor", "position": [1, 0.1, 0]}]
probes += [{"name": f"M{k}", "kind": "level", "position": [2 + 0.1*k, 0.1, 0.4]} for k in range(7)]
json.dump({"domain": {"min": [0, 0, 0], "max": [6, 0.2, 0.6]}, "spacing": 0.1, "end_time": 0.01,
           "fluids": [{"name": "water", "fill": [{"box": {"min": [0, 0, 0], "max": [6, 0.2, 0.4]}}]}],
           "probes": probes, "output": {"interval": 0.01}}, open("flume.json", "w"))
END
$python flume.py
expect 0 "" run flume.json --out whole --quiet
expect 1 "fewer than 8 levels in the time that is asked for" waves whole

# levels.py DIR WAVES: writes the levels of waves into probes.csv. regular: 30 mm and 40 % of it come back, behind
# half as high ones go on. sea: a JONSWAP spectrum of 0.06 m, 1.4 s, of which 30 % come back.
cat > levels.py <<'END'
import json, math, random, sys
folder, kind, depth = sys.argv[1], sys.argv[2], 0.4
scene = json.load(open(folder + "/resolved.json"))
gauges = [p for p in scene["probes"] if p["kind"] == "level"]
random.seed(3)

def number(f):
    k = deep = (2*math.pi*f)**2/9.81
    for _ in range(200):
        k = 0.5*(k + deep/math.tanh(k*depth))
    return k

if kind == "regular":
    parts, back, end = [(0.03, 1/1.3, 0.7)], 0.4, 20.5
elif kind == "still":
    parts, back, end = [], 0, 20
else:
    def density(f):
        r = f*1.4
        return r**-5*math.exp(-1.25*r**-4)*3.3**math.exp(-(r - 1)**2/(2*(0.07 if r <= 1 else 0.09)**2))
    frequencies = [0.36 + 0.012*(k + random.random()) for k in range(100)]
    sizes = [math.sqrt(2*density(f)) for f in frequencies]
    scale = 0.015/math.sqrt(sum(0.5*a*a for a in sizes))
    parts, back, end = [(scale*a, f, 7*random.random()) for a, f in zip(sizes, frequencies)], 0.3, 200
parts = [(a, 2*math.pi*f, number(f), p) for a, f, p in parts]
with open(folder + "/probes.csv", "w") as out:
    out.write("time [s]," + ",".join(p["name"] + "_level [m]" for p in gauges) + ",floor_pressure [Pa]\n")
    t = 0
    while t < end:
        row = []
        for p in gauges:
            if p["name"][0] == "M":
                row.append(row[0])
                continue
            x = p["position"][0]
            goes = 0.5 if x > 4 else 1
            ramp = min(1, t/8) if kind == "regular" and "grow" in sys.argv else 1
            row.append(depth + ramp*sum(goes*a*(math.cos(w*t - k*x + s) + back*math.cos(w*t + k*x + 1.7*s))
                                        for a, w, k, s in parts))
        out.write(f"{t:.6g}," + ",".join(f"{v:.9g}" for v in row) + ",0\n")
        t += 0.05 if kind == "sea" else 0.02*(1 + 0.3*random.random())      # steps are not even
END
# near FILE ROW COLUMN VALUE SHARE
cat > near.py <<'END'
import csv, sys
name, row, column, value, share = sys.argv[1:]
found = float(list(csv.DictReader(open(name)))[int(row)][column])
sys.exit(not abs(found - float(value)) <= float(share)*abs(float(value)))
END
near() { check "$1 $3 of row $2 is $4, not $(tail -n +$(($2 + 2)) "$1" | head -1)" $python near.py "$@"; }

$python levels.py whole regular
expect 0 "periods of the waves; reflection and transmission of fewer than 4 are rough" \
    waves whole --gauges G1,G2,G3 --from 17
expect 0 "" waves whole --gauges G1,G2,G3 --gauges B1,B3 --gauges G1,G2
near whole/wave_groups.csv 0 "H_m0_on [m]" 0.084853 0.004       # 2 sqrt(2) amplitudes
near whole/wave_groups.csv 0 "H_m0_back [m]" 0.033941 0.01
near whole/wave_groups.csv 0 reflection 0.4 0.01
near whole/wave_groups.csv 1 transmission 0.5 0.01
near whole/wave_groups.csv 2 reflection 0.4 0.01
near whole/waves.csv 0 "T_p [s]" 1.3 0.002
near whole/waves.csv 0 "T_mean [s]" 1.3 0.002
near whole/waves.csv 0 "T_energy [s]" 1.3 0.01
near whole/waves.csv 0 "mean_level [m]" 0.4 0.001
check "the sum of both at a gauge" $python -c '
import csv, math
row = list(csv.DictReader(open("whole/waves.csv")))[0]
k, x = 2.7018, float(row["x [m]"])           # 1/m of 1.3 s on 0.4 m
omega = 2*math.pi/1.3
for _ in range(100): k = omega**2/9.81/math.tanh(0.4*k)*0.5 + 0.5*k
height = 2*0.03*math.sqrt(1 + 0.16 + 2*0.4*math.cos(2*k*x + 0.7*0.7))
raise SystemExit(not (abs(float(row["H_max [m]"]) - height) < 0.01*height and
                      abs(float(row["H_third [m]"]) - height) < 0.01*height and
                      abs(float(row["H_m0 [m]"]) - height*math.sqrt(2)) < 0.01*height))'
check "lengths on the terminal" grep -q "0.4 m deep, 1.3 s and 2.17" out.txt
check "a column of the spectra for each gauge" test "$(head -1 whole/wave_spectra.csv | tr , '\n' | grep -c density)" = 17
if command -v gnuplot > /dev/null; then check "a picture" test -s whole/plots/wave_spectra.svg; fi
expect 0 "" waves whole --from 5 --until 15 --depth 0.4 --format png
check "without groups it tells of them" grep -qF -- "--gauges A,B,C tells" out.txt
check "the span of time" grep -q "^waves from 5.* to 1[45]" out.txt

$python levels.py whole regular grow
expect 0 "waves at G1 are 0." waves whole
expect 0 "" waves whole --from 8

$python levels.py whole sea
expect 0 "" waves whole --gauges G1,G2,G3
near whole/wave_groups.csv 0 "H_m0_on [m]" 0.06 0.04
near whole/wave_groups.csv 0 reflection 0.3 0.05
near whole/waves.csv 2 "T_p [s]" 1.4 0.1
check "spectra hold the variance" $python -c '
import csv
rows = list(csv.DictReader(open("whole/wave_spectra.csv")))
step = float(rows[1]["frequency [Hz]"]) - float(rows[0]["frequency [Hz]"])
gauges = {r["gauge"]: r for r in csv.DictReader(open("whole/waves.csv"))}
for name in ("G1", "B2"):
    height = 4*(step*sum(float(r[name + "_density [m2/Hz]"]) for r in rows))**0.5
    if abs(height - float(gauges[name]["H_m0 [m]"])) > 0.03*height: raise SystemExit(1)'
expect 0 "of the energy is of frequencies that they tell apart" waves whole --gauges G1,D

# --- messages ---------------------------------------------------------------------------------------
expect 1 "--gauges G1: at least two gauges" waves whole --gauges G1
expect 1 "--gauges G1,G9: there is no sensor 'G9' of the kind level" waves whole --gauges G1,G9
expect 1 "there is no sensor 'floor' of the kind level" waves whole --gauges G1,floor
expect 1 "there is no sensor '' of the kind level" waves whole --gauges G1,
expect 1 "'G1' is there twice" waves whole --gauges G1,G2,G1
expect 1 "the first and the last stand at one place" waves whole --gauges G1,S
expect 1 "they do not stand in a line; one is 0.05 m off" waves whole --gauges G1,A,G3
expect 1 "they cannot tell waves of 1." waves whole --gauges G1,C
expect 1 "at most 16 gauges" waves whole --gauges G1,G2,G3,B1,B2,B3,C,S,A,M0,M1,M2,M3,M4,M5,M6,D
expect 2 "--gauges: at most 16 times" waves whole $(for k in $(seq 17); do echo --gauges G1,G2; done)
expect 2 "--format: 'pdf' is neither svg nor png" waves whole --format pdf
expect 2 "--from: '-1' is not a number from 0 on" waves whole --from -1
expect 0 "" waves whole --from 0
expect 0 "--gauges G3,G2,G1: more comes back than goes on; name the gauges in the direction of the waves" \
    waves whole --gauges G3,G2,G1
expect 1 "fewer than 8 levels" waves whole --from 1e6
expect 1 "there are no sensors (no probes.csv)" waves .
sed -i 's/_level/_pressure/g' whole/probes.csv
expect 1 "whole has no sensors of the kind level" waves whole
echo "when,G1_level" > whole/probes.csv
expect 1 'has no column "time"' waves whole
$python levels.py whole still
expect 1 "there is no whole wave in the time that is asked for" waves whole
$python levels.py whole regular
sed -i 's/"min": \[0.0, 0.0, 0.0\]/"min": [0.0, 0.0, 0.5]/' whole/resolved.json
expect 1 "the water has no depth at the gauges; give --depth" waves whole
expect 0 "" waves whole --depth 0.4
sed -i 's/-9.8[0-9]*/0/' whole/resolved.json
expect 1 "there are no waves without gravity" waves whole
rm whole/resolved.json
expect 1 "resolved.json: unable to open" waves whole

echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
