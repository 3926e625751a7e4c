#!/usr/bin/env python3
"""The Japanese catalogues app/tobiuo/ja.po and src/ja.po: whether they have all that tr() is asked for.

usage: catalogue.py LIBRARY [ROOT]      exit 1 with a line for each fault; 77 without python3-polib
       catalogue.py --update LIBRARY [ROOT]    brings src/ja.po to the order of the sources, new texts without Japanese

The texts of the program are those that its sources mark by tr("...") or TEXT("..."), and what the library says of
itself: meanings and units of columns, stages of a step. Those of the library are the formats of its errors and
mistakes, as tools/check_messages.py finds them, and what src/ marks by tr("...") or TR("..."). Missing ones are
printed as entries to be copied.
"""
import ctypes
import json
import pathlib
import re
import sys

MARKED = re.compile(r'\b(?:tr|TR|TEXT)\(\s*("(?:[^"\\]|\\.)*"(?:\s*"(?:[^"\\]|\\.)*")*)\s*\)')
REQUIRED = re.compile(r'\.required = true,[^{}]*?\.doc\s*=\s*("(?:[^"\\]|\\.)*"(?:\s*"(?:[^"\\]|\\.)*")*)')
OPTION = re.compile(r'\{\s*"[a-z]+",\s*[^,{}]+,\s*(?:NULL|"(?:[^"\\]|\\.)*"),\s*0,\s*("(?:[^"\\]|\\.)*"(?:\s*"(?:[^"\\]|\\.)*")*)')
COMMAND = re.compile(r'\{ "[a-z]+", "[^"]*", ("(?:[^"\\]|\\.)*"),\s+tobiuo_')
COMMAND_DOC = re.compile(r'\.doc\s*=\s*("(?:[^"\\]|\\.)*"(?:\s*"(?:[^"\\]|\\.)*")*)')
OF_OLD_KEYS = re.compile(r'(?:SAY\(|\.absent = |'
                         r'FISH\("\w+", \w+, "\w+", |FISH3\("\w+", \w+, |tobi_import_remark\(\w+, [^,]*, )'
                         r'\s*("(?:[^"\\]|\\.)*"(?:\s*"(?:[^"\\]|\\.)*")*)')
STAGE = re.compile(r"tobi_stage_end\(([^;]*);")
PIECE = re.compile(r'"((?:[^"\\]|\\.)*)"')
CONVERSION = re.compile(r"%(?P<place>\d+\$)?(?P<as>[-+#0]*(?:\*|\d+)?(?:\.(?:\*|\d+))?(?:hh|h|ll|l|z|j|t)?[diouxXeEfgGcsp%])")
SAYS = re.compile(r"\b(?:as|sn|vsn)printf\s*\(|\bREFUSE\(|\b(?:tobi_mesh_note|refuse\w*|fail_\w+|tell|png_error)\s*\(")
WORDS = re.compile("[a-z%] [a-z]+ ")
NOT_SAID = ("src/scene/describe/", "src/scene/import/", "src/world/params")     # pages and files, in English
TAG = re.compile(r"<[^<>]*>")
TABLES, SOLIDS = 14, 8                         # of enum tobi_table


class Column(ctypes.Structure):
    _fields_ = [("name", ctypes.c_char_p), ("unit", ctypes.c_char_p), ("doc", ctypes.c_char_p)]


def literal(pieces):
    """The value of the string literals of C, which are those of JSON as the sources use them."""
    return "".join(json.loads(f'"{piece}"') for piece in PIECE.findall(pieces))


def marked_texts(folder):
    for path in sorted(folder.rglob("*.[ch]")):
        for found in MARKED.finditer(path.read_text(encoding="utf-8")):
            yield literal(found.group(1)), str(path)


def conversions(text):
    """Those of a format in the order of its values. Precision may change, so that "%.0s" drops a plural's s."""
    found = [(m["place"], re.sub(r"\.\d+", "", m["as"])) for m in CONVERSION.finditer(text)]
    placed = [(int(place[:-1]), kind) for place, kind in found if place]
    if placed and len(placed) + [kind for _, kind in found].count("%") != len(found):
        return ["some with a place and some without"]
    return [kind for _, kind in sorted(placed)] + [kind for place, kind in found if not place]


def required_docs(root):
    """Meanings of keys that a scene must have: a mistake tells them."""
    for path in sorted((root / "src").rglob("*.c")):
        text = path.read_text(encoding="utf-8").replace("\\\n", "\n")
        for found in REQUIRED.finditer(text):
            yield str(path.relative_to(root)), literal(found.group(1))


def import_texts(root):
    """What the tables of old programs' keys say."""
    for path in sorted((root / "src/scene/import").glob("*.c")):
        text = path.read_text(encoding="utf-8").replace("\\\n", "\n")
        for found in OF_OLD_KEYS.finditer(text):
            yield str(path.relative_to(root)), literal(found.group(1))


def check_messages():
    sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "tools"))
    import check_messages as tool
    return tool


def library_texts(root):
    """Formats without a word need no Japanese."""
    found = [(path, text) for text, path, _ in check_messages().messages(root)]
    found += [(path.removeprefix(f"{root}/"), text) for text, path in marked_texts(root / "src")]
    found += required_docs(root)
    found += import_texts(root)
    for path, text in sorted(found, key=lambda both: both[0].split(":")[0]):
        if re.search("[A-Za-z]{2}", CONVERSION.sub("", text)):
            yield text, path


def stage_texts(root):
    for path in sorted((root / "src").rglob("*")):
        if path.suffix in (".c", ".h", ".def"):
            for call in STAGE.finditer(path.read_text(encoding="utf-8")):
                for piece in PIECE.finditer(call.group(1)):
                    yield piece.group(1), "a stage"


def columns(library):
    c = ctypes.CDLL(library)
    c.tobi_run_column.restype = ctypes.POINTER(Column)
    c.tobi_run_unit.restype = ctypes.c_char_p
    for table in range(TABLES):
        index = 0
        while c.tobi_run_column(table, index):
            column = c.tobi_run_column(table, index).contents
            index += 1
            yield column, {c.tobi_run_unit(column.unit, dimension).decode() for dimension in (2, 3)}, table


def unit_texts(library):
    """Of the columns that a report shows: not those of solids.csv, words, or the time."""
    for column, units, table in columns(library):
        if table == SOLIDS or column.unit == b"text" or column.name in (b"time", b"step"):
            continue
        for unit in units:
            if re.search(r"\bper\b|[a-z]{4}", unit):
                yield unit, "a unit"


def column_texts(library):
    """Meanings, which the report shows and `tobiuo describe` tells."""
    for column, _, _ in columns(library):
        if column.doc:
            yield column.doc.decode(), f"column {column.name.decode()}"


def complaints(root):
    """Formats of complain(), which looks them up itself."""
    for path in sorted((root / "app").rglob("*.c")):
        text = path.read_text(encoding="utf-8")
        for call in re.finditer(r"\bcomplain\s*\(", text):
            inside = check_messages().arguments(text, call.end())
            found = check_messages().LITERALS.search(re.sub(r'"\s*PRI([du])64\s*"', r"l\1", inside))
            if found and re.search("[A-Za-z]{2}", CONVERSION.sub("", literal(found.group(0)))):
                yield literal(found.group(0)), path.name


def help_texts(root):
    """What the tables of argp say of commands and options, and main.c of commands."""
    for path in sorted((root / "app/tobiuo").glob("*.[ch]")):
        text = path.read_text(encoding="utf-8").replace("\\\n", "\n")
        for pattern in OPTION, COMMAND, COMMAND_DOC:
            if pattern is not COMMAND_DOC or "struct argp " in text:
                for found in pattern.finditer(text):
                    yield literal(found.group(1)), path.name


def purposes(root):
    """First sentences of the shipped scenes, which `tobiuo scenes` lists."""
    for path in sorted((root / "scenes").glob("*/scene.json")):
        head = re.match(r"(?://[^\n]*\n)*", path.read_text(encoding="utf-8")).group(0)
        sentence = re.match(r".*?\.(?= |$)", " ".join(line[2:].strip() for line in head.splitlines()))
        if sentence:
            yield sentence.group(0), str(path.relative_to(root))


def unmarked_texts(root):
    """What goes into a message or a note by %s without tr: a guess by its words."""
    for path in sorted((root / "src").rglob("*.c")):
        name, text = str(path.relative_to(root)), path.read_text(encoding="utf-8")
        for calls, first in (check_messages().CALLS, 1), (SAYS, 0):
            for call in calls.finditer(text):
                inside = check_messages().arguments(text, call.end())
                for found in [*check_messages().LITERALS.finditer(inside)][first:]:
                    if WORDS.search(found.group(0)) and not re.search(r"\b(tr|TR)\($", inside[:found.start()]):
                        if not name.startswith(NOT_SAID) and "PRI" not in inside:
                            line = text.count("\n", 0, call.start()) + 1
                            yield f"{name}:{line}: not marked by tr: {found.group(0)}"


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
        elif conversions(english) != conversions(japanese):
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
    assert conversions("%.2g %% %-5s %lld %.*s 5 % of") == ["g", "%", "-5s", "lld", ".*s"]
    assert conversions("%2$s %1$.3g") == ["g", "s"] == conversions("%g%.0s") != conversions("%g %2$s")


def main(library, root=pathlib.Path(__file__).parents[2]):
    try:
        import polib
    except ImportError:
        print("python3-polib is missing: tools/install_packages.sh --test")
        return 77
    check_itself()
    root = pathlib.Path(root)
    own = [*marked_texts(root / "app"), *complaints(root), *help_texts(root), *purposes(root), *unit_texts(library), *stage_texts(root)]
    known = {entry.msgid for entry in polib.pofile(str(root / "src/ja.po"), encoding="utf-8")}
    found = check_catalogue(polib, root, "src/ja.po", [*library_texts(root), *column_texts(library)])
    found += check_catalogue(polib, root, "app/tobiuo/ja.po", own, known)
    unmarked = list(unmarked_texts(root))
    print("\n".join(unmarked))
    return 1 if found + len(unmarked) else 0


def check_catalogue(polib, root, name, pairs, elsewhere=()):
    """Prints the faults and returns their number. Texts that stand elsewhere may stand here too."""
    texts = {}
    for text, place in pairs:
        texts.setdefault(text, place)
    entries = [e for e in polib.pofile(str(root / name), encoding="utf-8") if not e.obsolete]
    here = {e.msgid for e in entries}
    texts = {text: place for text, place in texts.items() if text in here or text not in elsewhere}
    found = list(faults([(e.msgid, e.msgstr, e.fuzzy) for e in entries], texts))
    print("\n".join(found + [f"{name}: {len(texts)} texts, {len(found)} faults"]))
    return len(found)


def update(library, root=pathlib.Path(__file__).parents[2]):
    import polib
    path = str(pathlib.Path(root) / "src/ja.po")
    old = polib.pofile(path, encoding="utf-8", wrapwidth=110)
    known = {entry.msgid: entry.msgstr for entry in old}
    for entry in list(old):
        old.remove(entry)
    texts = [*library_texts(pathlib.Path(root)), *column_texts(library)]
    for text in dict.fromkeys(text for text, _ in texts):
        old.append(polib.POEntry(msgid=text, msgstr=known.get(text, "")))
    old.save(path)
    return 0


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3, 4):
        sys.exit(__doc__)
    sys.exit(update(*sys.argv[2:]) if sys.argv[1] == "--update" else main(*sys.argv[1:]))
