#!/usr/bin/python3
"""Writes docs/scene.ja.md: docs/scene.md with the Japanese texts of the catalogue docs/scene.ja.po.

usage: translate_scene.py [--update | --check] [ROOT]
             writes the page and names what it lacks
  --update   brings the catalogue to the texts of docs/scene.md: new ones come without Japanese, or with that of
             a similar text that went, marked fuzzy; what is no longer used goes
  --check    writes nothing, says whether the page is up to date; exit 1 if not, or if anything is missing

A text is a heading, a paragraph, an item of a list, a cell of a table or a comment in an example; its line breaks do
not count. Keys, numbers, words of scenes and units stay. Line breaks of the Japanese are those of the page.
Needs python3-polib; without it the answer is 77.
"""
import difflib
import json
import pathlib
import re
import sys

LINES = r"[^\n]+(?:\n[^\n]+)*"                                  # up to an empty line
CODE = r"```.*?\n```"
RANGE = re.compile(r'(\S+) to ([^\s,]+)(?: ([^,]+))?(?:, or ("[^"]*"))?')
BAR = re.compile(r"(?<!\\)\|")


def translate(page, say):
    """The page with say(text) in the place of each text."""
    def words(unit):                                            # of kg/m3 there is nothing to translate
        return say(unit) if re.search("[a-z]{4}| or ", unit) else unit

    def limits(cell):
        """1 to 8 entries, or "none"; or words of scenes: slip, no-slip or open."""
        found = RANGE.fullmatch(cell)
        if not found:
            return cell.replace(", ", "、").replace(" or ", "、")
        low, high, unit, word = found.groups()
        unit = words(unit or "")
        space = " " if unit and unit[0].isascii() else ""
        return f"{low}～{high}{space}{unit}" + (f"、または{word}" if word else "")

    def required(cell):
        return say(cell) if cell.startswith("**") else cell

    def table(lines):
        columns = {"type": say, "unit": words, "default": required, "allowed": limits, "meaning": say}
        rows = [[cell.strip() for cell in BAR.split(line)[1:-1]] for line in lines]
        work = [columns.get(name, str) for name in rows[0]]
        rows = [list(map(say, rows[0]))] + [[f(cell) if cell else "" for f, cell in zip(work, row)] for row in rows[2:]]
        written = ["| " + " | ".join(row).replace("\n", "") + " |" for row in rows]
        return "\n".join([written[0], lines[1]] + written[1:])

    def block(match):
        text = match.group()
        if text.startswith("```"):
            return re.sub("(?<= // ).*", lambda comment: words(comment.group()), text)
        if text.startswith("|"):
            return table(text.split("\n"))
        if text.startswith("#"):
            marks, heading = text.split(" ", 1)
            return text if re.fullmatch("`[^`]*`", heading) else f"{marks} {say(heading)}"
        if text.startswith("- "):
            items = [say(" ".join(item.split())) for item in re.split(r"(?:^|\n)- ", text)[1:]]
            return "\n".join("- " + item.replace("\n", "\n  ") for item in items)
        return say(" ".join(text.split()))

    return re.sub(f"{CODE}|{LINES}", block, page, flags=re.S)


def texts_of(page):
    found = {}
    translate(page, lambda text: found.setdefault(text, text))
    return list(found)


def update(polib, catalogue, texts):
    """The same entries in the order of the page, which is that of a reader and of a diff."""
    known = {entry.msgid: entry for entry in catalogue}
    gone = [text for text in known if text not in texts]
    new = polib.POFile(wrapwidth=100)
    new.metadata, new.header = catalogue.metadata, catalogue.header
    for text in texts:
        entry = known.get(text) or polib.POEntry(msgid=text)
        for near in [] if text in known else difflib.get_close_matches(text, gone, 1):
            entry.previous_msgid, entry.msgstr, entry.flags = near, known[near].msgstr, ["fuzzy"]
        new.append(entry)
    return new, f"{sum(text not in known for text in texts)} texts added, {len(gone)} taken out"


def faults(catalogue, texts):
    """What a developer has to do, a line for each text."""
    known = {entry.msgid: entry for entry in catalogue}
    for text in texts:
        if text not in known:
            yield f"is new: run tools/translate_scene.py --update, write its Japanese: {json.dumps(text)}"
        elif not known[text].msgstr:
            yield f"has no Japanese; write it: {json.dumps(text)}"
        elif known[text].fuzzy:
            yield f"has changed; correct its Japanese and delete its line \"#, fuzzy\": {json.dumps(text)}"
    for text in known:
        if text not in texts:
            yield f"is no longer used; run tools/translate_scene.py --update: {json.dumps(text)}"


def main(arguments):
    mode = arguments.pop(0) if arguments and arguments[0].startswith("--") else ""
    if mode not in ("", "--update", "--check") or len(arguments) > 1:
        sys.exit(__doc__)
    try:
        import polib
    except ImportError:
        print("python3-polib is missing: tools/install_packages.sh --test")
        return 77
    root = pathlib.Path(arguments[0]) if arguments else pathlib.Path(__file__).parents[1]
    english, translations, japanese = (root / "docs" / name for name in ("scene.md", "scene.ja.po", "scene.ja.md"))
    page = english.read_text(encoding="utf-8")
    texts = texts_of(page)
    try:
        catalogue = polib.pofile(str(translations), encoding="utf-8")
    except OSError as error:
        print(f"docs/scene.ja.po: {error}")
        return 1
    if mode == "--update":
        catalogue, told = update(polib, catalogue, texts)
        catalogue.save(str(translations))
        print(f"docs/scene.ja.po: {told}")
    found = [f"docs/scene.ja.po: a text {fault}" for fault in faults(catalogue, texts)]
    known = {entry.msgid: entry.msgstr for entry in catalogue}
    written = translate(page, lambda text: known.get(text) or text)
    if mode == "--check" and not (japanese.exists() and japanese.read_text(encoding="utf-8") == written):
        found.append("docs/scene.ja.md is out of date: run tools/translate_scene.py")
    elif mode != "--check":
        japanese.write_text(written, encoding="utf-8")
    print("\n".join(found + [f"{len(texts)} texts, {len(found)} faults"]))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
