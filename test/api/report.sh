#!/bin/bash
# tobiuo report and picture sheets: what the page says, and what a browser makes of it.
# usage: report.sh PROGRAM      works in a fresh folder that it removes; last line: "N passed, N failed"
# Answers 77 (skipped) without chromium, gnuplot or ffmpeg, after the tests that do without them.
set -uo pipefail
. "$(dirname "$0")/checks.sh" "$1"

cat > box.obj <<'END'
v -0.1 -0.1 -0.1
v 0.1 -0.1 -0.1
v -0.1 0.1 -0.1
v 0.1 0.1 -0.1
v -0.1 -0.1 0.1
v 0.1 -0.1 0.1
v -0.1 0.1 0.1
v 0.1 0.1 0.1
f 1 3 4 2
f 5 6 8 7
f 1 2 6 5
f 3 7 8 4
f 1 5 7 3
f 2 4 8 6
END
cat > tank.json <<'END'
{ "domain": { "min": [0, 0, 0], "max": [1, 1, 1] }, "spacing": 0.1, "end_time": 0.1,
  "fluids": [ { "name": "water & ice", "fill": [ { "box": { "min": [0, 0, 0], "max": [0.5, 1, 0.5] } } ] } ],
  "bodies": [ { "name": "box & co", "mesh": "box.obj", "translation": [0.7, 0.5, 0.5], "dynamics": "free",
                "density": 500 },
              { "name": "plate", "mesh": "box.obj", "scale": [0.2, 1, 1], "translation": [0.7, 0.5, 0.8] } ],
  "probes": [ { "name": "P", "position": [0.1, 0.5, 0.1] }, { "name": "H", "kind": "level", "position": [0.2, 0.5, 0] },
              { "name": "V", "kind": "volume", "position": [0.2, 0.5, 0.2], "length": 0.3, "width": 0.3, "height": 0.3 } ],
  "output": { "interval": 0.02 } }
END
cat > jelly.json <<'END'
{ "method": "mlsmpm", "dimension": 2, "domain": { "min": [0, 0], "max": [1, 1] }, "spacing": 0.05, "end_time": 0.01,
  "solids": [ { "name": "a", "youngs_modulus": 1e4, "fill": [ { "box": { "min": [0.2, 0.2], "max": [0.4, 0.4] } } ] },
              { "name": "b", "youngs_modulus": 1e4, "fill": [ { "box": { "min": [0.6, 0.2], "max": [0.8, 0.4] } } ] } ],
  "output": { "interval": 0.005 } }
END
# says FILE TEXT: the page's text contains it
says() { grep -qF -- "$2" <(sed 's/&amp;/\&/g; s/&lt;/</g; s/&gt;/>/g; s/&quot;/"/g' "$1"); }

# --- friction ---
cat > stir.json <<'END'
{ "dimension": 2, "domain": { "min": [0, 0], "max": [0.4, 0.3] }, "spacing": 0.02, "end_time": 0.02,
  "fluids": [ { "name": "oil", "viscosity": 0.1, "fill": [ { "box": { "min": [0, 0], "max": [0.4, 0.2] } } ] } ],
  "bodies": [ { "name": "gear", "box": { "min": [0.1, 0.08], "max": [0.2, 0.12] }, "friction": "no-slip",
                "motion": { "rotation": { "centre": [0.15, 0.1], "rate": 90 } } } ],
  "output": { "interval": 0.01 } }
END
for support in 2 2.5; do
    expect 0 "" run stir.json --set dfsph.support=$support --out stir$support --quiet
    PATH=/nonexistent "$program" report stir$support > out.txt 2> err.txt
done
check "friction at a support of 2" says stir2/report.html "Set dfsph.support to 2.5 or more, or use isph."
check "none at 2.5" test "$(grep -c 'Set dfsph.support to 2.5' stir2.5/report.html)" = 0

# --- energy from nothing ---
cat > dam.json <<'END'
{ "dimension": 2, "domain": { "min": [0, 0], "max": [1, 1] }, "spacing": 0.04, "end_time": 0.5, "gravity": [0, -9.81],
  "fluids": [ { "name": "water", "fill": [ { "box": { "min": [0, 0], "max": [0.52, 0.52] } } ] } ],
  "output": { "interval": 0.02 } }
END
rough="--set method=isph --set cfl=1 --set isph.renormalised=false --set isph.pressure_gradient=plain"
expect 0 "" run dam.json --out dam --quiet
PATH=/nonexistent "$program" report dam > out.txt 2> err.txt
check "a dam gains nothing" says dam/report.html \
    "Nothing drives the scene. The most that liquid and solids have gained is 0 % of their energy."
expect 0 "J from nothing, beside 690 J" run dam.json $rough --set isph.surface_height=0 --out dam --quiet --force
PATH=/nonexistent "$program" report dam --force > out.txt 2> err.txt
check "a rough isph does" says dam/report.html "from nothing, beside 690 J"
expect 1 "the kinetic energy of liquid and solids has become" run dam.json --set time_step=0.03 --set speed_limit=1000 \
    --out dam --quiet --force
check "that run diverged" grep -q '"outcome": "diverged"' dam/summary.json

# --- files of a scene that change -------------------------------------------------------------------
expect 0 "" run tank.json --out swapped --quiet --until 0.04
cp -p box.obj good.obj && echo "# a remark" >> box.obj
touch -d 2000-01-01 box.obj
expect 0 "box.obj has changed since the run read it; the drawing goes on with it as it is now" picture swapped
expect 0 "box.obj has changed since the run read it; the run goes on with it as it is now" resume swapped --quiet \
    --until 0.06
check "it is named once" test "$(grep -c . err.txt)" = 1
check "both states are kept" test "$(grep -c '/box.obj' swapped/inputs.json)" = 2
check "with the time of the second" grep -q '"time": 0.04,' swapped/inputs.json
check "and digests as sha256sum has them" grep -q "$(sha256sum box.obj | cut -d ' ' -f 1)" swapped/inputs.json
PATH=/nonexistent "$program" report swapped > out.txt 2> err.txt
check "the report says so" grep -q "From 0.04 s on, the run has read .*box.obj in another state" swapped/report.html
sweep=(sweep tank.json --set cfl=0.3 --until 0.02 --out sweep)
"$program" "${sweep[@]}" > out.txt 2> err.txt
touch good.obj && mv good.obj box.obj
expect 1 "box.obj has changed since sweep/run read it; choose another --out, or remove that folder" "${sweep[@]}"

expect 1 "sweep is a sweep: its runs are the folders in it" report sweep
expect 1 "sweep is a sweep: its runs are the folders in it" plot sweep

# --- waves, of a table that is written here: 40 mm high, then 80 mm, each 1.25 s long, with ripples of 1 mm ---
cat > flume.json <<'END'
{ "dimension": 2, "domain": { "min": [0, 0], "max": [3, 0.6] }, "spacing": 0.05, "end_time": 0.02, "method": "isph",
  "fluids": [ { "name": "water", "fill": [ { "box": { "min": [0.5, 0], "max": [3, 0.3] } } ] } ],
  "bodies": [ { "name": "paddle", "box": { "min": [0.3, 0], "max": [0.5, 0.6] } } ],
  "probes": [ { "name": "A", "kind": "level", "position": [1, 0] }, { "name": "B", "kind": "level", "position": [2, 0] } ],
  "output": { "interval": 0.01 } }
END
expect 0 "" run flume.json --out flume --quiet
$python - <<'END'
from math import cos, pi, sin
with open("flume/probes.csv", "w") as out:
    print("time [s],A_level [m],B_level [m]", file=out)
    for k in range(1001):
        t = 0.01*k
        high = 0.02 if t < 5 else 0.04
        print(t, 0.3 - high*sin(2*pi*t/1.25) + 0.0005*cos(200*t), 0.3 + 0.001*sin(9*t), sep=",", file=out)
rows = open("flume/history.csv").read().split("\n")
rows[-2] = "10" + rows[-2][rows[-2].index(","):]
open("flume/history.csv", "w").write("\n".join(rows))
END
PATH=/nonexistent "$program" report flume > out.txt 2> err.txt
row() { sed -n 's/^<tr><td>'"$2"'<td>//p' "$1" | sed 's/<td class=doc>//; s/<td>/ /g' | tail -1; }
near() { $python -c 'import sys; a, b = ([float(x) for x in t.split()] for t in sys.argv[1:3])
sys.exit(len(a) != len(b) or any(abs(x - y) > 0.03*y for x, y in zip(a, b)))' "$1" "$2"; }
check "number, period and heights of waves" near "$(row flume/report.html A)" "7 1.25 0.061 0.081 0.081 0.041"
check "rest is no wave" test -z "$(row flume/report.html B)"
PATH=/nonexistent "$program" report flume --from 5 --out later.html > out.txt 2> err.txt
check "of the time from 5 s on" near "$(row later.html A)" "3 1.25 0.081 0.081 0.081 0.081"
check "a paddle that closes the section lets no front go" test "$(grep -c 'beside free floor' flume/report.html)" = 0
sed -i '/^[0-9.]*,paddle/{$!s/,paddle,[^,]*,[^,]*/,paddle,0.4,0.5/}' flume/bodies.csv
PATH=/nonexistent "$program" report flume --force > out.txt 2> err.txt
check "one that is drawn up does" says flume/report.html "Water stands beside free floor"

cat > pipe.json <<'END'
{ "dimension": 2, "domain": { "min": [0, 0], "max": [2, 0.4] }, "spacing": 0.05, "end_time": 0.02, "method": "isph",
  "fluids": [ { "name": "water", "fill": [ { "box": { "min": [0.4, 0], "max": [1.6, 0.4] }, "velocity": [1, 0] } ] } ],
  "inlets": [ { "name": "in", "centre": [0.4, 0.2], "normal": [1, 0], "width": 0.4, "speed": 1 } ],
  "outlets": [ { "name": "out", "centre": [1.6, 0.2], "normal": [1, 0], "width": 0.4 } ], "output": { "interval": 0.01 } }
END
expect 0 "" run pipe.json --out pipe --quiet
PATH=/nonexistent "$program" report pipe > out.txt 2> err.txt
check "nor do an inlet and an outlet" test "$(grep -c 'beside free floor' pipe/report.html)" = 0

# --- without other programs -------------------------------------------------------------------------
expect 2 "which DIR?" report
expect 2 "--out is empty" report x --out=
expect 1 "there is no run to report on" report nowhere
expect 0 "" run tank.json --out tank --quiet --frames
expect 0 "" run jelly.json --out jelly --quiet
expect 0 "" movie tank --out sheet.png
check "a sheet of four pictures in two rows" grep -qF "1292" <($python -c '
import struct; print(*struct.unpack(">II", open("sheet.png", "rb").read()[16:24]))')
expect 1 "sheet.png exists; --force replaces it" movie tank --out sheet.png
expect 0 "" movie tank --out sheet.png --force
expect 0 "draws 3 pictures" movie jelly --out jelly.png
rm -r jelly/frames
expect 1 "there is no run" movie nowhere --out none.png
expect 1 "cannot write" movie tank --out /proc/sheet.png
cp -r tank torn && echo "no picture" > torn/frames/frame_000000.png
expect 1 "cannot read torn/frames/frame_000000.png" movie torn --out none.png
got=0; PATH=/nonexistent "$program" report tank --out bare.html > out.txt 2> err.txt || got=$?
check "neither gnuplot nor ffmpeg: exit code 0 (was $got)" test $got = 0
check "both are named" test "$(grep -c 'apt-get install' err.txt)" = 2
cp -r tank hurt && rm hurt/frames/frame_000003.png && truncate -s 100 hurt/summary.json
got=0; PATH=/nonexistent "$program" report hurt > out.txt 2> err.txt || got=$?
check "a summary that is damaged: exit code 0 (was $got)" test $got = 0
check "is named" grep -q "hurt/summary.json is damaged, and the report does without it: line" err.txt
check "on the page, too" says hurt/report.html "Damaged, and left out: summary.json."
check "which does not say that the run has not ended" test "$(grep -c 'has not ended' hurt/report.html)" = 0
check "a picture in the middle that is gone" says hurt/report.html "Of the pictures 1 is missing; the one before is shown in its place"
check "and the page says so" says bare.html "There are none: they need gnuplot."
check "of the movie too" says bare.html "There is no movie: it needs ffmpeg."
check "no remains" test -z "$(find . -name '*.part' -o -name 'report_*')"

check "the solver" says bare.html "It converged in all of"
check "a body of two spacings" says bare.html "Narrowest 0.2 m, 2.0 spacings. Small bodies have too much drag"
check "its name is text" says bare.html "body box & co"
check "the fluid's too" grep -qF "water &amp; ice" bare.html
check "a plate of 0.4 spacings" says bare.html "Narrowest 0.04 m, 0.4 spacings."
check "a dam" says bare.html "Water stands beside free floor"
check "waves of dfsph" says bare.html "Set dfsph.support to 3"
check "a table of the box" says bare.html "Body box & co"
check "its mass, and its share of the water's density" grep -qF "<tr><td>box &amp; co<td>4<td>0.008<td>0.5<td>" bare.html
check "a plate that stays is not among them" test "$(grep -c '<td>plate<td>' bare.html)" = 0
check "of the probes" says bare.html "Probe P"
check "of each kind of probe" says bare.html "Volume of liquid in the box"
check "with units" says bare.html "<td>Pa<td>"
check "times by stage" says bare.html "density solve"
check "the scene" says bare.html '"interval": 0.02'
PATH=/nonexistent "$program" report jelly --out jelly.html > out.txt 2> err.txt
check "solids stick" says jelly.html "Solids stick to each other."
check "no pictures" says jelly.html "There are none: the scene was run without"
check "2-D units" says jelly.html "<td>J per m<td>"
check "nothing of waves" test "$(grep -c 'Waves are' jelly.html)" = 0
$python - <<'END'
import csv, math, re
rows = list(csv.DictReader(open("tank/history.csv")))
t = [float(r["time"]) for r in rows]; y = [float(r["kinetic_energy"]) for r in rows]
mean = sum((t[i] - t[i - 1])*(y[i] + y[i - 1])/2 for i in range(1, len(t)))/t[-1]
cells = re.search(r"<td>kinetic_energy<td>J<td>([^<]*)<td>([^<]*)<td>([^<]*)<td>[^<]*<td>([^<]*)<td>[^<]*"
                  "<td class=doc>Of all fluid", open("bare.html").read()).groups()
want = (y[-1], mean, min(y), max(y))
print(cells, want)
raise SystemExit(not all(math.isclose(float(c), w, rel_tol=1e-4, abs_tol=1e-12) for c, w in zip(cells, want)))
END
check "last, mean, least and most are those of the table" test $? = 0
mkdir moved && cp -r tank/* moved && mv box.obj box.old
PATH=/nonexistent "$program" report moved > out.txt 2> err.txt
check "a run whose meshes are gone" says moved/report.html "Spacings across bodies are not known"
mv box.old box.obj && rm moved/summary.json moved/resolved.json
PATH=/nonexistent "$program" report moved --force > out.txt 2> err.txt
check "a run without its end" says moved/report.html "The run has not ended"
expect 1 "moved/report.html exists; --force replaces it" report moved
expect 1 "cannot write /proc/page.html" report moved --out /proc/page.html
echo "when" > moved/history.csv
expect 1 'has no column "time"' report moved --force

# --- waves in two dimensions ------------------------------------------------------------------------
cat > barge.json <<'END'
{ "method": "isph", "dimension": 2, "domain": { "min": [0, 0], "max": [2, 0.6] }, "spacing": 0.04, "end_time": 0.4,
  "fluids": [ { "name": "water", "fill": [ { "box": { "min": [0.2, 0], "max": [1.6, 0.32] } } ] } ],
  "bodies": [ { "name": "piston", "box": { "min": [0.1, 0], "max": [0.2, 0.6] },
                "motion": { "piston": { "depth": 0.32, "regular": { "height": 0.04, "period": 1.2 }, "ramp": 1 } } },
              { "name": "pier", "box": { "min": [1.6, 0], "max": [1.7, 0.6] } },
              { "name": "step", "box": { "min": [1.4, 0], "max": [1.5, 0.16] } },
              { "name": "barge", "box": { "min": [0.8, 0.24], "max": [1.12, 0.4] }, "dynamics": "free", "density": 500 } ],
  "lines": [ { "name": "rope", "body": "barge", "point": [0.8, 0.24], "to": [0.4, 0], "stiffness": 200 } ],
  "probes": [ { "name": "V", "kind": "volume", "position": [1, 0.16], "length": 0.4, "height": 0.3 },
              { "name": "W", "kind": "patch", "position": [1.6, 0.16], "normal": [-1, 0], "length": 0.2 } ],
  "output": { "interval": 0.1 } }
END
"$program" run barge.json --out barge --quiet > out.txt 2> err.txt
PATH=/nonexistent "$program" report barge --from 0.25 > out.txt 2> err.txt
check "the table of a line" says barge/report.html "<td>tension<td>N per m<td>"
check "places and stability in the plane alone" \
    grep -q "<tr><td>barge<td>25.6<td>0.0512<td>0.5<td>0.96 0.32<td>[^ ]*<td>0.08<td>[^ ]*<td class=doc>" barge/report.html
check "units of sensors" says barge/report.html "<td>volume<td>m2<td>"
check "as in the tables" grep -q "^time \[s\],V_volume \[m2\],W_pressure \[Pa\],W_force_x \[N per m\]" barge/probes.csv
check "a piston and a pier are no small bodies" test "$(grep -c 'It closes the whole section' barge/report.html)" = 2
check "a step stands on the floor" says barge/report.html "2.5 spacings, and it stands on a side of the domain."
check "only the barge may be wrong" test "$(grep -c 'mark wrong' barge/report.html)" = 1
check "isph has its waves right" test "$(grep -c '<td>waves<td' barge/report.html)" = 0
check "the meaning stands with the first component that is shown" \
    grep -q "<td>wall_force_y<td>N per m<td>.*Force of the fluid on the sides of the domain" barge/report.html
check "times before --from do not count" $python -c '
import re
cells = re.findall(r"<td>(?:position_|tension|volume|kinetic)[^\n]*", open("barge/report.html").read())
times = [float(re.split("<td[^>]*>", c)[k]) for c in cells for k in (6, 8)]
raise SystemExit(len(times) < 10 or min(times) < 0.25)'
expect 1 "--from 4: the run ends at 0.4 s" report barge --from 4 --force
expect 2 "--from" report barge --from x
check "check tells two coordinates" grep -qx "domain           0 0  to  2 0.6 m" <("$program" check barge.json)

for tool in chromium gnuplot ffmpeg; do
    command -v $tool > /dev/null && continue
    echo "$passed passed, $failed failed; the rest was skipped: $tool is missing"
    [ $failed -eq 0 ] && exit 77
    exit 1
done

# --- in a browser -----------------------------------------------------------------------------------
expect 0 "" report tank
check "the report's own files are gone" test -z "$(find tank -name 'report_*')"
cat > cup.json <<'END'
{ "domain": { "min": [-0.1, -0.1, -0.1], "max": [0.3, 0.3, 0.3] }, "spacing": 0.02, "end_time": 0, "gravity": [0, 0, -9.81],
  "fluids": [ { "name": "water", "fill": [ { "vessel": "cup", "level": 0.1 } ] } ],
  "bodies": [ { "name": "cup", "vessel": true, "box": { "min": [0, 0, 0], "max": [0.2, 0.2, 0.2] } } ] }
END
expect 0 "" run cup.json --out cup --quiet
expect 0 "has no values" report cup
check "walls of a vessel are no fins" test "$(grep -c 'A vessel, at least' cup/report.html)" = 1 -a \
    "$(grep -c 'Fins and plates' cup/report.html)" = 0
# The page as it is, and a script that says what is missing; the page's own rule forbids any address.
sed "s/default-src 'none'/default-src 'none'; script-src 'unsafe-inline'/" tank/report.html > looked.html
cat >> looked.html <<'END'
<script>
addEventListener("load", async () => {
  const video = document.querySelector("video"), images = [...document.images];
  for (let n = 0; n < 50 && video.readyState < 2; n++) await new Promise(f => setTimeout(f, 100));
  document.title = `seen: ${images.filter(i => i.naturalWidth > 0).length} of ${images.length} pictures, ` +
                   `${video.videoWidth} wide, ${document.querySelectorAll("table").length} tables`;
});
</script>
END
browse() {
    timeout 60 chromium --headless --no-sandbox --disable-gpu --user-data-dir="$folder/profile" \
        --enable-logging=stderr --virtual-time-budget=8000 --dump-dom "file://$folder/$1" 2> log.txt
}
browse looked.html > dom.txt
echo "$(grep -o '<title>[^<]*' dom.txt)" > err.txt
plots=$(ls tank/plots/*.svg | wc -l)
check "all $((plots + 1)) pictures and the movie are seen" \
    grep -qE "seen: $((plots + 1)) of $((plots + 1)) pictures, 640 wide" dom.txt
grep CONSOLE log.txt > err.txt
check "the console is silent" test ! -s err.txt
expect 0 "" report tank --language ja --out japanese.html
sed "s/default-src 'none'/default-src 'none'; script-src 'unsafe-inline'/" japanese.html > seen.html
sed -n '/^<script>/,$p' looked.html >> seen.html
browse seen.html > dom.txt
check "the Japanese page has the same pictures and movie" \
    grep -qE "seen: $((plots + 1)) of $((plots + 1)) pictures, 640 wide" dom.txt
check "and Japanese text" grep -q "<h2>結果の信頼性</h2>" dom.txt
grep CONSOLE log.txt > err.txt
check "without a word of the browser" test ! -s err.txt
echo '<img src="http://localhost/x.png">' >> looked.html
browse looked.html > dom.txt
check "and would not be if the page asked for an address" grep -q "CONSOLE.*Content Security Policy" log.txt
echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
