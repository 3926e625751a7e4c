#!/bin/bash
# Configures and builds one preset, quietly: tools/build.sh PRESET [TARGET...]
# The log is build/PRESET.log. With nothing to do it takes a second.
set -uo pipefail
cd "$(dirname "$0")/.."
case ${1:-} in
release|dev|asan|fuzz) preset=$1; shift ;;
*) echo "usage: tools/build.sh release|dev|asan|fuzz [TARGET...]" >&2; exit 2 ;;
esac
mkdir -p build
log=build/$preset.log

# Ninja if it is there; a folder configured before keeps its generator.
generator=()
if [ ! -f "build/$preset/CMakeCache.txt" ] && command -v ninja > /dev/null; then generator=(-G Ninja); fi

fail() { tail -n 40 "$log" >&2; echo "build: $1 failed, whole log in $log" >&2; exit 1; }

cmake --preset "$preset" "${generator[@]}" > "$log" 2>&1 || fail "configuring"
cmake --build --preset "$preset" --parallel "$(nproc)" ${1:+--target "$@"} >> "$log" 2>&1 || fail "building"
grep -n 'warning:' "$log" || true
