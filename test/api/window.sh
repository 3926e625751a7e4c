#!/bin/bash
# tobiuo view and run --window on a display without a screen: every key changes what it should, and nothing else
# does; a run has the same bits with a window; no display or no OpenGL is one sentence.
# usage: window.sh PROGRAM      works in a fresh folder that it removes; last line: "N passed, N failed"
# Answers 77 (skipped) without GLFW in the build, Xvfb or xdotool, after the tests that do without them.
set -uo pipefail
. "$(dirname "$0")/checks.sh" "$1"
unset DISPLAY WAYLAND_DISPLAY

cat > drop.json <<'END'
{ "domain": { "min": [0, 0, 0], "max": [1, 1, 1] }, "spacing": 0.1, "end_time": 0.1,
  "fluids": [ { "name": "water", "fill": [ { "box": { "min": [0, 0, 0], "max": [0.5, 1, 0.5] } } ] } ],
  "bodies": [ { "name": "ball", "box": { "min": [-0.1, -0.1, -0.1], "max": [0.1, 0.1, 0.1] }, "translation": [0.7, 0.5, 0.2], "dynamics": "free",
                "density": 500 } ],
  "output": { "interval": 0.01 } }
END

# --- without a display ------------------------------------------------------------------------------
expect 2 "which DIR?" view
expect 2 "is not like 1280x720" view plain --size 12x
expect 1 "there is no run to look at" view nowhere
expect 0 "" run drop.json --out plain --quiet
expect 1 "there is no window: " view plain
expect 0 "there is no window: " run drop.json --out blind --quiet --window
check "one sentence" test "$(wc -l < err.txt)" = 1
check "and the run goes on, to the same bits" cmp plain/history.csv blind/history.csv
mkdir torn && cp -r plain/* torn && rm torn/all.pvd
expect 1 "all.pvd" view torn

for tool in Xvfb xdotool; do
    command -v $tool > /dev/null && continue
    echo "$passed passed, $failed failed; the rest was skipped: $tool is missing"
    [ $failed -eq 0 ] && exit 77
    exit 1
done
if grep -q "this build has none" <("$program" view plain 2>&1); then
    echo "$passed passed, $failed failed; the rest was skipped: the build has no GLFW"
    [ $failed -eq 0 ] && exit 77
    exit 1
fi

# --- a display in memory ----------------------------------------------------------------------------
# start OPTIONS...: DISPLAY and server
start() {
    rm -f number && mkfifo number
    Xvfb -displayfd 9 -screen 0 1300x800x24 -nolisten tcp "$@" 9> number 2> /dev/null &
    server=$!
    read -r DISPLAY < number
    export DISPLAY=:$DISPLAY
}
stop() { kill "$server" 2> /dev/null; wait "$server" 2> /dev/null; }
trap 'stop; rm -rf "$folder"' EXIT
start -extension GLX
expect 1 "there is no window: " view plain
check "no OpenGL: one sentence" test "$(wc -l < err.txt)" = 1
expect 0 "there is no window: " run drop.json --out nogl --quiet --window
stop
start

# look NAME KEYS: types the keys into a window on `plain`; its screenshots become NAME_1.png, ...
look() {
    rm -f plain/window_*
    timeout 60 "$program" view plain --size 800x450 --keys "$2" > out.txt 2> err.txt
    check "window closes after $2" test $? = 0
    local k=1
    while [ -e plain/window_$k.png ]; do mv plain/window_$k.png "$1_$k.png"; k=$((k + 1)); done
}
# Regions as shares: left top right bottom. The note and the time line are apart.
cat > compare.py <<'END'
import sys
import numpy as np
from matplotlib.image import imread
places = {"picture": (0.43, 0.1, 0.85, 0.9), "head": (0, 0, 0.35, 0.13), "colours": (0.88, 0.25, 1, 0.75),
          "line": (0, 0.945, 1, 1), "curves": (0, 0.45, 0.42, 0.89), "help": (0.45, 0.25, 0.65, 0.75),
          "picks": (0.7, 0.05, 1, 0.3)}
def changed(a, b, name):
    high, wide = a.shape[:2]
    x0, y0, x1, y1 = places[name]
    part = np.s_[int(y0*high):int(y1*high), int(x0*wide):int(x1*wide)]
    return np.abs(a[part] - b[part]).max() > 0.05
for line in open("differ.txt"):
    what, first, second, key = line.rstrip("\n").split("\t")
    try:
        a, b = imread(first)[..., :3], imread(second)[..., :3]
        wrong = [n for n in what.split(",") if changed(a, b, n.strip("-")) == n.startswith("-")]
    except (OSError, ValueError) as error:
        wrong = [str(error)]
    print("bad" if wrong else "good", f"{key}: {first} {second}: not as said: {', '.join(wrong)}", sep="\t")
END
# differ WHAT A B: what differs between two pictures, and "-place" what must not; judged at the end, all at once
differ() { printf '%s\t%s\t%s\t%s\n' "$@" >> differ.txt; }
all=-picture,-head,-colours,-line,-curves,-help,-picks

# Foam that "tobiuo foam" has made is seen.
sed 's|"bodies".*|"gravity": [0, 0, -9.81],|; /"density": 500/d; s|"max": \[0.5, 1, 0.5\] }|"max": [1, 1, 0.3] }|
     s|} } \] } \]|} }, { "box": { "min": [0.3, 0.3, 0.4], "max": [0.7, 0.7, 0.8] }, "velocity": [0, 0, -8] } ] } ]|' \
    drop.json > splash.json
"$program" run splash.json --out splash --quiet > out.txt 2> err.txt
expect 0 "" foam splash --amount 100
for k in 1 2; do
    timeout 60 "$program" view splash --size 800x450 --keys ">sq" > out.txt 2> err.txt
    mv splash/window_1.png foam_$k.png
    rm -rf splash/foam
done
differ picture foam_1.png foam_2.png "foam"

# What the fonts of the system cannot draw goes to the terminal.
latin=$(fc-match -f '%{file}' sans-serif:lang=en)
cat > latin.conf <<END
<fontconfig><dir>$(dirname "$latin")</dir>
<selectfont><acceptfont><glob>$latin</glob></acceptfont><rejectfont><glob>*</glob></rejectfont></selectfont></fontconfig>
END
cp -r plain 結果
timeout 60 env FONTCONFIG_FILE="$PWD/latin.conf" "$program" view 結果 --size 800x450 --keys "sq" > out.txt 2> err.txt
check "a path in Japanese" grep -q "結果/window_1.png" err.txt

# The help is Japanese where the system has letters for it, else English. Without fonts there are no texts.
shot() { timeout 60 env "${@:2}" "$program" view plain --size 800x450 --keys "hsq" > out.txt 2> err.txt
         check "$1: ends well" test $? -eq 0
         mv plain/window_1.png "$1.png"; }
echo '<fontconfig></fontconfig>' > no_fonts.conf
shot help_english LC_ALL=C.UTF-8 FONTCONFIG_FILE="$PWD/latin.conf"
shot help_latin LC_ALL=ja_JP.UTF-8 FONTCONFIG_FILE="$PWD/latin.conf"
shot help_no_font LC_ALL=C.UTF-8 FONTCONFIG_FILE="$PWD/no_fonts.conf"
shot help_japanese LC_ALL=ja_JP.UTF-8
differ $all help_english.png help_latin.png "help without a Japanese font"
differ help help_english.png help_no_font.png "help without any font"
if [ -n "$(fc-list :lang=ja 2> /dev/null)" ]; then
    differ help help_english.png help_japanese.png "help in Japanese"
fi
env FONTCONFIG_FILE="$PWD/no_fonts.conf" "$program" info > out.txt
check "info without fonts" grep -q "^letters       none: the system has no font" out.txt

# So it is in the window of a run, of outputs that have it; by real keys, when it is made.
"$program" run splash.json --out live --quiet --window > out.txt 2> err.txt &
runner=$!
for _ in $(seq 600); do grep -q '"complete"' live/summary.json 2> /dev/null && break; sleep 0.1; done
expect 0 "" foam live --amount 100
xdotool search --name live windowfocus > /dev/null
for k in 1 2; do
    xdotool key greater key b key s
    for _ in $(seq 600); do [ -s live/window_$k.png ] && sleep 0.2 && break; sleep 0.1; done
    rm -rf live/foam
done
xdotool key q key Return
wait $runner
mv live/window_1.png live_1.png
mv live/window_2.png live_2.png
differ picture live_1.png live_2.png "foam in the window of a run"

# Nests are seen in their boxes, in the window of a run too, or the scene alone.
cat > nested.json <<'END'
{ "method": "isph", "dimension": 2, "domain": { "min": [0, 0], "max": [1, 1] }, "spacing": 0.05, "end_time": 0.02,
  "fluids": [ { "name": "water", "fill": [ { "box": { "min": [0, 0], "max": [0.7, 0.6] } } ] } ],
  "nests": [ { "name": "end", "box": { "min": [0.5, 0], "max": [1, 1] }, "refinement": 4 } ],
  "output": { "interval": 0.01, "picture": { "look": "particles" } } }
END
"$program" run nested.json --out nested --quiet > out.txt 2> err.txt
timeout 60 "$program" view nested --size 800x450 --keys "fsosq" > out.txt 2> err.txt
mv nested/window_1.png nested_1.png
mv nested/window_2.png nested_2.png
differ picture nested_1.png nested_2.png "o"

look keys "shshsfsFs+s-sns>s<sb0sq"
differ help,-line keys_1.png keys_2.png "h"
differ $all keys_1.png keys_3.png "h again"
differ picture,colours,-head,-line keys_3.png keys_4.png "f"
differ $all keys_3.png keys_5.png "F"
differ picture,-colours keys_5.png keys_6.png "+"
differ $all keys_5.png keys_7.png "-"
differ head,line,curves keys_7.png keys_8.png "n"
differ picture,head,line,curves keys_8.png keys_9.png ">"
differ $all keys_10.png keys_1.png "<"
differ $all keys_11.png keys_1.png "b at the first, 0"

look clip "scs[[[[sCs]]]]sCccc0sgsgsgsgsq"
differ picture,head,-line,-curves clip_1.png clip_2.png "c"
differ picture,head clip_2.png clip_3.png "["
differ picture,head clip_3.png clip_4.png "C"
differ picture,head clip_4.png clip_5.png "]"
differ $all clip_6.png clip_1.png "c through all axes"
differ curves,-picture,-head,-line clip_6.png clip_7.png "g"
differ curves,-picture,-head clip_7.png clip_8.png "g without curves"
differ -picture,-head,-line clip_9.png clip_6.png "g from the start"

look range "f>s<srsq"
differ picture,-colours range_1.png range_2.png "a range that was seen stays"
differ colours range_2.png range_3.png "r"

if command -v ffprobe > /dev/null; then
    rm -f plain/window_*
    expect 0 "" view plain --keys "mnnfmq"
    check "a movie of four pictures" test "$(ffprobe -v error -count_frames -select_streams v -show_entries \
        stream=nb_read_frames -of csv=p=0 plain/window_1.mp4)" = 4
    check "and no pictures left" test ! -e plain/window_1_pictures
fi

# --- real keys and a real mouse ---------------------------------------------------------------------
rm -f plain/window_*
timeout 100 "$program" view plain --size 800x450 --keys s > out.txt 2> err.txt &
viewer=$!
# shot N: waits for the screenshot
shot() { for _ in $(seq 600); do [ -s plain/window_$1.png ] && sleep 0.2 && return; sleep 0.1; done; }
shot 1
xdotool search --name plain windowfocus > /dev/null
xdotool key Right key Up key s; shot 2
xdotool key Home key s; shot 3
xdotool mousemove 400 150 mousedown 1 mousemove 440 160 mousemove 480 180 mouseup 1 key s; shot 4
xdotool key 0 mousemove 400 150 mousedown 3 mousemove 420 160 mousemove 440 170 mouseup 3 key s; shot 5
xdotool key 0 click 4 key s; shot 6
xdotool key 0 mousemove 360 250 click 1 mousemove 390 265 click 1 key s; shot 7
xdotool key x mousemove 600 434 click 1 key s; shot 8
xdotool key space sleep 0.1 key space key s; shot 9      # fewer outputs than there are
xdotool key Home key less key s; shot 10
xdotool keydown shift mousemove 400 150 mousedown 1 mousemove 420 160 mousemove 440 170 mouseup 1 keyup shift key s; shot 11
xdotool key Home key End key s; shot 12
xdotool mousemove 780 434 mousedown 1 mousemove 500 434 mousemove 20 434 mouseup 1 key s; shot 13
xdotool key f mousemove 360 250 click 1 key s; shot 14
xdotool key Escape
wait $viewer
check "Escape closes" test $? = 0
mv plain/window_*.png .
differ picture window_1.png window_2.png "arrows"
differ $all window_1.png window_3.png "Home"
differ picture window_3.png window_4.png "drag"
differ picture window_3.png window_5.png "right drag"
differ picture window_3.png window_6.png "wheel"
differ picks,-head,-line window_3.png window_7.png "two particles"
differ head,line,-picks window_3.png window_8.png "the time line; x"
differ head,line window_8.png window_9.png "play"
differ picture,-head window_10.png window_11.png "shift and drag"
differ picture,head,line window_10.png window_12.png "End"
differ $all window_10.png window_13.png "a drag along the time line"
differ picture,picks,-head,-line window_13.png window_14.png "a field and a particle"

# --- a run ------------------------------------------------------------------------------------------
expect 0 "" run drop.json --out seen --quiet --window --keys " nnfc q"
check "the same history" cmp plain/history.csv seen/history.csv
check "the same forces" cmp plain/bodies.csv seen/bodies.csv
hash() { grep state_hash $1/summary.json; }
check "the same bits" test "$(hash plain)" = "$(hash seen)"
got=0; "$program" run drop.json --out left --quiet --window --set end_time=1000 --keys " nsnsqs" 2> err.txt || got=$?
check "a run that its window stops: exit code 130 (was $got)" test $got = 130
for k in 1 2; do mv left/window_$k.png left_$k.png; done
differ head left_1.png left_2.png "a step of a run"
check "a run that was stopped can go on" grep -q '"interrupted"' left/summary.json
"$program" run drop.json --out paused --quiet --window --set end_time=1000 --keys " s" 2> err.txt &
runner=$!
for _ in $(seq 300); do [ -s paused/window_1.png ] && break; sleep 0.1; done
kill -TERM $runner
for _ in $(seq 100); do kill -0 $runner 2> /dev/null || break; sleep 0.1; done
check "a signal ends a paused run and its window" bash -c "! kill -0 $runner 2> /dev/null"
kill -KILL $runner 2> /dev/null
wait $runner 2> /dev/null
check "with a checkpoint" grep -q '"interrupted"' paused/summary.json
expect 0 "" run drop.json --out on --quiet --window --until 0.15 --keys " nqg"
check "a run goes on without its window" grep -q '"complete"' on/summary.json
$python compare.py > verdicts.txt
while IFS=$'\t' read -r verdict text; do
    : > err.txt
    if [ "$verdict" = good ]; then ok; else bad "$text"; fi
done < verdicts.txt
check "all pictures were judged" test "$(wc -l < verdicts.txt)" = "$(wc -l < differ.txt)"
echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
