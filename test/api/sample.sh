#!/bin/bash
# tobiuo sample: lines, points, grids and means of runs; what VTK reads; frames of bodies; messages.
# usage: sample.sh PROGRAM      works in a fresh folder that it removes; last line: "N passed, N failed"
set -uo pipefail
here=$(cd "$(dirname "$0")" && pwd)
. "$here/checks.sh" "$1"

# vtk WHAT FILE [KEY=VALUE...]: VTK reads it and finds that (without VTK, code 77, nothing is checked)
vtk() {
    local code=0 what=$1
    shift
    $python "$here/read_vtk.py" "$@" > out.txt || code=$?
    if [ $code = 77 ]; then code=0; /usr/bin/python3 "$here/read_vtk.py" "$@" > out.txt || code=$?; fi
    check "$what: $(tail -1 out.txt)" test $code = 0 -o $code = 77
}

# Still water, 0.4 m deep in 2-D: its pressure is known.
cat > still.json <<'END2'
{ "dimension": 2, "domain": {"min": [0, 0], "max": [0.6, 0.6]}, "spacing": 0.02, "end_time": 0.1,
  "fluids": [{"name": "water", "fill": [{"box": {"min": [0, 0], "max": [0.6, 0.4]}}]}],
  "bodies": [{"name": "block", "box": {"min": [0.3, 0], "max": [0.4, 0.2]}}],
  "output": {"interval": 0.05} }
END2
expect 0 "" run still.json --out still --quiet
expect 0 "" sample still --line "0.1,0 to 0.1,0.6" --count 31 --fields pressure
check "it says what it did" grep -qE "^sample: still/sample/line.csv, 3 outputs, 31 places, [0-9.]+ % wet" out.txt
check "a picture" test -s still/plots/sample_line.svg
check "columns" grep -qx 'time \[s\],index,way \[m\],x \[m\],y \[m\],z \[m\],wet,pressure \[Pa\]' still/sample/line.csv
check "no parts are left" test -z "$(find still -name '*.part')"
# 3 % of the pressure at the floor: what dfsph leaves after 0.1 s
check "pressure over the depth" $python - <<'END2'
import csv
rows = list(csv.DictReader(open("still/sample/line.csv")))
assert len(rows) == 93
for row in rows[62:]:
    y = float(row["y [m]"])
    assert row["wet"] == ("1" if y < 0.405 else "0") or abs(y - 0.4) < 0.01, row
    if row["wet"] == "0": assert row["pressure [Pa]"] == "", row
    else: assert abs(float(row["pressure [Pa]"]) - 9810*(0.4 - y)) < 0.03*3924, row
END2
expect 0 "" sample still --line "0.2,0.1 to 0.5,0.1" --count 31 --name across --from 0.1
check "in the block it is dry" $python - <<'END2'
import csv
for row in csv.DictReader(open("still/sample/across.csv")):
    x = float(row["x [m]"])
    if abs(x - 0.3) > 0.005 and abs(x - 0.4) > 0.005:
        assert row["wet"] == ("0" if 0.3 < x < 0.4 else "1"), row
END2
printf 'x [m],y [m]\n0.1,0.1\n0.1,0.5\n' > two.csv
expect 0 "" sample still --points two.csv --until 0.05
check "points of a table" test "$(grep -c , still/sample/points.csv)" = 5

# A grid as VTK sees it; a plane; means.
expect 0 "" sample still --box "0,0 to 0.6,0.5" --cell 0.05 --mean
vtk "a grid" still/sample/box_000002.vti points=143 cells=120 \
    'arrays={"wet": 1, "velocity": 3, "pressure": 1, "density": 1}' 'bounds=[0, 0.6, 0, 0.5, 0, 0]'
vtk "its list" still/sample/box.pvd 'times=[0, 0.05, 0.1]' 'names=["box", "box", "box"]' 'each={"points": 143}'
vtk "means" still/sample/box_mean.vti 'arrays={"wet_share": 1, "mean_velocity": 3, "rms_velocity": 3,
    "reynolds": 6, "mean_pressure": 1, "rms_pressure": 1}'
expect 0 "" sample still --line "0.1,0.1 to 0.1,0.3" --count 3 --mean --fields velocity --name column
check "means are those of the outputs" $python - <<'END2'
import csv
rows = [r for r in csv.DictReader(open("still/sample/column.csv")) if r["index"] == "1"]
mean = [r for r in csv.DictReader(open("still/sample/column_mean.csv"))][1]
u = [float(r["velocity_x [m/s]"]) for r in rows]
v = [float(r["velocity_y [m/s]"]) for r in rows]
a, b = sum(u)/3, sum(v)/3
def near(name, value): assert abs(float(mean[name]) - value) < 1e-6*abs(value) + 1e-15, (name, mean[name], value)
near("mean_velocity_x [m/s]", a)
near("rms_velocity_y [m/s]", (sum((x - b)**2 for x in v)/3)**0.5)
near("reynolds_xy [m2/s2]", sum((x - a)*(y - b) for x, y in zip(u, v))/3)
assert mean["wet_share"] == "1"
END2
expect 0 "" sample still --line "0.1,0 to 0.1,0.4" --line "0.5,0 to 0.5,0.4" --count 5 --name both --mean
check "two lines" test "$(cut -d, -f1 still/sample/both_mean.csv | sort | uniq -c | tr -s ' ' | tr '\n' ';')" = \
    " 5 1; 5 2; 1 line;"

# The same bits for any number of threads.
cp -r still/sample one
expect 0 "" sample still --box "0,0 to 0.6,0.5" --cell 0.05 --mean --threads 3
expect 0 "" sample still --line "0.2,0.1 to 0.5,0.1" --count 31 --name across --from 0.1 --threads 3
check "the same bits" diff -r one still/sample

# In the frame of a body, whose rows are made up: at the end it has turned by 90 degrees.
cp -r still framed
$python - <<'END2'
import csv
rows = list(csv.DictReader(open("still/bodies.csv")))
rows[-1].update(position_x=0.25, position_y=0.2, orientation_w=0.5**0.5, orientation_z=0.5**0.5, velocity_x=1,
                velocity_y=2, angular_velocity_z=3)
with open("framed/bodies.csv", "w", newline="") as file:
    out = csv.DictWriter(file, rows[0])
    out.writeheader()
    out.writerows(rows)
END2
expect 0 "" sample framed --with block --line "0.4,0.1 to 0.41,0.1" --count 2 --from 0.1
check "places and velocities of a body's frame" $python - <<'END2'
import csv
row = next(csv.DictReader(open("framed/sample/line.csv")))
# the arm of 0.05 m along x points along y: the place is 0.25, 0.25; the body's velocity there 1 - 0.15, 2
assert row["x [m]"] == "0.4" and row["wet"] == "1", row
assert abs(float(row["pressure [Pa]"]) - 9810*0.15) < 0.03*3924, row
assert abs(float(row["velocity_x [m/s]"]) + 2) < 0.02 and abs(float(row["velocity_y [m/s]"]) - 0.85) < 0.02, row
END2

# A gate that is taken away dries nothing any more: just below the surface of what has filled its place.
cat > gate.json <<'END2'
{ "dimension": 2, "method": "isph", "domain": {"min": [0, 0], "max": [0.4, 0.3]}, "spacing": 0.01, "end_time": 0.3,
  "fluids": [{"name": "water", "fill": [{"box": {"min": [0, 0], "max": [0.19, 0.1]}},
                                        {"box": {"min": [0.21, 0], "max": [0.4, 0.1]}}]}],
  "bodies": [{"name": "post", "box": {"min": [0.05, 0], "max": [0.07, 0.05]}},
             {"name": "gate", "box": {"min": [0.19, 0], "max": [0.21, 0.3]}, "absent": {"from": 0.04, "until": 0.25}},
             {"name": "block", "box": {"min": [0.3, 0], "max": [0.36, 0.04]}}],
  "output": {"interval": 0.1} }
END2
"$program" run gate.json --out gate --quiet 2> err.txt
expect 0 "" sample gate --line "0.2,0.02 to 0.2,0.07" --count 6 --fields density
check "an absent body dries nothing" test "$(awk -F, 'NR > 1 { printf "%g %s;", $1, $7 }' gate/sample/line.csv)" = \
    "$(for at in "0 0" "0.1 1" "0.2 1" "0.3 0"; do for _ in 1 2 3 4 5 6; do printf '%s;' "$at"; done; done)"
vtk "it has no particles in the files" gate/bodies/bodies_000001.vtu points=34 'ranges={"object_id": [1, 3]}' \
    'sums={"object_id": 1675}'
vtk "before and after it has" gate/bodies/bodies_000003.vtu points=94

# Two liquids and a solid, each by its name; 3-D.
cat > three.json <<'END2'
{ "domain": {"min": [0, 0, 0], "max": [0.6, 0.2, 0.4]}, "spacing": 0.02, "end_time": 0.001, "gravity": [0, 0, 0],
  "mlsmpm": {"spacing": 0.01},
  "fluids": [{"name": "water", "fill": [{"box": {"min": [0, 0, 0], "max": [0.3, 0.2, 0.2]}}]},
             {"name": "oil", "density": 900, "fill": [{"box": {"min": [0, 0, 0.2], "max": [0.3, 0.2, 0.3]}}]}],
  "solids": [{"name": "cube", "youngs_modulus": 1e5, "fill": [{"box": {"min": [0.4, 0, 0.1], "max": [0.5, 0.2, 0.2]}}]}],
  "output": {"interval": 0.001} }
END2
expect 0 "" run three.json --out three --quiet
# wet NAME LINE: where the line is wet, in steps of 0.01 m
wet() { expect 0 "" sample three --line "$2" --count 41 --name "$1" "${@:3}" --fields density; \
    awk -F, '$1 == 0 && $7 == 1 { print $2 }' three/sample/"$1".csv | sed -n '1p;$p' | tr '\n' ' '; }
check "all liquids" test "$(wet all '0.1,0.1,0 to 0.1,0.1,0.4')" = "0 29 "
check "water" test "$(wet water '0.1,0.1,0.005 to 0.1,0.1,0.4' --fluid water)" = "0 19 "
check "oil" test "$(wet oil '0.1,0.1,0.005 to 0.1,0.1,0.4' --fluid oil)" = "20 29 "
check "a solid" test "$(wet cube '0.45,0.1,0.005 to 0.45,0.1,0.4' --solid cube)" = "10 19 "
expect 0 "" sample three --box "0,0.1,0 to 0.6,0.1,0.4"
vtk "a plane in 3-D" three/sample/box_000001.vti points=651 'bounds=[0, 0.6, 0.1, 0.1, 0, 0.4]'

# Components, those of stresses too; in the frame of a body that has turned by 90 degrees about z.
cat > beam.json <<'END2'
{ "domain": {"min": [0, 0, 0], "max": [0.4, 0.2, 0.3]}, "gravity": [2, 5, -9.81], "spacing": 0.02, "end_time": 0.1,
  "fluids": [{"name": "water", "fill": [{"box": {"min": [0, 0, 0], "max": [0.2, 0.2, 0.1]}}]}],
  "solids": [{"name": "cube", "youngs_modulus": 1e5, "fill": [{"box": {"min": [0.3, 0, 0], "max": [0.4, 0.2, 0.2]}}]}],
  "bodies": [{"name": "vane", "box": {"min": [0.22, 0, 0.2], "max": [0.26, 0.1, 0.24]},
              "motion": {"rotation": {"axis": [0, 0, 1], "centre": [0.24, 0.05, 0.22], "rate": 900}}}],
  "output": {"interval": 0.1, "fields": ["usual", "stress", "deformation_gradient"]} }
END2
expect 0 "" run beam.json --out beam --quiet
beam() { expect 0 "" sample beam --solid cube --from 0.1 --count 2 --name "$@"; }
beam all --line "0.35,0.1,0.1 to 0.35,0.11,0.1" --mean
beam some --line "0.35,0.1,0.1 to 0.35,0.11,0.1" --fields stress_xz,velocity_z,stress_yy --mean
beam turned --line "0.29,-0.06,0.1 to 0.30,-0.06,0.1" --with vane --fields stress_zx,velocity,deformation_gradient
beam whole --line "0.29,-0.06,0.1 to 0.30,-0.06,0.1" --with vane --fields stress,velocity_y
check "components" $python - <<'END2'
import csv
def read(name): return next(csv.DictReader(open(f"beam/sample/{name}.csv")))
def same(a, b): assert abs(float(a) - float(b)) <= 1e-6*abs(float(b)), (a, b)
a, some, turned, whole = (read(n) for n in ("all", "some", "turned", "whole"))
assert list(some)[7:] == ["stress_xz [Pa]", "velocity_z [m/s]", "stress_yy [Pa]"], some
stress = {k: float(a[f"stress_{k} [Pa]"]) for k in ("xx", "yy", "zz", "xy", "yz", "zx")}
assert all(abs(x) > 1 for x in stress.values()), stress
same(some["stress_xz [Pa]"], stress["zx"])
same(some["velocity_z [m/s]"], a["velocity_z [m/s]"])
same(some["stress_yy [Pa]"], stress["yy"])
m, mean = read("some_mean"), read("all_mean")
same(m["mean_stress_xz [Pa]"], mean["mean_stress_zx [Pa]"])
# x of the body points along y, its y along -x
expected = {"xx": stress["yy"], "yy": stress["xx"], "zz": stress["zz"], "xy": -stress["xy"], "yz": -stress["zx"],
            "zx": stress["yz"]}
for k, value in expected.items(): assert abs(float(whole[f"stress_{k} [Pa]"]) - value) < 1e-3*abs(stress["zz"]), (k, value)
same(turned["stress_zx [Pa]"], whole["stress_zx [Pa]"])
same(whole["velocity_y [m/s]"], turned["velocity_y [m/s]"])
for k in "xyz":
    assert abs(float(turned[f"deformation_gradient_x{k}"]) - float(a[f"deformation_gradient_y{k}"])) < 1e-6, k
    assert abs(float(turned[f"deformation_gradient_y{k}"]) + float(a[f"deformation_gradient_x{k}"])) < 1e-6, k
END2
expect 1 "--fields: 'stress_xz' is asked for twice" sample beam --line "0.35,0.1,0.1 to 0.35,0.11,0.1" --solid cube \
    --fields stress_zx,stress_xz
expect 1 "--fields: 'velocity' is asked for twice" sample beam --line "0.35,0.1,0.1 to 0.35,0.11,0.1" --solid cube \
    --fields velocity_x,velocity
expect 1 "beam has no field 'velocity_w'; did you mean velocity?" sample beam --line "0,0,0 to 0,0,0.1" \
    --fields velocity_w
expect 0 "" sample beam --box "0.3,0,0 to 0.4,0.1,0.1" --solid cube --fields velocity_z,stress_xz
vtk "components in a grid" beam/sample/box_000001.vti 'arrays={"wet": 1, "velocity_z": 1, "stress_xz": 1}'

# Each of many solids has its name, in any letters.
$python - <<'END2'
import json
solids = [{"name": f"塊 {k}", "youngs_modulus": 1e5, "fill": [{"box": {"min": [k, 0], "max": [k + 1, 2]}}]} for k in range(80)]
json.dump({"method": "mlsmpm", "dimension": 2, "domain": {"min": [0, 0], "max": [80, 2]}, "spacing": 0.5, "end_time": 1e-3,
           "gravity": [0, 0], "solids": solids, "output": {"interval": 1e-3}}, open("many.json", "w"))
END2
expect 0 "" run many.json --out many --quiet
expect 0 "" sample many --solid "塊 79" --line "79.2,1 to 79.8,1" --count 2 --from 0 --until 0
check "the last of many solids" test "$(cut -d, -f7 many/sample/line.csv | tail -1)" = 1
expect 1 "many has no solid '塊 99'; did you mean 塊 9?" sample many --solid "塊 99" --line "79.2,1 to 79.8,1"

# Flows with exact solutions. The bound of the first is that of its case, test/physics/poiseuille.
physics="$here/../physics"
sed '/"dfsph"/d' "$physics/poiseuille/scene.json" > plates.json
expect 0 "" run plates.json --set method=isph --out plates --quiet
expect 0 "" sample plates --line "0.0025,0 to 0.0025,0.01" --count 41 --mean --from 0.5 --fields velocity
check "Poiseuille flow" $python - <<'END2'
import csv, math
H, G, NU = 0.01, 0.08, 1e-4
def profile(y, t):
    u = G/(2*NU)*y*(H - y)
    for n in range(40):
        k = (2*n + 1)*math.pi/H
        u -= 4*G*H*H/(NU*math.pi**3*(2*n + 1)**3)*math.sin(k*y)*math.exp(-k*k*NU*t)
    return u
times = sorted({float(r["time [s]"]) for r in csv.DictReader(open("plates/sample/line.csv"))})
assert len(times) == 11
for row in csv.DictReader(open("plates/sample/line_mean.csv")):
    exact = sum(profile(float(row["y [m]"]), t) for t in times)/len(times)
    assert abs(float(row["mean_velocity_x [m/s]"]) - exact) < 0.02*G*H*H/(8*NU), (row, exact)
END2
# The vortex at its start: half the spacing, a quarter of the error. The bounds were set after 2.2 % and 0.56 % had
# been seen.
cp "$physics/taylor_green/vortex.lua" .
sed '/"dfsph"/d' "$physics/taylor_green/scene.json" > vortex.json
for n in 25 50; do
    expect 0 "" run vortex.json --set method=isph --set spacing=$(awk "BEGIN { print 1/$n }") --out vortex$n --quiet \
        --until 0.001
    expect 0 "" sample vortex$n --box "0,0 to 1,1" --cell 0.013 --until 1e-6 --fields velocity
    vtk "vortex $n" vortex$n/sample/box_000000.vti points=5929
done
if $python -c "import vtk" 2> /dev/null; then
    check "the vortex in second order" $python - <<'END2'
import math, numpy, vtk
from vtk.util.numpy_support import vtk_to_numpy
def error(n):
    reader = vtk.vtkXMLImageDataReader()
    reader.SetFileName(f"vortex{n}/sample/box_000000.vti")
    reader.Update()
    image, k = reader.GetOutput(), 2*math.pi
    x = numpy.array([image.GetPoint(i)[:2] for i in range(image.GetNumberOfPoints())])
    u = vtk_to_numpy(image.GetPointData().GetArray("velocity"))[:, :2]
    exact = numpy.stack([numpy.sin(k*x[:, 0])*numpy.cos(k*x[:, 1]), -numpy.cos(k*x[:, 0])*numpy.sin(k*x[:, 1])], 1)
    assert vtk_to_numpy(image.GetPointData().GetArray("wet")).min() == 1
    return math.sqrt(((u - exact)**2).sum(1).mean())
coarse, fine = error(25), error(50)
assert coarse < 0.025 and fine < 0.007 and 3 < coarse/fine < 5, (coarse, fine)
END2
fi

# A new run takes away what belongs to the one before.
expect 0 "" run three.json --out three --quiet --force
check "a new run takes it away" test ! -e three/sample

# What is refused.
expect 1 "there are no results of a run" sample nowhere --line "0,0 to 1,1"
expect 2 "which DIR?" sample --line "0,0 to 1,1"
expect 2 "where? one of --line, --points, --box" sample still
expect 2 "only one of --line, --points, --box" sample still --line "0,0 to 0.1,0.1" --box "0,0 to 0.1,0.1"
expect 2 "--count: '2.5' is not a whole number" sample still --line "0,0 to 0.1,0.1" --count 2.5
expect 1 "--box '0,0 to 0.1,0.1': a cell of 1 m is wider than the box" sample still --box "0,0 to 0.1,0.1" --cell 1
expect 1 "is not like" sample still --line "1e308,0 to -1e308,0" --with block
expect 0 "" sample still --line "0,0 to 0.1,0.1" --from 0 --until 0 --name start
check "the first output alone" test "$(grep -c . still/sample/start.csv)" = 51
expect 2 "--count: '1' is not a whole number from 2 to 1000000" sample still --line "0,0 to 0.1,0.1" --count 1
expect 2 "--count is for --line" sample still --box "0,0 to 0.1,0.1" --count 5
expect 2 "--cell is for --box" sample still --line "0,0 to 0.1,0.1" --cell 0.1
expect 2 "--from 2 lies behind --until 1" sample still --line "0,0 to 0.1,0.1" --from 2 --until 1
expect 2 "--fluid or --solid, not both" sample still --line "0,0 to 0.1,0.1" --fluid a --solid b
expect 2 "--name: '../x' is not of 1 to 60 letters, digits, - and _" sample still --line "0,0 to 1,1" --name ../x
expect 2 "--format: 'gif' is neither svg nor png" sample still --line "0,0 to 0.1,0.1" --format gif
expect 2 "--line: at most 12 times" sample still $(printf -- '--line=a %.0s' {1..13})
expect 1 "--line 'a to b': is not like \"0.5,0 to 0.5,0.3\", in metres; the run is in 2-D" sample still --line "a to b"
expect 1 "is not like \"0.5,0,0 to 0.5,0,0.3\", in metres; the run is in 3-D" sample three --line "0,0 to 0.1,0.1"
expect 1 "--line '0,0 to 0,0': both ends are the same" sample still --line "0,0 to 0,0"
expect 1 "the place 0.1,0.7,0 is outside of the domain, which is 0 to 0.6 m along y" sample still \
    --line "0.1,0.7 to 0.1,0.8"
expect 1 "--box '0.2,0 to 0.1,0.1': its corners are not in order along x" sample still --box "0.2,0 to 0.1,0.1"
expect 1 "--box '0.2,0 to 0.2,0': both corners are the same" sample still --box "0.2,0 to 0.2,0"
expect 1 "a cell of 1e-05 m makes 3.6e+09 places, allowed are 20000000; take a cell of 0.00014 m" sample still \
    --box "0,0 to 0.6,0.6" --cell 1e-5
expect 1 "still has no output in the time that is asked for; its outputs are from 0 to 0.1 s" sample still \
    --line "0,0 to 0.1,0.1" --from 3
expect 1 "still has no field 'presure'; did you mean pressure?" sample still --line "0,0 to 0.1,0.1" \
    --fields velocity,presure
expect 1 "still has no field 'heat'; it has velocity, pressure, density" sample still --line "0,0 to 0.1,0.1" \
    --fields heat
expect 1 "--fields: 'particle_id' numbers things" sample still --line "0,0 to 0.1,0.1" --fields particle_id
expect 1 "--with: there is no body 'blok'; did you mean block?" sample still --line "0,0 to 0.1,0.1" --with blok
expect 1 "--with: there is no body 'ship'; there are block" sample still --line "0,0 to 0.1,0.1" --with ship
expect 1 "--with block: three has no bodies" sample three --line "0,0,0 to 0.1,0.1,0.1" --with block
expect 1 "three has no fluid 'watr'; did you mean water?" sample three --line "0,0,0 to 0.1,0,0" --fluid watr
expect 1 "still has no solid 'cube'" sample still --line "0,0 to 0.1,0" --solid cube
expect 1 "missing.csv" sample still --points missing.csv
printf 'x,y\n0,1,0,2\n' > comma.csv
expect 1 "comma.csv: row 1 has more than the 2 columns of the first line; is a comma a decimal mark there?" \
    sample still --points comma.csv
printf 'x(m),y(m)\n0.1,0.2\n' > names.csv
expect 1 "names.csv: has no column 'x'; columns x, y are needed, as x or x [mm]; it has x(m), y(m)" \
    sample still --points names.csv
printf 'x,z\n0.1,0.1\n' > flat.csv
printf 'y [cm],x [mm]\n%s,%s\n' 10 100 > units.csv
expect 0 "" sample still --points units.csv --until 0.01 --name units
check "places in mm and cm" grep -q "^0,0,0.1,0.1,0," still/sample/units.csv
printf 'x [ft],y\n0.1,0.1\n' > feet.csv
expect 1 "feet.csv: the unit of column 'x [ft]' is not known; allowed are [m], [cm], [mm] or none" \
    sample still --points feet.csv
expect 1 "flat.csv: has no column 'y'; columns x, y are needed" sample still --points flat.csv
printf 'x,y\n' > empty.csv
expect 1 "empty.csv: has no places" sample still --points empty.csv
printf 'x,y\n0.1,0.1\n0.1,up\n' > words.csv
expect 1 "words.csv: place 2 has no number up to 1e+07 m in column 'y'" sample still --points words.csv
cp framed/bodies.csv whole.csv
sed -i '$s/0.25,0.2/,0.2/' framed/bodies.csv
expect 1 "framed/bodies.csv: the row of 'block' at 0.1" sample framed --with block --line "0.4,0.1 to 0.41,0.1"
sed 's/^time,name/when,what/' whole.csv > framed/bodies.csv
expect 1 "framed/bodies.csv: has no columns time and name" sample framed --with block --line "0.4,0.1 to 0.41,0.1"
sed '$d' whole.csv > framed/bodies.csv
expect 1 "framed/bodies.csv: has no row of 'block' at the output of 0.1 s" sample framed --with block \
    --line "0.4,0.1 to 0.41,0.1"
expect 0 "" run still.json --out bare --quiet --set 'output.fields=["particle_id"]' --until 0.05
expect 1 "the outputs of bare have no fields" sample bare --line "0,0 to 0.1,0.1"
cp bare/fluid/fluid_000001.vtu framed/fluid/fluid_000001.vtu
expect 1 "framed: the output of 0.05 s has no field 'velocity'" sample framed --line "0,0 to 0.1,0.1"
check "and nothing is left of it" test -z "$(find framed -name '*.part')"
expect 0 "" run three.json --out solid --quiet --set fluids=[] --set method=mlsmpm --set spacing=0.01
expect 1 "solid is a run without a liquid; --solid NAME takes a solid" sample solid --line "0,0,0 to 0.1,0.1,0.1"
expect 0 "" sample solid --line "0.45,0.1,0 to 0.45,0.1,0.4" --solid cube
rm -r still/sample && : > still/sample
expect 1 "still/sample is no folder" sample still --line "0,0 to 0.1,0.1"
rm still/sample
got=0; (ulimit -f 1; "$program" sample still --line "0,0 to 0.1,0.1" --count 1000 > out.txt 2> err.txt) || got=$?
check "a full disk is told: $(cat err.txt)" grep -q "cannot write still/sample/line.csv" err.txt
check "by its exit code, $got" test $got = 1
check "and leaves no part" test -z "$(find still -name '*.part')"
: > still/all.pvd
expect 1 "lists no particles" sample still --line "0,0 to 0.1,0.1"

echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
