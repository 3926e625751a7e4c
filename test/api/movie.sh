#!/bin/bash
# tobiuo movie and run --movie: frames and seconds as ffprobe counts them, all kinds of files, messages.
# usage: movie.sh PROGRAM      works in a fresh folder that it removes; last line: "N passed, N failed"
# Answers 77 (skipped) without ffmpeg, after the tests that do without it.
set -uo pipefail
. "$(dirname "$0")/checks.sh" "$1"

cat > drop.json <<'END'
{ "dimension": 2, "domain": { "min": [0, 0], "max": [1, 1] }, "spacing": 0.05, "end_time": 0.2,
  "fluids": [ { "name": "water", "fill": [ { "box": { "min": [0, 0], "max": [1, 0.5] } } ] } ],
  "output": { "interval": 0.02 } }
END

# --- without ffmpeg ---------------------------------------------------------------------------------
expect 2 "which DIR?" movie
expect 2 "is not a positive number" movie nowhere --slow 0
expect 2 "its name ends in .mp4, .webm, .webp or .gif" movie nowhere --out film.avi
expect 2 "its name ends in .mp4, .webm, .webp or .gif" run drop.json --movie film
expect 1 "there is no run" movie nowhere
expect 1 "drop.json: there is no run (no history.csv)" movie drop.json
expect 0 "" run drop.json --out plain --quiet
expect 0 "draws 11 pictures into plain/frames" movie plain --out plain.png
expect 1 "the scene of plain has no view 'q'" movie plain --view q --out q.png
expect 1 'there is no field "colour"' movie plain --set output.picture.field=colour --out q.png
expect 0 "draws 11 pictures" movie plain --set output.picture.field=pressure --out pressure.png
check "values for one movie change it" test "$(cmp -s plain.png pressure.png; echo $?)" = 1
check "and leave nothing" test -z "$(ls -d plain/movie.* 2> /dev/null)"
expect 0 "" run drop.json --out "100%d run" --quiet --frames
got=0; PATH=/nonexistent "$program" movie "100%d run" > out.txt 2> err.txt || got=$?
check "ffmpeg missing: exit code 1 (was $got)" test $got = 1
check "ffmpeg missing: the package is named" grep -q "apt-get install ffmpeg" err.txt
got=0; PATH=/nonexistent "$program" run drop.json --out never --movie a.mp4 > out.txt 2> err.txt || got=$?
check "a run goes on without its movie (exit code $got)" test $got = 1 -a -s never/frames/frame_000001.png
check "and says so" grep -q "the run goes on and keeps its pictures; later: tobiuo movie never" err.txt
check "pictures drawn afterwards are those of the run" diff -r plain/frames "100%d run/frames"
rm "100%d run/frames/frame_000007.png"
mv "100%d run/fluid/fluid_000009.vtu" kept.vtu
expect 0 "draws 1 picture into" movie "100%d run" --out whole.png
mv kept.vtu "100%d run/fluid/fluid_000009.vtu"
check "the one that is missing is drawn" cmp -s "100%d run/frames/frame_000007.png" plain/frames/frame_000007.png
rm -rf plain/fluid* plain/frames/frame_000010.png
expect 0 "No such file" movie plain --out kept.png
rm -rf plain/frames
expect 1 "No such file" movie plain --out none.png
mv plain/history.csv kept.csv && : > plain/history.csv
expect 1 "history.csv is empty" movie plain --out none.mp4
check "which is said once" test "$(grep -c . err.txt)" = 1
mv kept.csv plain/history.csv
check "without results and pictures there is no sheet" test ! -e none.png
expect 0 "" run drop.json --out short --quiet --frames --until 0.001 --set output.interval=1
check "the end of a run shorter than the interval has a picture" test -s short/frames/frame_000001.png
rm -r short
expect 0 "" run drop.json --out short --quiet --frames --set end_time=0
rm -rf short/fluid* short/frames/frame_000001.png
expect 1 "diverged" run drop.json --out lost --quiet --frames --set speed_limit=0.5 --set output.interval=1 \
       --set 'fluids[0].fill[0].box.max=[0.5, 0.5]'
check "the moment at which a run diverges has a picture" test -s lost/frames/frame_000001.png
check "and a row" test "$(wc -l < lost/history.csv)" = 3
touch there.mp4
expect 1 "there.mp4 exists; --force replaces it" movie "100%d run" --out there.mp4
expect 1 "there.mp4 exists; --force replaces it" run drop.json --out again --quiet --movie there.mp4
check "a movie that exists stops the run before it begins" test ! -e again

if ! command -v ffmpeg > /dev/null || ! command -v ffprobe > /dev/null; then
    echo "$passed passed, $failed failed; the rest was skipped: ffmpeg is missing"
    [ $failed -eq 0 ] && exit 77
    exit 1
fi

# --- with ffmpeg ------------------------------------------------------------------------------------
# is FILE FRAMES SECONDS
is() {
    $python - "$@" <<'END'
import subprocess, sys
file, frames, seconds = sys.argv[1], int(sys.argv[2]), float(sys.argv[3])
seen = subprocess.run(["ffprobe", "-v", "error", "-select_streams", "v", "-count_frames", "-show_entries",
                       "stream=nb_read_frames:format=duration", "-of", "csv=p=0", file],
                      check=True, capture_output=True, text=True).stdout.split()
print(seen, file=sys.stderr)
sys.exit(int(seen[0].strip(",")) != frames or abs(float(seen[1]) - seconds) > 0.021)
END
}
expect 1 "has one output only" movie short
expect 0 "" movie "100%d run"
cp -r "100%d run" hurt && rm hurt/movie.mp4 hurt/fluid/fluid_000010.vtu hurt/frames/frame_000010.png
expect 3 "hurt/movie.mp4 ends before output 10 of 10, whose picture is missing" movie hurt
# A gap: the picture before stands there, so that the movie keeps its time.
cp -r "100%d run" gaps && rm gaps/movie.mp4 gaps/fluid/fluid_00000[045].vtu gaps/fluid/fluid_000008.vtu
rm gaps/frames/frame_00000[045].png gaps/frames/frame_000008.png
expect 3 "gaps/movie.mp4 begins with output 1; the pictures before it are missing" movie gaps
said="the pictures of these outputs are missing: 4 to 5, 8; gaps/movie.mp4 shows the picture before in their place"
check "a gap is told" grep -qF "$said" err.txt
check "what is not there is told once" grep -q "so 4 pictures cannot be drawn" err.txt
check "a movie of gaps keeps its time" is gaps/movie.mp4 10 0.2
check "and leaves no links" test -z "$(ls -d gaps/movie.mp4.* 2> /dev/null)"
# alike MOVIE NUMBER PICTURE: its frame of that number shows the picture, up to what H.264 loses
alike() {
    ffmpeg -loglevel error -i "$1" -vf "select=eq(n\,$2),scale=64:36" -frames:v 1 -f rawvideo -pix_fmt gray a.raw -y
    ffmpeg -loglevel error -i "$3" -vf scale=64:36 -frames:v 1 -f rawvideo -pix_fmt gray b.raw -y
    $python -c 'import sys; a, b = (open(f, "rb").read() for f in ("a.raw", "b.raw"))
sys.exit(not len(a) == len(b) > 0 or max(abs(x - y) for x, y in zip(a, b)) > 12)'
}
check "the picture before the gap is shown in it" alike gaps/movie.mp4 4 gaps/frames/frame_000003.png
check "the one behind it is not" test "$(alike gaps/movie.mp4 4 gaps/frames/frame_000006.png; echo $?)" = 1
check "and follows" alike gaps/movie.mp4 5 gaps/frames/frame_000006.png
expect 3 "these outputs are missing: 4 to 5, 8; other.mp4 shows" movie gaps --out other.mp4 --set output.picture.field=pressure
check "drawn anew with gaps, too" is other.mp4 10 0.2
check "and leaves nothing" test -z "$(ls -d gaps/movie.?????? 2> /dev/null)"
expect 0 "so 4 pictures cannot be drawn" movie gaps --out gaps.png
check "a sheet of what there is" test -s gaps.png
truncate -s 1000 hurt/frames/frame_000003.png
expect 1 "frame_000003.png is damaged; delete it, and the movie draws it anew" movie hurt --force
cp hurt/frames/frame_000004.png hurt/frames/frame_000003.png
printf '%0100d' 0 | dd of=hurt/frames/frame_000003.png bs=1 seek=1000 conv=notrunc status=none
expect 1 "frame_000003.png is damaged; delete it, and the movie draws it anew" movie hurt --force
head -n 1 hurt/history.csv > one.csv && mv one.csv hurt/history.csv
expect 1 "hurt/history.csv does not tell the times of two outputs, which a movie needs" movie hurt --force
check "11 pictures of 0.02 s make 0.22 s" is "100%d run/movie.mp4" 11 0.22
expect 1 "exists; --force replaces it" movie "100%d run"
expect 0 "" movie "100%d run" --force --slow 10
check "ten times slower" is "100%d run/movie.mp4" 11 2.2
expect 1 "--slow 1e+30 makes 5e-29 pictures per second of outputs 0.02 s apart; allowed are 0.001 to 1e+06" \
    movie "100%d run" --slow 1e30 --force
expect 0 "" movie "100%d run" --slow 0.2 --out fast.mp4
check "at most 60 pictures a second" is fast.mp4 4 0.067
for kind in webm gif; do
    expect 0 "" movie "100%d run" --out "film.$kind"
    check "film.$kind" is "film.$kind" 11 0.22
done
expect 0 "" movie "100%d run" --out film.webp
check "film.webp has 11 pictures" test "$(grep -aoc WEBP film.webp) $(grep -ao ANMF film.webp | wc -l)" = "1 11"
# Transparent pictures, where a file knows no transparency, stand on white.
corner() { ffmpeg -loglevel error -i "$1" -frames:v 1 -vf crop=2:2:2:h-4 -f rawvideo -pix_fmt gray - | od -An -tu1; }
is_white() { for byte in $(corner "$1"); do [ "$byte" -gt 240 ] || return 1; done; }
expect 0 "" run drop.json --out clear --quiet --frames --set output.picture.transparent=true
for file in clear.png clear.mp4; do
    expect 0 "" movie clear --out $file
    check "$file is on white" is_white $file
done
expect 0 "" run drop.json --out again --quiet --movie again.mp4
check "run --movie" is again.mp4 11 0.22
expect 2 "--slow needs --movie" run drop.json --out no --slow 2
expect 0 "" run drop.json --out slowly --quiet --movie slowly.mp4 --slow 5
check "run --movie --slow" is slowly.mp4 11 1.1
views='output.views=[{"name": "p", "picture": {"field": "pressure"}}]'
expect 0 "" run drop.json --out views --quiet --movie views.mp4 --set "$views"
check "run --movie makes one of each view" is views_p.mp4 11 0.22
expect 0 "" movie views --view p
check "movie --view" cmp -s views/movie_p.mp4 views_p.mp4
check "a view differs from the output's own pictures" test "$(cmp -s views_p.mp4 views.mp4; echo $?)" = 1
expect 1 "the scene of views has no view 'q'" movie views --view q
rm views.mp4
expect 1 "views_p.mp4 exists; --force replaces it" run drop.json --out no --movie views.mp4 --set "$views"
expect 1 "ffmpeg failed" movie again --out /proc/film.mp4
check "nothing is left of a movie that failed" test ! -e /proc/film.mp4.part
# A disk that is full at the end of a movie, played by a limit on the size of files.
cp again.mp4 kept.mp4
limit=$((($(stat -c %s again.mp4) - 1)/1024)) got=0
(trap '' XFSZ; ulimit -f $limit; exec "$program" movie again --out again.mp4 --force) > out.txt 2> err.txt || got=$?
check "a movie without room: exit code 1 (was $got)" test $got = 1
check "a movie without room: said so" grep -q "ffmpeg failed on .*File too large" err.txt
check "a movie without room: the one before stays" cmp again.mp4 kept.mp4
check "a movie without room: nothing is left" test ! -e again.mp4.part
echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
