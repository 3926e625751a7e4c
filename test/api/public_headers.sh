#!/bin/bash
# Every public header compiles alone, as C17 and as C++17: public_headers.sh CC [CXX]
set -eu
cd "$(dirname "$0")/../.."
cc=$1 cxx=${2:-}
count=0
for header in include/tobiuo/*.h; do
    text="#include \"tobiuo/$(basename "$header")\""
    echo "$text" | "$cc" -std=c17 -pedantic -Wall -Wextra -Werror -Iinclude -fsyntax-only -x c -
    if [ -x "$cxx" ]; then
        echo "$text" | "$cxx" -std=c++17 -pedantic -Wall -Wextra -Werror -Iinclude -fsyntax-only -x c++ -
    fi
    count=$((count + 1))
done
echo "$count public headers compile alone"
[ "$count" -gt 0 ]
