#!/usr/bin/env python3
"""Checks that include arrows point downward only. Prints file:line of each that does not; exit 1.

usage: check_layers.py [ROOT]
"""
import pathlib
import re
import sys

# Low to high. A room may include itself and rooms of lower rank. Rooms of equal rank are siblings
# and never include each other.
RANK = {
    "base": 0,
    "exec": 1, "comm": 1,
    "geom": 2, "linear": 2,
    "core": 3,
    "sph": 4, "mpm": 4, "rigid": 4, "io": 4,
    "world": 5,
    "scene": 6,
}
PUBLIC = "tobiuo"            # include/tobiuo: allowed everywhere
SUFFIXES = {".c", ".h", ".cu", ".def", ".inc"}
INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"')


def includes(path):
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        match = INCLUDE.match(line)
        if match:
            yield number, match.group(1)


def files(folder):
    return sorted(p for p in folder.rglob("*") if p.suffix in SUFFIXES) if folder.is_dir() else []


def check_room_file(root, path, errors):
    room = path.relative_to(root / "src").parts[0]
    where = path.relative_to(root)
    if room not in RANK:
        errors.append(f"{where}:1: unknown room '{room}'; rooms are {', '.join(RANK)}")
        return
    for number, target in includes(path):
        other = target.split("/")[0] if "/" in target else room
        if other in (PUBLIC, room):
            continue
        if other not in RANK:
            errors.append(f"{where}:{number}: \"{target}\" is not in a room; write \"<room>/<file>\"")
        elif RANK[other] > RANK[room]:
            errors.append(f"{where}:{number}: {room} includes {other}, which is above it")
        elif RANK[other] == RANK[room]:
            errors.append(f"{where}:{number}: {room} includes its sibling {other}")


def check_outside_file(root, path, errors):
    """app and bench are users of the library: public headers and their own files only."""
    where = path.relative_to(root)
    for number, target in includes(path):
        if target.split("/")[0] == PUBLIC or (path.parent / target).exists():
            continue
        errors.append(f"{where}:{number}: \"{target}\" is not a public header")


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parents[1]).resolve()
    errors = []
    room_files = files(root / "src")
    for path in room_files:
        check_room_file(root, path, errors)
    outside = files(root / "app") + files(root / "bench")
    for path in outside:
        check_outside_file(root, path, errors)
    for path in files(root / "include"):
        for number, target in includes(path):
            if target.split("/")[0] != PUBLIC:
                errors.append(f"{path.relative_to(root)}:{number}: public header includes \"{target}\"")
    print("\n".join(errors + [f"{len(room_files) + len(outside)} files, {len(errors)} wrong includes"]))
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main())
