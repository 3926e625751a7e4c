# The start of a test of the program, to be sourced: works in a fresh folder that it removes, counts checks.
# usage: . checks.sh PROGRAM
program=$(realpath "$1")
python=/usr/bin/python3
[ -x $python ] || python=python3
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
export OMP_WAIT_POLICY=passive
export LC_ALL=C.UTF-8       # pages and plots in English; report_japanese.py is of the other language
passed=0 failed=0

ok() { passed=$((passed + 1)); }
bad() { failed=$((failed + 1)); echo "FAILED: $1"; [ -s err.txt ] && sed 's/^/    /' err.txt | head -n 8; }
check() { local what=$1; shift; if "$@" > /dev/null 2>&1; then ok; else bad "$what"; fi; }
# expect CODE TEXT ARGUMENTS...: exit code, and a text in stderr ("" = stderr must be empty)
expect() {
    local code=$1 text=$2 got=0
    shift 2
    "$program" "$@" > out.txt 2> err.txt || got=$?
    if [ $got -ne "$code" ]; then bad "tobiuo $*: exit code $got, not $code"
    elif [ -n "$text" ] && ! grep -qF -- "$text" err.txt; then bad "tobiuo $*: no '$text' on stderr"
    elif [ -z "$text" ] && [ -s err.txt ]; then bad "tobiuo $*: unexpected text on stderr"
    else ok; fi
}
