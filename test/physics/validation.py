#!/usr/bin/env python3
"""The pages of docs/validation: how one is written, when it is older than what it judges, their index.

usage: validation.py list     cases to be made anew, a line each; on stderr how many and how long it takes
       validation.py mark     writes into each page and the index whether it is older than its method or case,
                              and into each page its text (test/physics/CASE/page.md), which may change any time
       validation.py check    warns of pages that are older; fails where a page has another text than page.md, or
                              a sentence of meanings.csv does not fit

A page records two kinds of stamps. Case: the files of test/physics/CASE and of the folders that its run.py names.
Method: the state hashes of the golden scenes of that method (test/golden), which change exactly when its
results do. A scene that came after the page, or with PARTS that the case has not, says nothing about it. Drawback: a change that no golden scene
sees is not seen here either (decision 47).
"""
import csv
import fnmatch
import hashlib
import pathlib
import re
import sys
import textwrap

ROOT = pathlib.Path(__file__).resolve().parents[2]
MADE = re.compile(r"^Made by commit (\S+?)(?:, program (\w+), in ([\d.]+) min)? on (.*?)\.\s(.*?)\n\n", re.M | re.S)
# Parts of a scene whose code no other scene runs.
PARTS = ("inlets", "joints", "nests", "outlets", "porous_zones", "scalars", "solids")
STAMPS = re.compile(r"(case|method \w+) ([0-9a-f]{12})")
OLDER = re.compile(r"^> \*\*.*\n(?:> .*\n)*\n", re.M)
ROW = re.compile(r"^\| (?!figure )(.*) \| (.*) \| (.*) \| (met|\*\*missed\*\*|stated) \|$", re.M)
BLANK = re.compile(r"\{([^{}|]*)(?:\|([+-]?)(1?%|x))?\}")


def fill(text):
    """Paragraphs of at most 100 columns; lists and tables stay as they are."""
    parts = text.strip().split("\n\n")
    return "\n\n".join(part if re.match(r"\s*(\||([-*]|\d+\.)\s)", part) else
                       textwrap.fill(" ".join(part.split()), 100, break_long_words=False, break_on_hyphens=False)
                       for part in parts)


def fold(command):
    """A command as a block of a page, in lines of at most 100 columns that a shell takes as one."""
    lines = [""]
    for word in re.findall(r"(?:--set )?(?:'[^']*'|[^\s'])+", command):
        if lines[-1] and len(lines[-1]) + len(word) > 92:
            lines.append("   ")
        lines[-1] += f" {word}" if lines[-1] else word
    return " \\\n".join("    " + line for line in lines)


def digest(parts):
    total = hashlib.sha256()
    for part in parts:
        total.update(hashlib.sha256(part).digest())
    return total.hexdigest()[:12]


class Tree:
    """What the stamps are made of, in a tree of sources."""

    def __init__(self, root=ROOT):
        self.root, self.pages = root, root / "docs" / "validation"
        self.methods = re.findall(r"^METHOD\((\w+)\)$", (root / "src/world/methods.def").read_text(), re.M)
        with (root / "test/golden/hashes.csv").open(newline="") as file:
            self.golden = {row["scene"]: row for row in csv.DictReader(file)}

    def cases(self):
        return sorted(path.parent.name for path in (self.root / "test/physics").glob("*/run.py"))

    def names_folder(self, text, name):
        """In a path: the word alone is mostly a method, a shape or the name of a body."""
        return re.search(rf"""/ ?"{name}"|/{name}["/]|"{name}/""", text)

    def case_files(self, case):
        folder = self.root / "test/physics" / case
        text = (folder / "run.py").read_text()
        named = [other for home in ("test/physics", "scenes") for other in sorted((self.root / home).glob("*"))
                 if other.is_dir() and other != folder and self.names_folder(text, other.name)]
        return [path for place in [folder, *named] for path in sorted(place.rglob("*"))
                if path.is_file() and path.suffix not in (".md", ".png", ".pyc")]

    def case_stamp(self, case):
        return digest(part for path in self.case_files(case) for part in (path.name.encode(), path.read_bytes()))

    def case_words(self, case):
        """Words of its sources, and of the modules beside the cases that it imports."""
        texts = [path.read_text(errors="ignore") for path in self.case_files(case)]
        for path in sorted((self.root / "test/physics").glob("*.py")):
            if path.stem not in ("harness", "plots", "validation") and any(f"from {path.stem} import" in t for t in texts):
                texts.append(path.read_text())
        return set(re.findall(r"\w+", " ".join(texts)))

    def read_text(self, case):
        """What the page says before its table; no part of a stamp."""
        return fill((self.root / "test/physics" / case / "page.md").read_text())

    def method_stamps(self, method, case):
        """The stamp that a page made now gets, then those of the times when there were fewer scenes. Scenes without
        "method" are of the first one. A scene with PARTS counts for cases that have one of them."""
        rows, words = [], self.case_words(case)
        for path in sorted((self.root / "test/golden").glob("*.json")):
            text = path.read_text()
            named = re.search(r'"method": "(\w+)"', text)
            parts = {part for part in PARTS if f'"{part}"' in text}
            if parts and not parts & words:
                continue
            if (named.group(1) if named else self.methods[0]) == method:
                row = self.golden.get(path.stem, {"state": None, "added": 0})
                rows.append((int(row["added"]), f"{path.stem} {row['state']}".encode()))
        return [digest(row for added, row in rows if added <= last) for last in sorted({r[0] for r in rows} or {0}, reverse=True)]

    def stamps(self, case, methods):
        """Of a case that ran these methods; one that ran none judges the kernels of all."""
        found = {"case": self.case_stamp(case)}
        found.update({f"method {m}": self.method_stamps(m, case)[0] for m in sorted(methods) or self.methods})
        return found

    def now(self, case, name):
        """The stamps that a page of today may have."""
        if name == "case":
            return [self.case_stamp(case)]
        method = name.split()[1]
        return self.method_stamps(method, case) if method in self.methods else []


class Page:
    """A page of a case, as it stands."""

    def __init__(self, tree, case):
        self.tree, self.case, self.path = tree, case, tree.pages / f"{case}.md"
        self.text = self.path.read_text() if self.path.exists() else ""
        made = MADE.search(self.text)
        self.commit, self.minutes = (made.group(1), made.group(3)) if made else (None, None)
        self.machine = made.group(4) if made else None
        told = " ".join(made.group(5).split()) if made else ""
        self.stamps = dict(STAMPS.findall(told))
        self.title = self.text.splitlines()[0].lstrip("# ") if self.text else case
        self.rows = ROW.findall(self.text)

    def older(self):
        """Says that the page is older than what it judges; "" if it is not, None without a page."""
        if not self.text:
            return None
        if not self.stamps or self.commit.endswith("+changes"):
            return "This page may be older than its method or case, which it does not record"
        changed = [name for name, stamp in self.stamps.items() if stamp not in self.tree.now(self.case, name)]
        return "This page is older than its " + " and its ".join(changed) if changed else ""

    def told(self):
        """Page with the text of page.md."""
        made, table = MADE.search(self.text), self.text.find("\n| figure |")
        if not made or table < 0:
            return self.text
        return self.text[:made.end()] + self.tree.read_text(self.case) + "\n" + self.text[table:]

    def marked(self):
        """The page with its text, and what must be said of its age."""
        text, older = OLDER.sub("", self.told(), count=1), self.older()
        if not older:
            return text
        note = textwrap.fill(f"**{older}.**", 98).replace("\n", "\n> ")
        return text.replace("\n\n", f"\n\n> {note}\n> `./test.sh --slow {self.case}` makes it anew.\n\n", 1)


def made_line(commit, machine, program, seconds, stamps):
    told = ", ".join(f"{name} {stamp}" for name, stamp in stamps.items())
    return f"Made by commit {commit}, program {program}, in {max(seconds/60, 0.1):.1f} min on {machine}. Of {told}."


def render(meaning, page):
    """A meaning with its blanks filled, and why it does not fit the page ("": it does). {figure} is the value,
    {figure|%} its size in percent, {figure|1%} that of its distance from 1, {figure|x} a share in percent;
    +% and -% have the sign that the sentence tells of. A figure may have * in its name."""
    faults = []

    def value(match):
        pattern, sign, form = match.groups()
        found = [row[1] for row in page.rows if fnmatch.fnmatchcase(row[0], pattern)]
        if len(found) != 1:
            faults.append(f"{len(found)} figures are '{pattern}'")
        if not form or faults:
            return "".join(found[:1])
        number = 100*(float(found[0]) - (form == "1%"))
        if sign and number*(1 if sign == "+" else -1) <= 0:
            faults.append(f"'{pattern}' is {found[0]}, the sentence tells of another sign")
        return f"{abs(number):.2g}" if abs(number) < 99.5 else f"{abs(number):.0f}"
    text = BLANK.sub(value, meaning)
    return (text if not faults else "See the page."), "; ".join(faults or ([] if meaning else ["no sentence"]))


def read_meanings(tree):
    with (tree.root / "test/physics/meanings.csv").open(newline="") as file:
        return {row["case"]: row["meaning"] for row in csv.DictReader(file)}


HEAD = """# Validation

Results at reference size, one page per case. Do not edit: `./test.sh --slow [CASE]
[--reference DIR]` writes them.

- A page has every figure, met, missed or without a goal, what it is compared with, and the
  commands.
- DIR (or $TOBIUO_REFERENCE) holds published data, which are not part of this repository.
  Without it, cases use the few values that stand in their run.py.
- `./test.sh --slow --stale` makes the older pages anew, and goes on where it was stopped.
- *d* is the spacing of the particles.
"""


def index(tree):
    """docs/validation/README.md: what each case means, its goals, and every goal that is missed."""
    meanings, misses, cases, goals, old = read_meanings(tree), [], [], [0, 0], 0
    for page in [Page(tree, case) for case in tree.cases()]:
        if not page.text:
            continue
        link = f"[{page.title}]({page.case}.md)"
        judged = [row for row in page.rows if row[3] != "stated"]
        met = sum(row[3] == "met" for row in judged)
        goals = [goals[0] + met, goals[1] + len(judged)]
        old += bool(page.older())
        cases.append(f"| {link} | {render(meanings.get(page.case, ''), page)[0]} | {met} of {len(judged)} | "
                     f"{page.commit}{', older' if page.older() else ''} |")
        misses += [f"| {link} | {' | '.join(row[:3])} |" for row in judged if row[3] != "met"]
    lines = [HEAD, f"Of {goals[1]} goals {goals[0]} are met. {old} of {len(cases)} pages are, or may be, older than "
             "their method or case.", "", "| case | what it means | goals met | commit |", "|---|---|---|---|", *cases, "",
             "## Goals that are missed", "", "| case | figure | value | goal |", "|---|---|---|---|", *misses]
    missing = [case for case in tree.cases() if not Page(tree, case).text]
    if missing:
        text = f"Without a page, so not run to the end at reference size: {', '.join(missing)}."
        lines += ["", *textwrap.wrap(text, 100)]
    return "\n".join(lines) + "\n"


def mark(tree):
    for page in [Page(tree, case) for case in tree.cases()]:
        if page.text and page.marked() != page.text:
            page.path.write_text(page.marked())
    (tree.pages / "README.md").write_text(index(tree))


def to_do(tree):
    """Cases to be made anew, the quickest first, those of unknown length last; a line that says how long."""
    pages = [page for page in (Page(tree, case) for case in tree.cases()) if page.older() != ""]
    pages.sort(key=lambda page: (page.minutes is None, float(page.minutes or 0)))
    known = [float(page.minutes) for page in pages if page.minutes]
    unknown = len(pages) - len(known)
    told = f"{len(pages)} of {len(tree.cases())} pages are to be made anew"
    if known:
        told += f": {sum(known)/60:.1f} hours on the machines that made {len(known)} of them"
    if unknown:
        told += f"; {unknown} do not record how long they take, up to hours each"
    return [page.case for page in pages], told


def check(tree):
    """Warns of age; fails where a sentence of the index does not fit its page."""
    pages = [page for page in (Page(tree, case) for case in tree.cases()) if page.text]
    wrong, meanings, failed = [page.case for page in pages if page.text != page.marked()], read_meanings(tree), 0
    if wrong:
        print(f"warning: {len(wrong)} pages do not say rightly whether they are older than their method or case; "
              f"test/physics/validation.py mark writes it: {', '.join(wrong)}")
    print(to_do(tree)[1])
    for page in pages:
        if page.told() != page.text:
            print(f"docs/validation/{page.case}.md: its text is not that of test/physics/{page.case}/page.md; "
                  "test/physics/validation.py mark writes it")
            failed = 1
        fault = render(meanings.get(page.case, ""), page)[1]
        if fault:
            print(f"test/physics/meanings.csv: {page.case}: {fault}")
            failed = 1
    for case in sorted(set(meanings) - set(tree.cases())):
        print(f"test/physics/meanings.csv: there is no case {case}")
        failed = 1
    return failed


def main():
    what, tree = sys.argv[1] if len(sys.argv) == 2 else "", Tree()
    if what == "list":
        cases, told = to_do(tree)
        print(told, file=sys.stderr)
        print("\n".join(cases))
    elif what == "mark":
        mark(tree)
    else:
        sys.exit(check(tree) if what == "check" else __doc__)


if __name__ == "__main__":
    main()
