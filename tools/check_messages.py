#!/usr/bin/env python3
"""Every error message is provoked by a unit test. Lists those that none provokes; exit 1.

usage: check_messages.py ROOT NOTES...      NOTES: what test/messages.c wrote in each test

Messages are compared as formats; one text said in several places counts once. Messages about lack of
memory are left to the tests that let allocations fail. UNTESTED holds the rest that a test cannot
provoke, with the reason; a reason that is no longer needed is a breach too.
"""
import pathlib
import re
import sys

CALLS = re.compile(r"\b(?:tobi_fail|tobi_source_mistake(?:_at_key)?|tobi_report_add)\s*\(")
LITERAL = re.compile(r'"((?:\\.|[^"\\\n])*)"')
LITERALS = re.compile(r'"(?:\\.|[^"\\\n])*"(?:\s*"(?:\\.|[^"\\\n])*")*')
MEMORY = ("no memory", "out of memory", "NO_MEMORY")

# a part of the message: why no test provokes it
UNTESTED = {
    "the importer took more than": "needs a mesh that keeps the importer busy for many seconds",
    "the importer crashed": "needs a mesh that crashes the importer; assimp's mistakes come and go",
    "the importer ended early": "needs an importer that dies without a signal",
    "cannot be read to its end": "needs a disk that fails or a file that shrinks while it is read",
    "the importer cannot start": "needs fork to fail, which root is never refused",
    "refining to edges of": "needs 100 million triangles",
    "no particle fits into the body": "the search moves the lattice until a point is inside; last resort",
    "dimensions, expected 1 or 2": "needs a foreign HDF5 file with our checksum",
    "STL holds at most": "needs 4 thousand million triangles",
    "a scene must be an object": "said inside source.c, past the notes; test_scene_mistakes expects it",
    "output.fields: more than": "there are fewer fields than room for them",
    "cannot list": "needs opendir to fail, which root is never refused",
    "swims, but the program of its motion": "needs an installation without its scenes",
    "the program of the knife, scenes/": "needs an installation without its scenes",
}


def unquote(text):
    return "".join(LITERAL.findall(text)).replace('\\"', '"').replace("\\\\", "\\")


def arguments(text, start):
    """The text between the parentheses of a call; start is behind the opening one."""
    depth, at = 1, start
    while depth:
        literal = LITERAL.match(text, at) if text[at] == '"' else None
        depth += (text[at] == "(") - (text[at] == ")")
        at = literal.end() if literal else at + 1
    return text[start:at - 1]


def messages(root):
    """(format, where, about memory) of every message."""
    for path in sorted((root / "src").rglob("*.c")):
        text = path.read_text(encoding="utf-8")
        text = re.sub(r'"\s*PRI([du])64\s*"', r"l\1", text)
        text = re.sub(r'"\s*PRI([du])64', r'l\1"', text)
        for call in CALLS.finditer(text):
            inside = arguments(text, call.end())
            literals = LITERALS.search(inside)
            if literals:
                line = text.count("\n", 0, call.start()) + 1
                memory = any(word in inside for word in MEMORY)
                yield unquote(literals.group(0)), f"{path.relative_to(root)}:{line}", memory


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    root = pathlib.Path(sys.argv[1]).resolve()
    said = set()
    for file in sys.argv[2:]:
        if pathlib.Path(file).exists():
            said.update(pathlib.Path(file).read_bytes().decode("utf-8", "replace").split("\0"))
    found = list(messages(root))
    missing, excused, silent = [], set(), 0
    for message, where, memory in found:
        why = [part for part in UNTESTED if part in message]
        if message not in said:
            excused.update(why)
            silent += memory
            if not memory and not why:
                missing.append(f"{where}: no test provokes \"{message}\"")
    for part in UNTESTED:
        if part not in excused:
            missing.append(f"tools/check_messages.py: UNTESTED has \"{part}\" without need")
    print("\n".join(missing + [f"{len(found)} messages; {silent} about memory and {len(excused)} others "
                               f"unprovoked, with reason; {len(missing)} breaches"]))
    return 1 if missing else 0


if __name__ == "__main__":
    sys.exit(main())
