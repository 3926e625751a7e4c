#!/usr/bin/env python3
"""Prepares the pages for MkDocs, and checks the site that it built.

usage: stage_site.py stage FOLDER       copies the pages, and what they link to, into FOLDER/pages
       stage_site.py equations FOLDER   TeX in FOLDER/site becomes MathML, which browsers draw without a program
       stage_site.py check FOLDER       every link and picture of FOLDER/site leads to a file; no page loads
                                        anything from a network; no TeX is left

The pages are written for GitHub. Python-Markdown wants a blank line before lists and around equations, and
has no pages for folders: both are mended in the copy, and folders get an index of the titles of their pages.
"""
import html
import html.parser
import pathlib
import re
import shutil
import sys
import urllib.parse

ROOT = pathlib.Path(__file__).resolve().parents[1]
PAGES = ["*.md", "docs/*.md", "docs/*/*.md", "scenes/*.md", "scenes/*/*.md"]
STYLE = """.equation { display: flex; align-items: center; margin: 1em 0; }
.equation math { flex: 1; overflow-x: auto; overflow-y: hidden; }
math [mathvariant^="bold"] { font-weight: bold; text-transform: none; }
math [mathvariant="bold"], math [mathvariant="sans-serif"] { font-style: normal; }
math [mathvariant="sans-serif"] { font-family: sans-serif; text-transform: none; }
.md-grid { max-width: 80rem; }
.md-typeset pre > code { font-size: 0.72em; }
.md-typeset td:first-child code { white-space: nowrap; }
"""
TEX = re.compile(r'<(span|div) class="arithmatex">\s*\\[(\[](.*?)\\[)\]]\s*</\1>', re.S)
TAG = re.compile(r"\\tag\{([^}]*)\}")
LINK = re.compile(r"(\]\()([^)\s#]+)([^)\s]*\))")


def title(page):
    return re.search(r"^# (.*)$", page.read_text(), re.M).group(1)


def index(folder, name):
    """A page for a folder without a README."""
    lines = [f"# {name}", "", "| | status |", "|---|---|"]
    for page in sorted(folder.glob("*.md")):
        status = re.search(r"^Status: ([^.:\n]*)", page.read_text(), re.M)
        lines.append(f"| [{title(page)}]({page.name}) | {status.group(1) if status else ''} |")
    return "\n".join(lines) + "\n"


def blank_lines(text):
    out, fence, equation, ended = [], False, False, False
    for line in text.splitlines():
        before = out[-1] if out else ""
        fence ^= line.strip().startswith("```")
        item = re.match(r"([-*]|\d+\.) ", line) and not re.match(r"\s*([-*]|\d+\.) |\s+", before)
        table = line.startswith("|") and not before.startswith("|")
        opens = line.startswith("$$") and not equation
        if not fence and before and (item or table or opens or ended):
            out.append("")
        out.append(line)
        was = equation
        equation ^= not fence and line.count("$$") % 2 == 1
        ended = not fence and not equation and (was or line.startswith("$$")) and line.rstrip().endswith("$$")
    return "\n".join(out) + "\n"


def links(text, page):
    """Links to folders go to their index; files that are no pages are copied beside."""
    copied = []

    def mend(match):
        target = match.group(2)
        path = (page.parent / urllib.parse.unquote(target)).resolve()
        if re.match(r"[a-z]+:", target) or not path.is_relative_to(ROOT):
            return match.group(0)
        if path.is_dir():
            return match.group(1) + target.rstrip("/") + "/README.md" + match.group(3)
        if path.suffix != ".md" and path.exists():
            copied.append(path)
        return match.group(0)

    return LINK.sub(mend, text), copied


def stage(folder):
    pages = folder / "pages"
    shutil.rmtree(pages, ignore_errors=True)
    for page in sorted(p for pattern in PAGES for p in ROOT.glob(pattern)):
        text, copied = links(page.read_text(), page)
        for path in [page, *copied]:
            (pages / path.relative_to(ROOT)).parent.mkdir(parents=True, exist_ok=True)
        for path in copied:
            shutil.copy(path, pages / path.relative_to(ROOT))
        (pages / page.relative_to(ROOT)).write_text(blank_lines(text))
    for name in ("theory", "decisions"):
        if not (ROOT / "docs" / name / "README.md").exists():
            (pages / "docs" / name / "README.md").write_text(index(ROOT / "docs" / name, name.capitalize()))
    (pages / "style.css").write_text(STYLE)
    shutil.copy(ROOT / "tools/mkdocs.yml", folder / "mkdocs.yml")


def mathml(match):
    from latex2mathml.converter import convert      # of docs/requirements.txt; the other steps do without it
    tex, block = html.unescape(match.group(2)), match.group(1) == "div"
    drawn = convert(TAG.sub("", tex), display="block" if block else "inline")
    if not block:
        return drawn
    return f'<div class="equation">{drawn}' + "".join(f"<span>({tag})</span>" for tag in TAG.findall(tex)) + "</div>"


def write_equations(folder):
    count = 0
    for page in (folder / "site").rglob("*.html"):
        text, found = TEX.subn(mathml, page.read_text())
        if found:
            page.write_text(text)
        count += found
    print(f"{count} equations")
    return 0 if count > 300 else 1


class Links(html.parser.HTMLParser):
    def __init__(self):
        super().__init__()
        self.found, self.names, self.loaded = [], set(), []

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        self.names.update(value for key, value in attributes if key in ("id", "name"))
        self.loaded += [values[key] for key in ("href", "src") if re.match(r"(https?:)?//", values.get(key) or "") and
                        (tag in ("script", "img", "iframe") or values.get("rel") == "stylesheet")]
        self.found += [values[key] for key in ("href", "src") if values.get(key)]


def check(folder):
    site, parsed, dead, count = folder / "site", {}, 0, 0
    for page in site.rglob("*.html"):
        parsed[page.resolve()] = reader = Links()
        text = page.read_text()
        reader.feed(text)
        faults = [f"loads {link}" for link in reader.loaded] + ["TeX is left"]*('"arithmatex"' in text)
        for fault in faults:
            print(f"{page.relative_to(site)}: {fault}")
        dead += len(faults)
    for page, reader in parsed.items():
        if page.name == "404.html":
            continue                                # its links count from the root of a server
        for link in reader.found:
            target, _, part = link.partition("#")
            if re.match(r"[a-z]+:|//", link):
                continue
            count += 1
            path = (page.parent / urllib.parse.unquote(target)).resolve() if target else page
            part = urllib.parse.unquote(part)
            if not path.exists() or (part and path in parsed and part not in parsed[path].names and
                                     not part.startswith("__")):
                print(f"{page.relative_to(site.resolve())}: dead link: {link}")
                dead += 1
    print(f"{len(parsed)} pages, {count} links, {dead} dead")
    return 1 if dead or count < 1000 else 0


if __name__ == "__main__":
    steps = {"stage": stage, "equations": write_equations, "check": check}
    if len(sys.argv) != 3 or sys.argv[1] not in steps:
        sys.exit(__doc__)
    sys.exit(steps[sys.argv[1]](pathlib.Path(sys.argv[2]).resolve()))
