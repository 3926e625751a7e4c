#!/usr/bin/env python3
"""The Japanese catalogue of the program, app/tobiuo/ja.po: whether it has all that tr() is asked for.

usage: catalogue.py LIBRARY [ROOT]     exit 1 with a line for each fault; 77 without python3-polib

The texts are those that the sources mark by tr("...") or TEXT("..."), and what the library says: meanings and units
of columns, stages of a step. Missing ones are printed as entries to be copied.
"""
import ctypes
import json
import pathlib
import re
import sys

MARKED = re.compile(r'\b(?:tr|TEXT)\(\s*("(?:[^"\\]|\\.)*"(?:\s*"(?:[^"\\]|\\.)*")*)\s*\)')
STAGE = re.compile(r"tobi_stage_end\(([^;]*);")
PIECE = re.compile(r'"((?:[^"\\]|\\.)*)"')
CONVERSION = re.compile(r"%[-+#0]*(?:\*|\d+)?(?:\.(?:\*|\d+))?(?:hh|h|ll|l|z|j|t)?[diouxXeEfgGcsp%]")
TAG = re.compile(r"<[^<>]*>")
TABLES, SOLIDS = 14, 8                         # of enum tobi_table


class Column(ctypes.Structure):
    _fields_ = [("name", ctypes.c_char_p), ("unit", ctypes.c_char_p), ("doc", ctypes.c_char_p)]


def literal(pieces):
    """The value of the string literals of C, which are those of JSON as the sources use them."""
    return "".join(json.loads(f'"{piece}"') for piece in PIECE.findall(pieces))


def marked_texts(root):
    for path in sorted((root / "app").rglob("*.[ch]")):
        for found in MARKED.finditer(path.read_text(encoding="utf-8")):
            yield literal(found.group(1)), path.name


def stage_texts(root):
    for path in sorted((root / "src").rglob("*")):
        if path.suffix in (".c", ".h", ".def"):
            for call in STAGE.finditer(path.read_text(encoding="utf-8")):
                for piece in PIECE.finditer(call.group(1)):
                    yield piece.group(1), "a stage"


def column_texts(library):
    """Of the columns that a report shows: not those of solids.csv, words, or the time."""
    c = ctypes.CDLL(library)
    c.tobi_run_column.restype = ctypes.POINTER(Column)
    c.tobi_run_unit.restype = ctypes.c_char_p
    for table in set(range(TABLES)) - {SOLIDS}:
        index = 0
        while c.tobi_run_column(table, index):
            column = c.tobi_run_column(table, index).contents
            index += 1
            if column.unit == b"text" or column.name in (b"time", b"step"):
                continue
            for unit in {c.tobi_run_unit(column.unit, dimension).decode() for dimension in (2, 3)}:
                if re.search(r"\bper\b|[a-z]{4}", unit):
                    yield unit, "a unit"
            if column.doc:
                yield column.doc.decode(), f"column {column.name.decode()}"


def faults(entries, texts):
    """entries: (msgid, msgstr, fuzzy); texts: dict of texts and their places."""
    seen = {}
    for english, japanese, fuzzy in entries:
        where = json.dumps(english)
        if english in seen:
            yield f"twice: {where}"
        seen[english] = japanese
        if english not in texts:
            yield f"no longer used: {where}"
        if fuzzy:
            yield f"fuzzy: {where}"
        if japanese in ("", english):
            yield f"without Japanese: {where}"
        elif CONVERSION.findall(english) != CONVERSION.findall(japanese):
            yield f"other conversions or another order: {where}"
        elif sorted(TAG.findall(english)) != sorted(TAG.findall(japanese)):
            yield f"other tags: {where}"
    for text, place in texts.items():
        if text not in seen:
            yield f"missing, of {place}:\nmsgid {json.dumps(text)}\nmsgstr \"\"\n"


def check_itself():
    """The faults are found."""
    good = ("%d of <b>%s</b>", "%d、<b>%s</b>の", False)
    texts = {good[0]: "here"}
    assert not list(faults([good], texts))
    for bad in [[], [good, good], [good, ("old", "古い", False)], [(good[0], good[1], True)], [(good[0], "", False)],
                [(good[0], "%s、<b>%d</b>の", False)], [(good[0], "%d、%sの", False)],
                [(good[0], "%d、<b>%s</b>の%%", False)]]:
        assert len(list(faults(bad, texts))) == 1, bad
    assert [literal(m.group(1)) for m in MARKED.finditer('x(tr("a \\"b\\""\n   " c"), TEXT("d"), str("e"))')] == \
        ['a "b" c', "d"]
    assert CONVERSION.findall("%.2g %% %-5s %lld %.*s 5 % of") == ["%.2g", "%%", "%-5s", "%lld", "%.*s"]


def main(library, root=pathlib.Path(__file__).parents[2]):
    try:
        import polib
    except ImportError:
        print("python3-polib is missing: tools/install_packages.sh --test")
        return 77
    check_itself()
    root = pathlib.Path(root)
    texts = {}
    for text, place in [*marked_texts(root), *column_texts(library), *stage_texts(root)]:
        texts.setdefault(text, place)
    catalogue = polib.pofile(str(root / "app/tobiuo/ja.po"), encoding="utf-8")
    found = list(faults([(e.msgid, e.msgstr, e.fuzzy) for e in catalogue if not e.obsolete], texts))
    print("\n".join(found + [f"app/tobiuo/ja.po: {len(texts)} texts, {len(found)} faults"]))
    return 1 if found else 0


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))
