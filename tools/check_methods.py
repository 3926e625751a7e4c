#!/usr/bin/env python3
"""Each method has a theory page, a physics case, a bench and oracles. Prints what is missing; exit 1.

usage: check_methods.py [ROOT]

The methods are those of src/world/methods.def; the first is the one that a scene without "method" gets. A bench
is a case of `tobiuo bench` that names the method; oracles are test/kernel/test_ROOM_oracle.c, which reads the
room's kernels.def, where there is one, and does not compile without an oracle of every kernel.
"""
import pathlib
import re
import sys


def text_of(paths):
    return "\n".join(path.read_text() for path in paths)


def has_case(root, name, is_default):
    for run in sorted((root / "test/physics").glob("*/run.py")):
        scene = run.parent / "scene.json"
        text = text_of([run] + ([scene] if scene.exists() else []))
        runs = rf'"method": "{name}"|\bmethod={name}\b|methods=\([^)]*"{name}"'
        if re.search(runs, text) or (is_default and scene.exists() and '"method"' not in text):
            return True
    return False


def check(root, name, is_default):
    """Yields what the method lacks."""
    sources = list((root / "src").rglob(f"{name}.c"))
    if len(sources) != 1:
        yield f"src/ROOM/{name}.c"
        return
    room = root / "src" / sources[0].relative_to(root / "src").parts[0]
    if not (root / f"docs/theory/{name}.md").exists():
        yield f"a theory page, docs/theory/{name}.md"
    if not has_case(root, name, is_default):
        yield "a case in test/physics"
    if f'"{name}"' not in text_of(sorted((root / "app/tobiuo").glob("bench*.c"))):
        yield "a case of `tobiuo bench`"
    oracle = root / f"test/kernel/test_{room.name}_oracle.c"
    if not oracle.exists():
        yield f"oracles, {oracle.relative_to(root)}"
    elif (room / "kernels.def").exists() and f'#include "{room.name}/kernels.def"' not in oracle.read_text():
        yield f"oracles of every kernel: {oracle.name} does not read {room.name}/kernels.def"


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parents[1])
    names = re.findall(r"^METHOD\((\w+)\)$", (root / "src/world/methods.def").read_text(), re.M)
    faults = [] if names else ["src/world/methods.def: no methods found"]
    for number, name in enumerate(names):
        faults += [f"method {name} lacks {what}" for what in check(root, name, number == 0)]
    print("\n".join(faults + [f"{len(names)} methods, {len(faults)} lacks"]))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
