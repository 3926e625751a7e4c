"""Pages of validation in a small tree with a program that only pretends: their age, and runs that go on."""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

PHYSICS = pathlib.Path(__file__).resolve().parents[1] / "physics"
TREE = {
    "src/world/methods.def": "METHOD(dfsph)\nMETHOD(mlsmpm)\n",
    "test/golden/hashes.csv": "scene,state,files,added\ndam,aa,1,0\npipe,gg,1,0\nblock,bb,2,0\n",
    "test/golden/dam.json": "{}",
    "test/golden/pipe.json": '{ "outlets": [] }',
    "test/golden/block.json": '{ "method": "mlsmpm" }',
    "test/physics/coarse.csv": "case,figure\n",
    "test/physics/meanings.csv": 'case,meaning\nwave,"Waves are {period, deviation|-%} % too short."\n',
    "test/physics/wave/scene.json": "{}",
    "test/physics/wave/run.py": """
import pathlib, sys
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case
case = Case("wave", "Wave")
case.run("first")
case.run("second")
case.figure("period, deviation", -0.02, "within 0.01", False)
case.finish()
""",
    "test/physics/wave/page.md": "A wave.\n\n- **Judged.** Its period.\n",
    # run SCENE --out DIR ... | resume DIR ...: notes its words in calls; stops with a checkpoint where told
    "program": """#!/bin/bash
echo "$1 $(basename "$2")" >> calls
[ "$1" = run ] && out=$4 || out=$2
mkdir -p "$out/checkpoints"
echo '{ "method": "dfsph" }' > "$out/resolved.json"
[ "$1" = run ] && [ "$(basename "$out")" = "$STOP" ] && touch "$out/checkpoints/1.json" && exit 130
exit 0
""",
}
failed = 0


def expect(text, ok):
    global failed
    if not ok:
        print(f"validation: {text}")
        failed += 1


def read(root):
    return (root / "docs/validation/wave.md").read_text()


def make(root, stop=""):
    """One start of the case; what it asked of the program, and its exit code."""
    calls = root / "calls"
    calls.unlink(missing_ok=True)
    done = subprocess.run([sys.executable, root / "test/physics/wave/run.py", "--tobiuo", root / "program", "--size",
                           "reference", "--commit", "abc", "--machine", "M, 2 cores", "--out", root / "runs", "--resume"],
                          cwd=root, env={"STOP": stop, "PATH": "/usr/bin:/bin"}, capture_output=True, text=True)
    if "Traceback" in done.stderr:
        print(done.stderr)
    return calls.read_text().split("\n")[:-1] if calls.exists() else [], done.returncode


def tool(root, what):
    done = subprocess.run([sys.executable, root / "test/physics/validation.py", what], capture_output=True, text=True)
    return done.stdout + done.stderr, done.returncode


def change(root, name, old, new):
    path = root / name
    path.write_text(path.read_text().replace(old, new))


def check_resume(root):
    expect("no page is to be made", tool(root, "list")[0].startswith("wave\n1 of 1 pages"))
    expect("stopped in the second run", make(root, "second")[0] == ["run scene.json"]*2)
    expect("no page after a stop", not (root / "docs/validation/wave.md").exists())
    expect("first kept, second goes on", make(root) == (["resume second"], 1))
    expect("runs are removed at the end", not (root / "runs").exists())
    make(root, "second")
    change(root, "test/physics/wave/scene.json", "{}", "{ }")
    expect("another scene: all anew", make(root)[0] == ["run scene.json"]*2)


def check_age(root):
    made = re.search(r"Made by commit abc, program \w{12}, in [\d.]+ min on M, 2 cores\. Of case \w{12}, "
                     r"method dfsph \w{12}\. ", " ".join(read(root).split()))
    expect("a page says how it was made", made)
    expect("a new page is not old", "older" not in read(root) and "to be made" in tool(root, "list")[0])
    expect("nothing to do", tool(root, "list")[0].strip().startswith("0 of 1 pages"))
    change(root, "docs/validation/wave.md", " cores. Of", " cores.\nOf")      # a longer name of the machine
    expect("a line ends behind the machine", tool(root, "list")[0].strip().startswith("0 of 1 pages"))
    change(root, "test/golden/hashes.csv", "gg", "hh")
    expect("results of a part that the case has not", tool(root, "list")[0].strip().startswith("0 of 1 pages"))
    change(root, "test/golden/hashes.csv", "bb", "cc")
    expect("results of another method", tool(root, "list")[0].strip().startswith("0 of 1 pages"))
    (root / "test/golden/later.json").write_text("{}")
    change(root, "test/golden/hashes.csv", "block", "later,ee,3,1\nblock")
    expect("a golden scene that came later", tool(root, "list")[0].strip().startswith("0 of 1 pages"))
    change(root, "test/golden/hashes.csv", "aa", "ff")
    text, code = tool(root, "check")
    expect("only a warning", code == 0 and "warning: 1 pages" in text and "1 of 1 pages are to be made anew: 0.0 hours" in text)
    tool(root, "mark")
    expect("the page says so", "\n> **This page is older than its method dfsph.**\n" in read(root))
    expect("so does the index", "| abc, older |" in (root / "docs/validation/README.md").read_text())
    change(root, "test/golden/hashes.csv", "ff", "aa")
    tool(root, "mark")
    expect("taken back", "older" not in read(root))
    change(root, "test/physics/wave/page.md", "A wave.", "The wave.")
    text, code = tool(root, "check")
    expect("another text fails", code == 1 and "its text is not that of test/physics/wave/page.md" in text)
    tool(root, "mark")
    expect("mark writes it", "\n\nThe wave.\n\n- **Judged.** Its period.\n\n| figure" in read(root))
    expect("a text makes no page old", "older" not in read(root) and tool(root, "check")[1] == 0)
    change(root, "test/physics/wave/run.py", '"Wave"', '"Waves"')
    tool(root, "mark")
    expect("a case that changed", "\n> **This page is older than its case.**\n" in read(root))
    (root / "test/physics/wave/scene.json").write_text('{ "outlets": [] }')
    make(root)
    expect("made anew with an outlet", "older" not in read(root))
    change(root, "test/golden/hashes.csv", "hh", "gg")
    tool(root, "mark")
    expect("results of a part that it has", "\n> **This page is older than its method dfsph.**\n" in read(root))


def check_meanings(root):
    index = root / "docs/validation/README.md"
    expect("a sentence with its figure", "| Waves are 2 % too short. | 0 of 1 |" in index.read_text())
    change(root, "test/physics/meanings.csv", "|-%", "|+%")
    text, code = tool(root, "check")
    expect("a sentence of another sign", code == 1 and "tells of another sign" in text)
    tool(root, "mark")
    expect("it is left out", "| See the page. |" in index.read_text())
    change(root, "test/physics/meanings.csv", "period, deviation", "height")
    expect("a figure that is not there", "0 figures are 'height'" in tool(root, "check")[0])


def main():
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name, text in TREE.items():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_text(text)
        (root / "program").chmod(0o755)
        for name in ("harness.py", "plots.py", "validation.py"):
            shutil.copy(PHYSICS / name, root / "test/physics" / name)
        check_resume(root)
        check_age(root)
        check_meanings(root)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
