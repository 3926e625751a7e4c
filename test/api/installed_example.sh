#!/bin/bash
# Installs the library into an empty folder and builds the programs of this folder against it through pkg-config:
# by the commands of docs/c.md, with the shared and with the static library, and runs all.
# usage: installed_example.sh CMAKE BUILD_DIR CC
set -euo pipefail
cmake=$1 build=$2 cc=$3
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

"$cmake" --install "$build" --prefix "$work/usr" > "$work/install.log"
pc=$(dirname "$(find "$work/usr" -name tobiuo.pc)")
export PKG_CONFIG_PATH=$pc
libdir=$(pkg-config --variable=libdir tobiuo)

flags="-std=c17 -Wall -Wextra -Werror -O1"
for program in example scene_in_memory; do
    # The shared library is found by its rpath.
    # shellcheck disable=SC2046,SC2086
    "$cc" $flags "$here/$program.c" -o "$work/shared_$program" $(pkg-config --cflags --libs tobiuo)
    # shellcheck disable=SC2046,SC2086
    "$cc" $flags "$here/$program.c" -o "$work/static_$program" $(pkg-config --cflags tobiuo) \
        "$libdir/libtobiuo.a" $(pkg-config --static --libs tobiuo | sed 's/-ltobiuo//')
done

# An installed program finds the scenes that were installed with it.
"$work/usr/bin/tobiuo" check "$here/../scenes/taichi/fish.json" > "$work/check.txt"
grep "$work/usr/share/tobiuo/scenes/flying_fish/meshes/fish.obj" "$work/check.txt" > /dev/null ||
    { echo "the installed program did not find the installed fish"; exit 1; }

# The man page is there in both languages.
for page in share/man/man1 share/man/ja/man1; do
    grep -q "^.SS tobiuo run SCENE" "$work/usr/$page/tobiuo.1" || { echo "no $page/tobiuo.1"; exit 1; }
done
grep -q "使い方の誤り" "$work/usr/share/man/ja/man1/tobiuo.1" || sed 's/\\://g' "$work/usr/share/man/ja/man1/tobiuo.1" |
    grep -q "使い方の誤り" || { echo "the Japanese man page is not Japanese"; exit 1; }
# An installed Python module finds the library.
if python3 -c 'import cffi, numpy' 2> "$work/python.txt"; then
    PYTHONPATH=$work/usr/lib/python3/dist-packages python3 -c '
import tobiuo
world = tobiuo.World(tobiuo.shipped("dam_break_2d"), set={"spacing": 0.02})
world.advance(0.05)
assert world.count() > 0 and tobiuo.shipped().startswith("'"$work"'")'
fi

# The page's own commands, with an empty home.
mkdir "$work/home"
page=docs/c.md
awk '/^```$/ { if (inside) exit; inside = 1; next } inside' "$here/../../$page" |
    sed "s|build/release|\"$build\"|" > "$work/page.sh"
[ "$(wc -l < "$work/page.sh")" -ge 3 ] || { echo "$page has no commands"; exit 1; }
(cd "$here/../.." && HOME=$work/home bash -e "$work/page.sh" > "$work/page.txt")
tail -n 1 "$work/page.txt"

for program in example scene_in_memory; do
    "$work/shared_$program" | tee "$work/shared.txt"
    "$work/static_$program" > "$work/static.txt"
    cmp "$work/shared.txt" "$work/static.txt" ||
        { echo "$program: shared and static library disagree"; exit 1; }
done
ldd "$work/shared_example" | grep 'libtobiuo\.so\.0' > /dev/null ||
    { echo "the example is not linked to the soname"; exit 1; }
