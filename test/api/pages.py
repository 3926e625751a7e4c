#!/usr/bin/env python3
"""The pages are true: what the program writes is up to date, examples and commands work, links lead somewhere.

usage: pages.py tables PROGRAM | scripts PROGRAM | readme PROGRAM | commands PROGRAM | links
  tables   docs/tables.md is what `tobiuo describe tables` prints, and names the columns of a real run
  scripts  each scene of docs/scripts.md, with the script beside it, and each scene of the other pages
           in docs/ that names no file is accepted and runs its first steps
  readme   the scene in README is scenes/ball_drop; its commands are accepted (check for run)
  commands every `tobiuo run` and `tobiuo check` of a scene of the tree, on any page, is accepted
  links    every relative link and picture of every page leads to a file, and to a heading of it; the
           gallery has every scene
"""
import csv
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import urllib.parse

ROOT = pathlib.Path(os.environ.get("TOBIUO_SOURCE", pathlib.Path(__file__).resolve().parents[2]))
PAGES = ["*.md", "docs/*.md", "docs/*/*.md", "scenes/*.md", "scenes/*/*.md"]
SCRIPT_PAGES = ["docs/scripts.md", "docs/scripts.ja.md"]


def call(program, *arguments):
    return subprocess.run([program, *arguments], capture_output=True, text=True)


def expand(row):
    """`position_x`, `_y`, `_z`: the names of a row of docs/tables.md."""
    names = re.findall(r"`([^`]*)`", row.split("|")[1])
    stem = names[0].rsplit("_", 1)[0]
    return [names[0]] + [stem + name for name in names[1:]]


def section(page, heading):
    return page.split(f"\n## {heading}\n")[1].split("\n## ")[0]


def check_tables(program):
    failed = 0
    if call(program, "describe", "tables").stdout != (ROOT / "docs/tables.md").read_text():
        print("docs/tables.md is out of date: tobiuo describe tables > docs/tables.md")
        failed += 1
    scene = write_scripts("docs/scripts.md")[0]
    run = call(program, "run", str(scene), "--quiet", "--force", "--until", "0.05", "--out", "tables")
    if run.returncode != 0:
        print(run.stderr)
        return 1
    for path in ("docs/tables.md", "docs/tables.ja.md"):
        page = (ROOT / path).read_text()
        for table in ("history.csv", "bodies.csv"):
            rows = [line for line in section(page, table).splitlines() if line.startswith("| `")]
            told = [name for row in rows for name in expand(row)]
            with open(f"tables/{table}", newline="") as file:
                written = next(csv.reader(file))
            of_some = ("porous_work", "buoyancy_work", "air_work", "field_work", "roll", "pitch", "yaw")
            told = [name for name in told if name not in of_some and not name.startswith("nest_")]
            if told != written:
                print(f"{path}: columns of {table}:", set(told) ^ set(written))
                failed += 1
    return failed


def write_scripts(path):
    """The scenes of a page with their scripts, each in a folder of its own below scenes/."""
    text = (ROOT / path).read_text()
    found = re.findall(r"```jsonc\n(.*?)```.*?```lua\n(.*?)```", text, re.S)
    scenes = []
    shutil.rmtree("scenes", ignore_errors=True)
    for number, (scene, script) in enumerate(found):
        folder = pathlib.Path("scenes") / f"example{number}"
        folder.mkdir(parents=True)
        name = re.search(r'"script": "([^"]*)"', scene).group(1)
        (folder / "scene.json").write_text(scene)
        (folder / name).write_text(script)
        scenes.append(folder)
    return scenes


def write_scenes(page):
    """The whole scenes of a page that need no other file; a piece of a scene has no domain."""
    blocks = re.findall(r"^```(?:jsonc)?\n(\{\n.*?)^```", page.read_text(), re.S | re.M)
    scenes = []
    for number, scene in enumerate(blocks):
        if '"domain"' in scene and not re.search(r'"(mesh|file|script)":', scene):
            scenes.append(pathlib.Path(f"{page.stem}{number}.json"))
            scenes[-1].write_text(scene)
    return scenes


def check_scripts(program):
    failed = count = 0
    others = [page for page in sorted(ROOT.glob("docs/*.md")) if str(page.relative_to(ROOT)) not in SCRIPT_PAGES]
    for path in SCRIPT_PAGES + others:
        for scene in write_scripts(path) if path in SCRIPT_PAGES else write_scenes(path):
            count += 1
            run = call(program, "run", str(scene), "--quiet", "--force", "--until", "0.01", "--out", "run")
            if run.returncode != 0:
                print(f"{path}: {scene}:", run.stderr)
                failed += 1
    print(f"{count} examples, {failed} failed")
    return failed or count < 12


def parse(text):
    """A scene: JSON with comments; strings may hold // and #."""
    return json.loads(re.sub(r'("(?:\\.|[^"\\])*")|(?:#|//)[^\n]*', lambda m: m.group(1) or "", text))


def check_readme(program):
    failed = 0
    scene = parse((ROOT / "scenes/ball_drop/scene.json").read_text())
    for path in ("README.md", "README.ja.md"):
        text = (ROOT / path).read_text()
        if parse(re.search(r"```jsonc\n(.*?)```", text, re.S).group(1)) != scene:
            print(f"{path}: the scene is not scenes/ball_drop")
            failed += 1
        shutil.rmtree("my_ball", ignore_errors=True)
        commands = re.findall(r"^tobiuo (new|check|run|describe) ([^#\n]*)", text, re.M)
        for command, rest in commands:
            words = re.sub(r"--frames|--window|--movie \S+|--slow \S+|--surface \S+|--out \S+", "", rest).split()
            result = call(program, "check" if command == "run" else command, *words)
            if result.returncode != 0:
                print(f"{path}: tobiuo {command} {rest}:", result.stderr)
                failed += 1
        for name in re.findall(r"\./test\.sh --slow (\w+)", text):
            if not (ROOT / f"test/physics/{name}/run.py").exists():
                print(f"{path}: there is no case {name}")
                failed += 1
        failed += len(commands) < 4
    return failed


def find_commands():
    """(page, words) of each `tobiuo run SCENE ...` whose scene is in the tree, without what check does not know."""
    seen = set()
    for page in sorted(p for pattern in PAGES for p in ROOT.glob(pattern)):
        if page.parent.name == "validation":
            continue                                # written with the commands that were run
        text = page.read_text().replace("\\\n", " ")
        for line in re.findall(r"(?:^|`) *(?:build/release/)?tobiuo (?:run|check) ([^`\n]*)", text, re.M):
            known = re.sub(r"--frames|--window|--movie \S+|--slow \S+|--surface \S+|--force|--quiet|--out \S+|--threads \S+",
                           "", shlex.join(shlex.split(line, comments=True)))
            words = shlex.split(known)
            if words and (ROOT / words[0]).exists() and tuple(words) not in seen:
                seen.add(tuple(words))
                yield page, words


def check_commands(program):
    """check in the place of run, for no time: it places bodies and particles as a run does. A control program is
    first called by a step."""
    failed = count = 0
    for page, words in find_commands():
        scene = ROOT / words[0] / "scene.json"
        steps = len(words) == 1 and scene.exists() and '"control"' in scene.read_text()
        end = ["--until", "1e-9"] if steps else ["--set", "end_time=0"]
        result = subprocess.run([program, "check", *words, *end], capture_output=True, text=True, cwd=ROOT)
        count += 1
        if result.returncode != 0:
            print(f"{page.relative_to(ROOT)}: tobiuo run {shlex.join(words)}:", result.stderr)
            failed += 1
    print(f"{count} commands, {failed} failed")
    return failed or count < 30


def anchor(heading):
    """As GitHub and MkDocs make it from a heading."""
    text = re.sub(r"[`*]|\[([^]]*)\]\([^)]*\)", r"\1", heading).strip().lower()
    return re.sub(r"[^\w\- ]", "", text).replace(" ", "-")


def without_code(text):
    return re.sub(r"`[^`\n]*`", "", re.sub(r"^ *```.*?^ *```", "", text, flags=re.S | re.M))


def check_links():
    failed = count = 0
    for page in sorted(p for pattern in PAGES for p in ROOT.glob(pattern)):
        for target in re.findall(r"\]\(([^)\s]+)\)", without_code(page.read_text())):
            if re.match(r"[a-z]+:", target):
                continue
            count += 1
            name, _, part = target.partition("#")
            file = page.parent / urllib.parse.unquote(name) if name else page
            headings = re.findall(r"^#+ (.*)$", file.read_text(), re.M) if part and file.suffix == ".md" else []
            if not file.exists() or (part and part not in map(anchor, headings)):
                print(f"{page.relative_to(ROOT)}: dead link: {target}")
                failed += 1
    gallery = (ROOT / "docs/gallery/README.md").read_text()
    for scene in sorted(path.parent.name for path in ROOT.glob("scenes/*/scene.json")):
        if f"(../../scenes/{scene}/README.md)" not in gallery:
            print(f"docs/gallery/README.md: there is no picture of {scene}")
            failed += 1
    print(f"{count} links, {failed} dead")
    return failed or count < 100


def main():
    what = sys.argv[1] if len(sys.argv) > 1 else ""
    checks = {"tables": check_tables, "scripts": check_scripts, "readme": check_readme,
              "commands": check_commands}
    if what == "links":
        return 1 if check_links() else 0
    if what not in checks or len(sys.argv) != 3:
        sys.exit(__doc__)
    program = os.path.abspath(sys.argv[2])
    with tempfile.TemporaryDirectory() as folder:       # the checks write and delete scenes/ where they are
        os.chdir(folder)
        return 1 if checks[what](program) else 0


if __name__ == "__main__":
    sys.exit(main())
