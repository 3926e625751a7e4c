"""tools/translate_scene.py on a small page: what it writes, and each thing that it may say of a catalogue.

Answers 77 without python3-polib.
"""
import os
import pathlib
import subprocess
import sys
import tempfile

TOOL = pathlib.Path(__file__).resolve().parents[2] / "tools/translate_scene.py"
ENGLISH = """# Scenes

A tank
of water.

## `keys`

- One item,
  two lines.
- Another.

| key | type | unit | default | allowed | meaning |
|---|---|---|---|---|---|
| `a` | number | degrees | 3 | 0 to 8 degrees, or "none" | Wide \\| deep. |
| `b` | number | m | **required** | -1 to 1e6 m | Height of the side. |
| `c` | word |  | slip | slip, no-slip or open | Side. |

```jsonc
"a": 1,    // an angle

"b": 2     // m
```
"""
TEXTS = {
    "Scenes": "シーン", "A tank of water.": "水の\n水槽。", "One item, two lines.": "項目\n二行。", "Another.": "ほか。",
    "key": "キー", "type": "型", "unit": "単位", "default": "既定値", "allowed": "範囲", "meaning": "意味",
    "number": "数", "degrees": "度", "Wide \\| deep.": "広\n深 \\|", "**required**": "**必須**",
    "Height of the side.": "面の高さ", "word": "語", "Side.": "面", "an angle": "角度",
}
JAPANESE = """# シーン

水の
水槽。

## `keys`

- 項目
  二行。
- ほか。

| キー | 型 | 単位 | 既定値 | 範囲 | 意味 |
|---|---|---|---|---|---|
| `a` | 数 | 度 | 3 | 0～8度、または"none" | 広深 \\| |
| `b` | 数 | m | **必須** | -1～1e6 m | 面の高さ |
| `c` | 語 |  | slip | slip、no-slip、open | 面 |

```jsonc
"a": 1,    // 角度

"b": 2     // m
```
"""


class Tree:
    """A tree with the three files; counts what is not as expected."""

    def __init__(self, folder):
        self.docs = pathlib.Path(folder) / "docs"
        self.docs.mkdir()
        self.failed = 0
        self.write("scene.md", ENGLISH)
        self.write("scene.ja.po", 'msgid ""\nmsgstr "Content-Type: text/plain; charset=utf-8\\n"\n')

    def write(self, name, text):
        (self.docs / name).write_text(text, encoding="utf-8")

    def read(self, name):
        return (self.docs / name).read_text(encoding="utf-8")

    def expect(self, what, right, said):
        if not right:
            print(f"{what}: not as expected: {said}")
            self.failed += 1

    def run(self, mode, code, *words, environment=None):
        """Its exit code and the words that it must say."""
        arguments = [mode] if mode else []
        run = subprocess.run([sys.executable, TOOL, *arguments, self.docs.parent], capture_output=True, text=True,
                             env={**os.environ, **(environment or {})})
        for word in words:
            self.expect(f"{mode or 'page'}, {word!r}", word in run.stdout + run.stderr, run.stdout + run.stderr)
        self.expect(f"{mode or 'page'}, exit code {code}", run.returncode == code, run.stdout + run.stderr)


def fill(tree, polib):
    """What a developer does after --update."""
    path = str(tree.docs / "scene.ja.po")
    catalogue = polib.pofile(path)
    for entry in catalogue:
        entry.msgstr = TEXTS[entry.msgid]
    catalogue.save(path)


def check_first_page(tree, polib):
    tree.run("", 1, 'a text is new: run tools/translate_scene.py --update, write its Japanese: "Scenes"')
    tree.expect("a page without Japanese", "A tank of water." in tree.read("scene.ja.md"), tree.read("scene.ja.md"))
    tree.run("--update", 1, f"{len(TEXTS)} texts added, 0 taken out", 'a text has no Japanese; write it: "an angle"')
    fill(tree, polib)
    tree.run("--check", 1, "docs/scene.ja.md is out of date: run tools/translate_scene.py", "1 faults")
    tree.run("", 0, f"{len(TEXTS)} texts, 0 faults")
    tree.expect("the page", tree.read("scene.ja.md") == JAPANESE, tree.read("scene.ja.md"))
    tree.run("--check", 0, "0 faults")


def check_changes(tree, polib):
    """Another line break is no change; another word is one, and the old Japanese is shown again."""
    tree.write("scene.md", ENGLISH.replace("A tank\nof", "A tank of"))
    tree.run("--check", 0)
    tree.write("scene.md", ENGLISH.replace("Height of", "The height of"))
    tree.run("--check", 1, 'is new: run tools/translate_scene.py --update, write its Japanese: "The height of the side."',
             'is no longer used; run tools/translate_scene.py --update: "Height of the side."')
    tree.run("--update", 1, "1 texts added, 1 taken out",
             'a text has changed; correct its Japanese and delete its line "#, fuzzy": "The height of the side."')
    catalogue = tree.read("scene.ja.po")
    tree.expect("the old texts", '#| msgid "Height of the side."' in catalogue and "面の高さ" in catalogue, catalogue)
    tree.write("scene.ja.po", catalogue.replace("#, fuzzy\n", ""))
    tree.run("--check", 0)
    tree.write("scene.md", ENGLISH.replace("-1 to", "-2 to"))
    tree.run("--update", 1, "fuzzy")
    tree.expect("a number without text", "-2～1e6 m" in tree.read("scene.ja.md"), tree.read("scene.ja.md"))


def check_refusals(tree):
    tree.write("scene.ja.po", 'msgid "a"b"\nmsgstr ""\n')
    tree.run("--check", 1, "docs/scene.ja.po: ", "unescaped double quote")
    tree.run("--nonsense", 1, "usage: translate_scene.py")
    tree.write("polib.py", "raise ImportError\n")
    tree.run("--check", 77, "python3-polib is missing: tools/install_packages.sh --test",
             environment={"PYTHONPATH": str(tree.docs)})


def main():
    try:
        import polib
    except ImportError:
        print("python3-polib is missing")
        return 77
    with tempfile.TemporaryDirectory() as folder:
        tree = Tree(folder)
        check_first_page(tree, polib)
        check_changes(tree, polib)
        check_refusals(tree)
    print(f"{tree.failed} failed")
    return 1 if tree.failed else 0


if __name__ == "__main__":
    sys.exit(main())
