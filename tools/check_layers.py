#!/usr/bin/env python3
"""Checks that include arrows point downward only. Prints file:line of each that does not; exit 1.

usage: check_layers.py [ROOT]

A folder inside a room belongs to it. That of a method is its own: of the room only lists of all methods read it.

A header that a kernel (*.k.h) reads, itself or through others, is for devices too: it declares no function and
no function pointer, and only src/exec includes headers of the system.
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
    "sph": 4, "mpm": 4, "rigid": 4, "io": 4, "view": 4,
    "world": 5,
    "record": 6, "scene": 6,
}
# Rooms that read the world through include/tobiuo alone, and the rooms below that they stand on.
ONLY = {"view": {"base", "exec"}, "scene": {"base", "geom"}}
# Folders of one method, and the files of the room that list what all methods have.
METHODS = {"sph/isph": ("isa_sph.c", "params.c")}
PUBLIC = "tobiuo"            # include/tobiuo: allowed everywhere
SUFFIXES = {".c", ".h", ".cu", ".def", ".inc"}
COMMENT = re.compile(r"/\*.*?\*/|//[^\n]*", re.DOTALL)
HOST_ONLY = [
    (re.compile(r"^[ \t]*#[ \t]*include[ \t]*<", re.MULTILINE), "includes a header of the system"),
    (re.compile(r"^(?!typedef|static|TOBI_)[a-z][\w \t*]*\([^;{}]*\)\s*;", re.MULTILINE), "declares a function"),
    (re.compile(r"\(\s*\*\s*\w+\s*\)\s*\("), "declares a function pointer"),
]
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
        folder = target.rpartition("/")[0]
        if folder in METHODS and path.parent != root / "src" / folder and path.name not in METHODS[folder]:
            errors.append(f"{where}:{number}: \"{target}\" is of one method; only {folder} and "
                          f"{', '.join(METHODS[folder])} may include it")
        if other in (PUBLIC, room):
            continue
        if other not in RANK:
            errors.append(f"{where}:{number}: \"{target}\" is not in a room; write \"<room>/<file>\"")
        elif other not in ONLY.get(room, RANK):
            allowed = ", ".join([*sorted(ONLY[room]), "include/tobiuo"])
            errors.append(f"{where}:{number}: {room} includes {other}; it may include {allowed}")
        elif RANK[other] > RANK[room]:
            errors.append(f"{where}:{number}: {room} includes {other}, which is above it")
        elif RANK[other] == RANK[room]:
            errors.append(f"{where}:{number}: {room} includes its sibling {other}")


def kernel_headers(root):
    """All headers that kernels read, each with one that includes it."""
    found, waiting = {}, [(path, path) for path in files(root / "src") if path.name.endswith(".k.h")]
    while waiting:
        path, reader = waiting.pop()
        if path in found or not path.is_file():
            continue
        found[path] = reader
        for _, target in includes(path):
            waiting.append((root / ("include" if target.startswith(PUBLIC + "/") else "src") / target, path))
    return sorted(found.items())


def check_kernel_header(root, path, reader, errors):
    text = COMMENT.sub(lambda match: re.sub(r"[^\n]", " ", match.group()), path.read_text(encoding="utf-8"))
    inside_exec = path.relative_to(root).parts[:2] == ("src", "exec")
    for pattern, what in HOST_ONLY:
        for match in pattern.finditer(text):
            if inside_exec and what == "includes a header of the system":
                continue
            line = text.count("\n", 0, match.start()) + 1
            errors.append(f"{path.relative_to(root)}:{line}: {what}, but kernels read it "
                          f"({reader.relative_to(root)})")


def check_outside_file(root, path, errors):
    """app and bench are users of the library: public headers, their own files, and tables that the build makes (.inc)."""
    where = path.relative_to(root)
    for number, target in includes(path):
        if target.split("/")[0] == PUBLIC or (path.parent / target).exists() or target.endswith(".inc"):
            continue
        errors.append(f"{where}:{number}: \"{target}\" is not a public header")


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parents[1]).resolve()
    errors = []
    room_files = files(root / "src")
    for path in room_files:
        check_room_file(root, path, errors)
    for path, reader in kernel_headers(root):
        check_kernel_header(root, path, reader, errors)
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
