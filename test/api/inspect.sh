#!/bin/bash
# tobiuo inspect: files of the neighbour search as VTK reads them, tables of the kernels, messages.
# usage: inspect.sh PROGRAM      works in a fresh folder that it removes; last line: "N passed, N failed"
# Answers 77 (skipped) without gnuplot, after the tests that do without it.
set -uo pipefail
here=$(cd "$(dirname "$0")" && pwd)
. "$here/checks.sh" "$1"

# vtk WHAT FILE [KEY=VALUE...]: VTK reads it and finds that (without VTK, code 77, nothing is checked)
vtk() {
    local code=0 what=$1
    shift
    /usr/bin/python3 "$here/read_vtk.py" "$@" > out.txt || code=$?
    check "$what: $(tail -1 out.txt)" test $code = 0 -o $code = 77
}

# 20 x 20 particles of 0.01 m; the support of 2.5 spacings reaches 20 neighbours.
cat > tank.json <<'END'
{ "domain": {"min": [0, 0], "max": [0.2, 0.2]}, "dimension": 2, "gravity": [0, -9.81], "spacing": 0.01,
  "end_time": 0.1, "method": "dfsph", "dfsph": {"kernel": "cubic-spline", "support": 2.5},
  "fluids": [{"name": "water", "fill": [{"box": {"min": [0, 0], "max": [0.2, 0.2]}}]}] }
END
expect 2 "which SCENE?" inspect
expect 2 "--at wants X,Y,Z" inspect tank.json --at 1
expect 2 "--at wants X,Y,Z" inspect tank.json --at 1,2,3,4
expect 2 "is no particle_id" inspect tank.json --id -1
expect 2 "one of them" inspect tank.json --id 1 --at 0,0
expect 2 "neither svg nor png" inspect tank.json --format gif
expect 1 "the fluid has no particle 400" inspect tank.json --id 400
check "nothing was written so far" test ! -e out
: > blocked
expect 1 "blocked" inspect tank.json --out blocked
got=0; PATH=/nonexistent "$program" inspect tank.json --out bare > out.txt 2> err.txt || got=$?
check "gnuplot missing: exit code 1 (was $got)" test $got = 1
check "gnuplot missing: the package is named" grep -q "gnuplot-nox" err.txt
check "the table is printed" grep -q "^  *25  *4e-06  *[01][.0-9]*  *[01][.0-9]*" out.txt
$python - <<'END'
import csv
rows = list(csv.DictReader(open("bare/kernel_integrals.csv")))
assert [int(r["points_per_side"]) for r in rows] == [5, 10, 15, 20, 25], rows
assert all(abs(float(rows[-1][k]) - 1) < 1e-4 for k in rows[0] if k not in ("points_per_side", "volume")), rows
curves = list(csv.DictReader(open("bare/kernel_curves.csv")))
assert float(curves[-1]["r"]) == 0.025 and float(curves[-1]["cubic-spline_W"]) == 0
assert abs(float(curves[0]["cubic-spline_W"]) - 40/(7*3.141592653589793*0.025**2)) < 1e-5 * 2910
END
check "the tables hold what they should" test $? = 0
# The published table of the cubic spline in 3-D.
sed 's/\[0, 0\]/[0, 0, 0]/g; s/\[0.2, 0.2\]/[0.2, 0.2, 0.2]/g; s/"dimension": 2/"dimension": 3/; s/\[0, -9.81\]/[0, 0, -9.81]/' tank.json > cube.json
PATH=/nonexistent "$program" inspect cube.json --spacing 0.02 --out cube > out.txt 2> err.txt
check "the document's sums" test "$($python -c 'import csv
print(*("%.6g" % float(r["cubic-spline"]) for r in csv.DictReader(open("cube/kernel_integrals.csv"))))')" = "1.00527 1.00011 0.999972 1 1"
vtk "all" bare/all.vtp points=400 cells=400 'arrays={"particle_id": 1, "cell": 1}'
vtk "center" bare/center.vtp points=1
vtk "inSphere" bare/inSphere.vtp points=21 'arrays={"weight": 1, "distance": 1}'

if ! command -v gnuplot > /dev/null; then
    echo "$passed passed, $failed failed; no gnuplot (Debian package gnuplot-nox)"
    [ $failed -eq 0 ] && exit 77
    exit 1
fi
expect 0 "" inspect tank.json --id 0
check "the folder is that of the scene" test -e out/tank/inspect/kernels.svg
check "kernels are named" grep -q "cubic-spline" out/tank/inspect/kernels.svg
check "axes have units" grep -q "dW/dr, 1/m3" out/tank/inspect/kernels.svg
vtk "a corner sees less" out/tank/inspect/inSphere.vtp points=8
# Cells are a little wider than the support: 7 a side, of which it sees 2, to 0.057 m.
vtk "and less cells" out/tank/inspect/inCell.vtp points=36
expect 0 "" run tank.json --quiet
expect 0 "" inspect tank.json --at 0.2,0.2 --format png
check "again, beside a run" test -e out/tank/inspect/kernels.png
vtk "the last particle" out/tank/inspect/center.vtp points=1 'ranges={"particle_id": [399, 399]}'

echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
