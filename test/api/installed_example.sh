#!/bin/bash
# Installs the library into an empty folder and builds example.c against it through pkg-config: by the commands
# of the README, with the shared and with the static library, and runs all.
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
# shellcheck disable=SC2046,SC2086
"$cc" $flags "$here/example.c" -o "$work/shared" $(pkg-config --cflags --libs tobiuo)   # finds it by its rpath
# shellcheck disable=SC2046,SC2086
"$cc" $flags "$here/example.c" -o "$work/static" $(pkg-config --cflags tobiuo) "$libdir/libtobiuo.a" \
    $(pkg-config --static --libs tobiuo | sed 's/-ltobiuo//')

# An installed program finds the scenes that were installed with it.
"$work/usr/bin/tobiuo" check "$here/../scenes/taichi/fish.json" > "$work/check.txt"
grep "$work/usr/share/tobiuo/scenes/flying_fish/meshes/fish.obj" "$work/check.txt" > /dev/null ||
    { echo "the installed program did not find the installed fish"; exit 1; }

# The README's own commands, with an empty home.
mkdir "$work/home"
for page in README.md README.ja.md; do
    awk '/^## (Use it from C|Cから使う)$/ { on = 1 } on && /^```$/ { if (inside) exit; inside = 1; next } inside' \
        "$here/../../$page" | sed "s|build/release|$build|" > "$work/$page.sh"
    [ "$(wc -l < "$work/$page.sh")" -ge 3 ] || { echo "$page has no commands"; exit 1; }
    (cd "$here/../.." && HOME=$work/home bash -e "$work/$page.sh" > "$work/$page.txt")
    tail -n 1 "$work/$page.txt"
    rm -rf "$work/home/tobiuo"
done

"$work/shared" | tee "$work/shared.txt"
"$work/static" > "$work/static.txt"
cmp "$work/shared.txt" "$work/static.txt" || { echo "shared and static library disagree"; exit 1; }
ldd "$work/shared" | grep 'libtobiuo\.so\.0' > /dev/null || { echo "the example is not linked to the soname"; exit 1; }
