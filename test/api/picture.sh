#!/bin/bash
# tobiuo picture and output.picture: pictures of a run, of its fields, the messages.
# usage: picture.sh PROGRAM      works in a fresh folder that it removes; last line: "N passed, N failed"
set -uo pipefail
here=$(cd "$(dirname "$0")" && pwd)
. "$here/checks.sh" "$1"

cat > dam.json <<'END'
{ "domain": {"min": [0, 0, 0], "max": [0.4, 0.2, 0.3]}, "gravity": [0, 0, -9.81], "spacing": 0.02, "end_time": 0.1,
  "fluids": [{"name": "water", "fill": [{"box": {"min": [0, 0, 0], "max": [0.2, 0.2, 0.2]}}]}],
  "bodies": [{"name": "post", "box": {"min": [0.3, 0.08, 0], "max": [0.34, 0.12, 0.2]}}],
  "output": {"interval": 0.05, "frames": true, "picture": {"width": 320, "height": 180}} }
END
# water that strikes the post: its force scatters
expect 0 "scatters by" run dam.json --out dam --quiet
expect 0 "" picture dam
check "a picture in its own size" test "$(head -c 24 dam/picture.png | tail -c 8 | od -An -tx1 | tr -d ' ')" = 00000140000000b4
expect 0 "" picture dam --output 1 --out a.png --set output.picture.field=pressure --set output.picture.axes=true
expect 0 "" picture dam --time 0 --out first.png
expect 0 "" picture dam --output 0 --out zero.png
check "a picture of a time" cmp first.png zero.png
(ulimit -f 4; exec "$program" picture dam --out narrow.png) > out.txt 2> err.txt
check "a picture without room is told" grep -q "cannot write narrow.png: File too large" err.txt
check "and leaves nothing" test -z "$(ls | grep narrow)"
expect 0 "the results of dam end at" picture dam --time 99 --out late.png
expect 0 "" picture dam --out last.png
check "a time behind the end" cmp late.png last.png
expect 2 "--time: 'x' is not a number from 0 on" picture dam --time x
expect 2 "'b.jpg' is no picture that can be made: its name ends in .png" picture dam --out b.jpg
expect 0 "" picture dam --output 1 --out b.png --set output.picture.field=pressure --set output.picture.axes=true
check "the same picture twice" cmp -s a.png b.png
for change in look=particles map=magma arrows=true slice=0.05 transparent=true max=2000; do
    expect 0 "" picture dam --output 1 --out b.png --set output.picture.field=pressure --set output.picture.axes=true \
        --set "output.picture.clip_normal=[1, 0, 0]" --set "output.picture.clip_point=[0.1, 0, 0]" \
        --set output.picture.$change
    check "$change changes it" test -s b.png -a "$(cmp -s a.png b.png; echo $?)" = 1
done
expect 0 "scatters by" run dam.json --out follows --quiet --set output.picture.follow=post --set "output.picture.look=surface" \
    --set "output.camera={\"position\": [0.2, -0.8, 0.3], \"look_at\": [0.2, 0.1, 0.1], \"angle\": 30}"
check "a picture at each output" test -s follows/frames/frame_000002.png

# What results show is what the run has drawn, bit by bit.
cat > all.json <<'END'
{ "domain": {"min": [0, 0, 0], "max": [0.4, 0.2, 0.3]}, "spacing": 0.021, "end_time": 0.06,
  "fluids": [{"name": "water", "color": [60, 120, 190], "fill": [{"box": {"min": [0, 0, 0], "max": [0.4, 0.2, 0.1]}}]}],
  "solids": [{"name": "jelly", "model": "neo-hookean", "density": 500, "youngs_modulus": 1e5, "poissons_ratio": 0.3,
              "color": [200, 40, 40], "core_color": [250, 240, 200],
              "fill": [{"box": {"min": [0.05, 0.05, 0.13], "max": [0.15, 0.15, 0.2]}}]}],
  "bodies": [{"name": "a box", "box": {"min": [0.25, 0.06, 0.08], "max": [0.33, 0.14, 0.14]}, "dynamics": "free",
              "density": 500, "opacity": 0.4}],
  "lines": [{"name": "rope", "kind": "rope", "body": "a box", "point": [0.29, 0.1, 0.14], "to": [0.29, 0.1, 0.28],
             "length": 0.3, "stiffness": 100}],
  "output": {"interval": 0.02, "frames": true, "picture": {"width": 320, "height": 180, "paths": true}} }
END
sed -e '/"solids"/,/"fill": .{"box": {"min": .0.05/d' all.json > wet.json
sed -e '/"lines"/,/"length"/d; /"bodies"/,/"density"/d; s/"paths": true/"axes": true/' all.json > soft.json
for scene in wet soft; do
    expect 0 "" run $scene.json --out $scene --quiet
    for k in 0 2; do
        expect 0 "" picture $scene --output $k --out r.png
        check "$scene: the picture of output $k is that of the run" cmp -s r.png $scene/frames/frame_00000$k.png
    done
done
check "the rope is in the results" test -s wet/surfaces/line_rope_000002.vtp
expect 0 "" picture wet --out a.png
expect 0 "" picture wet --out b.png --set output.picture.paths=false
check "paths are drawn" test "$(cmp -s a.png b.png; echo $?)" = 1
expect 0 "" picture wet --out b.png --set "bodies[0].opacity=1"
check "opacity can be changed afterwards" test "$(cmp -s a.png b.png; echo $?)" = 1
expect 0 "" picture wet --out a.png --set output.picture.field=pressure
expect 0 "" picture wet --out b.png --set output.picture.field=pressure --set output.picture.isolines=7
check "isolines are drawn" test "$(cmp -s a.png b.png; echo $?)" = 1
expect 1 "is 101, allowed is 0 to 100" picture wet --set output.picture.isolines=101
expect 1 "is 2, allowed is 0.01 to 1, or \"automatic\"" run wet.json --out no --set "bodies[0].opacity=2"

camera='output.camera={"position": [0.32, 0.1, 0.1], "look_at": [0.2, 0.1, 0.1], "angle": 30}'
expect 0 "the camera is inside of the body 'post', which hides all else" picture dam --set "$camera"
"$program" run dam.json --out within --set "$camera" > /dev/null 2> notes
check "a camera inside of a body is told, and the run goes on" \
    test "$(grep -c "is inside of the body 'post'" notes)" = 1 -a -s within/frames/frame_000002.png

views='output.views=[{"name": "top", "camera": {"position": [0.2, 0.1, 2], "look_at": [0.2, 0.1, 0], "angle": 20},
    "picture": {"field": "pressure", "width": 320, "height": 180}}, {"name": "all", "picture": {"width": 160}}]'
expect 0 "scatters by" run dam.json --out views --quiet --set "$views"
check "a picture of each view at each output" test -s views/frames/top_000002.png -a -s views/frames/all_000002.png
check "the output's own are the same" cmp -s views/frames/frame_000001.png dam/frames/frame_000001.png
expect 0 "" picture views --view top
expect 0 "" picture views --view all --output 1
expect 0 "" picture views --view top --set output.views.top.picture.axes=true --out axes_of_top.png
expect 0 "" picture views --view top --set output.picture.axes=true --out axes.png
check "a --set of the picture is of the view" cmp -s axes.png axes_of_top.png
expect 0 "" picture views --view top --out top.png
check "and changes it" test "$(cmp -s top.png axes.png; echo $?)" = 1
expect 0 "scatters by" run dam.json --out views --quiet --force
check "pictures of an earlier run are gone" test ! -e views/frames/top_000000.png
expect 1 "the scene of dam has no view 'top'" picture dam --view top
expect 1 "\"frame\", the name of the output's own pictures" run dam.json --out no --set 'output.views=[{"name": "frame"}]'
expect 1 "\"a\" is the name of views[0] too" run dam.json --out no --set 'output.views=[{"name": "a"}, {"name": "a"}]'
expect 1 "there are no results of a run" picture .
expect 1 "there is no output 9" picture dam --output 9
expect 1 "the output has no field 'vorticity'; a run writes it with \"fields\": [\"usual\", \"vorticity\"] in output" \
    picture dam --set output.picture.field=vorticity
expect 0 "" picture dam --set output.picture.field=velocity_x --out vx.png
expect 1 "there is no field \"velocity_w\"" picture dam --set output.picture.field=velocity_w
expect 1 "there is no field \"pressur\"" picture dam --set output.picture.field=pressur
expect 1 "is \"solids\", but the scene has none" picture dam --set output.picture.field_of=solids
expect 1 "\"nobody\" is no body of the scene" run dam.json --out no --set output.picture.follow=nobody
expect 2 "--output: 'x' is not a number from 0 on" picture dam --output x
cat > flat.json <<'END'
{ "dimension": 2, "domain": {"min": [0, 0], "max": [0.4, 0.3]}, "spacing": 0.02, "end_time": 0.1,
  "fluids": [{"name": "water", "fill": [{"box": {"min": [0, 0], "max": [0.2, 0.2]}}]}],
  "output": {"picture": {"clip_point": [0.1, 0, 0], "clip_normal": [0, 0, 1]}} }
END
expect 1 "points out of the plane of the 2-D scene" check flat.json
expect 0 "" check flat.json --set 'output.picture.clip_normal=[1, 0, 0]'
expect 1 "is 0.5, allowed is 1 to 150" check dam.json --set output.camera.angle=0.5
expect 1 "cannot write /no/such/p.png" picture dam --out /no/such/p.png

echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
