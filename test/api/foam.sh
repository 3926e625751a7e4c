#!/bin/bash
# tobiuo foam: points of a run that VTK reads, the same for any number of threads, messages.
# usage: foam.sh PROGRAM      works in a fresh folder that it removes; last line: "N passed, N failed"
set -uo pipefail
here=$(cd "$(dirname "$0")" && pwd)
. "$here/checks.sh" "$1"

# Drops that fall fast onto shallow water.
cat > splash.json <<'END'
{ "domain": {"min": [0, 0, 0], "max": [0.3, 0.2, 0.3]}, "gravity": [0, 0, -9.81], "spacing": 0.02, "end_time": 0.08,
  "fluids": [{"name": "water", "fill": [{"box": {"min": [0, 0, 0], "max": [0.3, 0.2, 0.06]}},
    {"box": {"min": [0.1, 0.06, 0.08], "max": [0.2, 0.14, 0.18]}, "velocity": [0, 0, -4]}]}],
  "output": {"interval": 0.01} }
END
expect 0 "come apart into drops" run splash.json --out splash --quiet
expect 0 "" foam splash --amount 3
check "it says what it did" grep -qE "^foam: splash/foam, 9 files, up to [0-9.e+]+ particles" out.txt
check "a file for each output" test -s splash/foam/foam_000008.vtp
# vtk WHAT FILE KEY=VALUE: VTK reads it and finds that (without VTK, code 77, nothing is checked)
vtk() {
    local code=0 what=$1
    shift
    /usr/bin/python3 "$here/read_vtk.py" "$@" > out.txt || code=$?
    check "$what: $(tail -1 out.txt)" test $code = 0 -o $code = 77
}
vtk "VTK reads it" splash/foam/foam_000008.vtp 'arrays={"velocity": 3, "kind": 1, "age": 1, "life": 1, "id": 1}'
vtk "its list" splash/foam.pvd 'times=[0, 0.01, 0.02, 0.03, 0.04, 0.05, 0.06, 0.07, 0.08]'
points() { grep -ao 'NumberOfPoints="[0-9]*"' "$1" | tr -dc 0-9; }
check "none at the start" test "$(points splash/foam/foam_000000.vtp)" = 0
check "some at the end" test "$(points splash/foam/foam_000008.vtp)" -gt 50
check "no parts are left" test -z "$(find splash -name '*.part')"

# Pictures and movies show it, whatever the run has drawn; without foam they are those of the run.
expect 0 "" picture splash --out white.png
expect 0 "" picture splash --out plain.png --set output.picture.foam=false
check "a picture shows it" test "$(cmp white.png plain.png > same.txt; echo $?)" = 1
mv splash/foam aside
expect 0 "" picture splash --out without.png
check "without it there is none" cmp plain.png without.png
mv aside splash/foam
expect 0 "draws 9 pictures" movie splash --out sheet.png
expect 0 "draws 9 pictures" movie splash --out bare.png --set output.picture.foam=false
check "a sheet of pictures shows it" test "$(cmp sheet.png bare.png > same.txt; echo $?)" = 1

mv splash/foam one
expect 0 "" foam splash --amount 3 --threads 3
check "the same bits" diff -r one splash/foam
expect 0 "there was no room for" foam splash --amount 3 --most 40
check "what takes more is told" grep -qE "from 0\.0[0-9]* s on .* --most takes more" err.txt

# The run's own pictures have it: when it is made afterwards, and by run --foam.
cp -r splash drawn && rm -r drawn/foam drawn/foam.pvd
expect 0 "draws 9 pictures into drawn/frames" movie drawn --out bare2.png
check "pictures without foam" cmp bare2.png bare.png
expect 0 "draws 9 pictures in drawn/frames anew" foam drawn --amount 3
check "tobiuo foam draws them anew" cmp drawn/frames/frame_000008.png white.png
views='output.views=[{"name": "side", "picture": {"foam": false}}]'
expect 0 "draws 9 pictures into own/frames" run splash.json --out own --quiet --frames --foam --set "$views"
check "run --foam draws each picture once" test "$(grep -c draws err.txt)" = 2
check "a view without foam too" test -s own/frames/side_000008.png
expect 0 "come apart" run splash.json --out live --quiet --frames
check "a run without foam draws them itself" \
    test "$(grep -c draws err.txt)" = 0 -a -s live/frames/frame_000008.png
expect 1 "the output has no field 'pressure'" run splash.json --out lacks --quiet --frames --foam \
    --set 'output.fields=["velocity"]' --set output.picture.field=pressure
check "those that no file can draw are the run's" test -s lacks/frames/frame_000008.png
"$program" run splash.json --out stopped --quiet --frames --foam --until 60 > out.txt 2> err.txt &
pid=$!
while [ ! -e stopped/fluid/fluid_000002.vtu ] && kill -0 $pid 2> /dev/null; do sleep 0.01; done
kill -TERM $pid
wait $pid
check "a run that is stopped tells what draws them" \
    grep -q "its pictures have waited for the foam; both, now: tobiuo foam stopped" err.txt
check "and has drawn none" test ! -e stopped/frames
expect 0 "pictures into stopped/frames" foam stopped
check "tobiuo foam draws them" test -s stopped/frames/frame_000002.png
expect 0 "" picture own --out own.png
check "run --foam draws pictures with it" cmp own/frames/frame_000008.png own.png
expect 0 "" picture own --out own_bare.png --set output.picture.foam=false
check "which is seen" test "$(cmp own.png own_bare.png > same.txt; echo $?)" = 1
expect 1 "--foam: needs the field velocity; add it to output.fields" run splash.json --out never --foam \
    --set 'output.fields=["pressure"]'
expect 1 "--foam: a run without a liquid makes none" run splash.json --out never --foam --set fluids=[] \
    --set method=mlsmpm --set 'solids=[{"name": "block", "density": 1000, "youngs_modulus": 1e5,
        "fill": [{"box": {"min": [0, 0, 0], "max": [0.1, 0.1, 0.1]}}]}]'
check "and nothing is run" test ! -e never

# Still water makes none.
expect 0 "" run splash.json --out still --quiet --set 'fluids[0].fill[1].velocity=[0,0,0]' \
    --set 'fluids[0].fill[1].box.min=[0,0,0.06]' --set 'fluids[0].fill[1].box.max=[0.3,0.2,0.1]'
expect 0 "" foam still
check "still water makes none" grep -q "up to 0 particles" out.txt

expect 1 "there are no results of a run" foam nowhere
sed '/name="fluid"/{/fluid_000000/!d}' still/all.pvd > one.pvd && mv one.pvd still/all.pvd
expect 1 "still has one output only; foam is made between two" foam still
expect 2 "which DIR?" foam
expect 2 "--amount: 2000 is not above 0 to 1000" foam splash --amount 2000
expect 2 "--most: '0' is not a number from 1 to" foam splash --most 0
expect 0 "" run splash.json --out bare --quiet --set 'output.fields=["pressure"]' --until 0.01
expect 1 "has no field 'velocity', which foam needs; output.fields of the scene writes it" foam bare
rm -r splash/foam && : > splash/foam
expect 1 "splash/foam is no folder" foam splash
rm splash/foam
got=0; (ulimit -f 1; "$program" foam splash --amount 3 > out.txt 2> err.txt) || got=$?
check "a full disk is told" grep -q "cannot write splash/foam/foam_0000" err.txt
check "by its exit code, $got" test $got = 1
check "and leaves no part" test -z "$(find splash -name '*.part')"
expect 0 "" foam splash
expect 0 "" run splash.json --out splash --quiet --force --until 0.01
check "a new run takes it away" test ! -e splash/foam/foam_000008.vtp

echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
