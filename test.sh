#!/bin/bash
# Installs what is missing, builds the release preset with its tests, runs them.
# usage: ./test.sh                 all but the long physics cases, about twelve minutes with the build on two cores
#        ./test.sh --all           these too, twice the time
#        ./test.sh NAME            only the tests whose name matches (a regular expression), long ones too
#        ./test.sh --slow [CASE] [--stale] [--reference DIR]
#                                  physics cases at reference size; rows and plots go to docs/validation.
#                                  --stale: those whose page is older than its method or case; says how long that
#                                  takes. Stopped with Ctrl-C and started again, a case goes on where it was.
#                                  DIR: published data (default: $TOBIUO_REFERENCE), curves of plots; without it the
#                                  few values that stand in the cases' run.py
# The exit code is 0 only if everything passed. Closing lines: those of ctest, then "N passed, N failed".
set -uo pipefail
from=$PWD      # where a relative folder starts
cd "$(dirname "$0")"
begin=$SECONDS
limit=${TOBIUO_TEST_LIMIT:-1100}     # s, for the whole of an ordinary run: a slow machine is no failure
reference=${TOBIUO_REFERENCE:-}
python=/usr/bin/python3
[ -x $python ] || python=python3

close() { echo "$1 passed, $2 failed"; [ "$2" -eq 0 ]; exit; }

prepare() {
    tools/install_packages.sh --test && tools/build.sh release && return
    close 0 1
}

run_slow() {
    local passed=0 failed=0 case script
    trap 'echo "test: stopped; the same command goes on"; exit 130' INT
    for case in "$@"; do
        script=$PWD/test/physics/$case/run.py
        echo "== $case"
        mkdir -p "build/slow/$case"
        if (cd "build/slow/$case" && "$python" "$script" --tobiuo "$OLDPWD/build/release/tobiuo" \
            --size reference --out "$PWD/runs" --resume ${reference:+--reference "$reference"}); then
            passed=$((passed + 1))
        else
            failed=$((failed + 1))
            echo "== $case failed"
        fi
    done
    close $passed $failed
}

list_cases() {      # [CASE]: names, or an error
    local script
    for script in test/physics/*/run.py; do
        script=$(basename "$(dirname "$script")")
        [ -n "${1:-}" ] && [ "$1" != "$script" ] || echo "$script"
    done
}

run_fast() {        # options of ctest that choose tests
    local log=build/test.log left=$((limit - (SECONDS - begin)))
    timeout $((left > 1 ? left : 1)) ctest --test-dir build/release -j "$(nproc)" --timeout 240 --output-on-failure \
        --no-tests=error "$@" 2>&1 < /dev/null | tee $log
    local code=${PIPESTATUS[0]}
    [ "$code" -eq 124 ] && echo "test: stopped after $limit s; tests that did not end count as failed"
    # A test that did not report Passed or Skipped has failed.
    local passed failed skipped
    read -r passed failed skipped <<< "$(awk '
        match($0, /^ *[0-9]+\/[0-9]+ Test +#/) {
            split($1, part, "/"); total = part[2] ? part[2] : total
            if (/\*\*\*Skipped/) skipped++; else if (/ Passed +[0-9.]+ sec/) passed++ }
        END { print passed + 0, total - passed - skipped + 0, skipped + 0 }' $log)"
    [ "$skipped" -gt 0 ] && echo "$skipped skipped"
    [ "$code" -ne 0 ] && [ "$failed" -eq 0 ] && failed=1
    echo "$((SECONDS - begin)) s"
    close "$passed" "$failed"
}

case ${1:-} in
-h|--help) sed -n '2,12s/^# //p' "$0"; exit 0 ;;
--all) limit=${TOBIUO_TEST_LIMIT:-3600}; prepare; run_fast ;;
--slow)
    shift
    wanted= stale=0
    while [ $# -gt 0 ]; do
        case $1 in
        --reference) reference=${2:-}; shift ;;
        --reference=*) reference=${1#*=} ;;
        --stale) stale=1 ;;
        -*) echo "test: unknown option $1 (see ./test.sh --help)" >&2; exit 2 ;;
        *) wanted=$1 ;;
        esac
        shift
    done
    if [ -n "$reference" ]; then
        reference=$(cd "$from" && cd "$reference" && pwd) || exit 2
    fi
    cases=$(list_cases "$wanted")
    if [ -z "$cases" ]; then
        echo "test: no physics case '$wanted'; there are:" >&2
        list_cases | sed 's/^/  /' >&2
        exit 2
    fi
    if [ $stale -eq 1 ]; then
        cases=$("$python" test/physics/validation.py list | grep -xF "$cases")
    fi
    prepare
    run_slow $cases
    ;;
-*) echo "test: unknown option $1 (see ./test.sh --help)" >&2; exit 2 ;;
'') prepare; run_fast -LE '^long$' ;;
*) limit=${TOBIUO_TEST_LIMIT:-3600}; prepare; run_fast -R "$1" ;;
esac
