#!/bin/bash
# Every kernel header (src/**/*.k.h) compiles as C++ or as CUDA: kernel_headers.sh cxx|cuda COMPILER
# This keeps the one-source promise true on machines without a GPU; nothing is linked or run.
set -u
source=$(cd "$(dirname "$0")/../.." && pwd)
mode=$1 compiler=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
headers=$(cd "$source/src" && find . -name '*.k.h' | sed 's,^\./,,' | sort)
[ -n "$headers" ] || { echo "no kernel headers yet"; exit 77; }

if [ "$mode" = cuda ]; then
    # All in one: nvcc takes a second to start. That each stands alone, C++ shows.
    { echo '#include "exec/portable.h"'; printf '#include "%s"\n' $headers; } > "$work/unit.cu"
    "$compiler" -std=c++17 -arch=sm_80 -x cu -c "$work/unit.cu" -o "$work/unit.o" -I"$source/include" -I"$source/src" ||
        { echo "a kernel header does not compile as CUDA"; exit 1; }
    echo "$(wc -w <<< "$headers") kernel headers compile (cuda)"
    exit 0
fi
failed=0 count=0
for header in $headers; do
    unit=$work/unit.cc
    { echo '#include "exec/portable.h"'; echo "#include \"$header\""; } > "$unit"
    "$compiler" -std=gnu++17 -Wall -Wextra -Wno-unknown-pragmas -Wno-psabi -Wno-unused-function \
        -fsyntax-only -x c++ "$unit" -I"$source/include" -I"$source/src" ||
        { echo "$header: does not compile as C++"; failed=$((failed + 1)); }
    count=$((count + 1))
done
echo "$((count - failed)) of $count kernel headers compile (cxx)"
[ "$failed" -eq 0 ]
