#!/bin/bash
# The flying fish at a coarse spacing: installs what is missing, builds, runs, makes a movie, a picture sheet and
# a report, says where to look.
# usage: ./demo.sh [options of "tobiuo run"]     e.g. ./demo.sh --until 0.1
# Every run gets a folder of its own: out/flying_fish, out/flying_fish_2, ...
set -euo pipefail
cd "$(dirname "$0")"
case ${1:-} in -h|--help) sed -n '2,5s/^# //p' "$0"; exit 0 ;; esac

tools/install_packages.sh --plot
tools/build.sh release tobiuo

out=out/flying_fish
n=1
while [ -e "$out" ]; do n=$((n + 1)); out=out/flying_fish_$n; done
mkdir -p out

export OMP_WAIT_POLICY=${OMP_WAIT_POLICY:-passive}
program=build/release/tobiuo
code=0
"$program" run scenes/flying_fish --spacing 0.01 --set output.interval=0.025 \
    --set 'output.fields=["velocity", "pressure"]' --frames --out "$out" "$@" || code=$?
if [ $code -ne 0 ]; then
    echo "demo: the run ended early (exit code $code)." >&2
    [ -d "$out" ] && echo "demo: what is finished is in $out; go on with: $program resume $out" >&2
    exit $code
fi

echo
echo "Results: $out"
echo "In ParaView open (File > Open; then Apply and play, times are simulated seconds):"
echo "    $out/fluid.pvd    the water; Representation: Point Gaussian, colour by velocity or pressure"
for series in "$out"/*.pvd; do
    case $(basename "$series" .pvd) in
    fluid) ;;
    all) echo "    $series      all of it in one list" ;;
    bodies) echo "    $series   the body's own particles" ;;
    *) echo "    $series     the body's moving surface" ;;
    esac
done
echo "Tables:   $out/history.csv (iterations, errors, wall force, energies), $out/bodies.csv (forces)"

frames=$(find "$out" -name '*.png' | sort | head -n 1)
if [ -n "$frames" ]; then
    pictures=$(dirname "$frames")
    echo "Pictures: $pictures/"
    "$program" movie "$out" --out "$out/sheet.png" --force || true
    # two times slower than the fish; without ffmpeg it says what to install
    "$program" movie "$out" --slow 2 --force || true
    "$program" report "$out" --force || true
    echo "Window:   $program view $out"
fi
