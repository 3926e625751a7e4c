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

failed=0 count=0
for header in $headers; do
    unit=$work/unit.cu
    { echo '#include "exec/portable.h"'; echo "#include \"$header\""; } > "$unit"
    if [ "$mode" = cuda ]; then
        "$compiler" -std=c++17 -arch=sm_80 -x cu -c "$unit" -o "$work/unit.o" \
            -I"$source/include" -I"$source/src" ||
            { echo "$header: does not compile as CUDA"; failed=$((failed + 1)); }
    else
        "$compiler" -std=gnu++17 -Wall -Wextra -Wno-unknown-pragmas -Wno-psabi -Wno-unused-function \
            -fsyntax-only -x c++ "$unit" -I"$source/include" -I"$source/src" ||
            { echo "$header: does not compile as C++"; failed=$((failed + 1)); }
    fi
    count=$((count + 1))
done
echo "$((count - failed)) of $count kernel headers compile ($mode)"
[ "$failed" -eq 0 ]
