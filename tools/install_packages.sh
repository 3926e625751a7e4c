#!/bin/bash
# Installs the Debian 12 packages that Tobiuo needs and that are missing; nothing else.
# usage: tools/install_packages.sh [--plot] [--test] [--list]
#   --plot   also what `tobiuo plot`, `movie` and `report` draw with
#   --test   also what the tests need
#   --list   only print the missing packages
# Needs root or sudo only if something is missing.
set -euo pipefail

packages=(gcc libc6-dev cmake ninja-build pkg-config
          libjansson-dev libassimp-dev libluajit-5.1-dev libhdf5-dev zlib1g-dev liblz4-dev libmd-dev libpng-dev
          libjpeg-dev libglfw3-dev libfreetype-dev libfontconfig-dev)
plot_packages=(gnuplot-nox ffmpeg)
test_packages=(gnuplot-nox ffmpeg chromium man-db fontconfig fonts-vlgothic xvfb xdotool libgl1-mesa-dri g++ git libcmocka-dev
               python3 python3-numpy python3-matplotlib
               python3-vtk9 python3-jsonschema python3-polib python3-cffi)

list_only=0
for argument in "$@"; do
    case $argument in
    --plot) packages+=("${plot_packages[@]}") ;;
    --test) packages+=("${test_packages[@]}") ;;
    --list) list_only=1 ;;
    *) sed -n '2,7s/^# //p' "$0"; [ "$argument" = --help ] && exit 0; exit 2 ;;
    esac
done

if ! command -v dpkg-query > /dev/null; then
    echo "install_packages: this is not a Debian system; please install the equivalents of:" >&2
    echo "  ${packages[*]}" >&2
    exit 0      # the build names what it misses
fi

installed=$(dpkg-query -W -f='${db:Status-Status} ${Package}\n' "${packages[@]}" 2> /dev/null || true)
missing=()
for package in "${packages[@]}"; do
    grep -qx "installed $package" <<< "$installed" || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0
[ $list_only -eq 1 ] && { printf '%s\n' "${missing[@]}"; exit 0; }

echo "Installing: ${missing[*]}"
if [ "$(id -u)" -eq 0 ]; then
    as_root=()
elif command -v sudo > /dev/null; then
    as_root=(sudo)
else
    echo "install_packages: neither root nor sudo. Ask an administrator to run:" >&2
    echo "  apt-get install ${missing[*]}" >&2
    exit 1
fi
log=$(mktemp)
trap 'rm -f "$log"' EXIT
run() {
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive "$@" > "$log" 2>&1 < /dev/null && return
    tail -n 20 "$log" >&2
    echo "install_packages: failed: $*" >&2
    exit 1
}
run apt-get update
run apt-get install -y --no-install-recommends "${missing[@]}"
