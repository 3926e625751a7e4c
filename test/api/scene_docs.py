#!/usr/bin/env python3
"""The page and the schema of scenes: up to date, and of one mind with the reader.

usage: scene_docs.py page PROGRAM | schema LIBRARY
  page    docs/scene.md and docs/scene.schema.json are what the program prints; the page's example runs;
          what the tutorials run is accepted
  schema  shipped scenes follow the schema; a damaged scene is refused by the schema exactly when the
          reader refuses it for a key, a type or a range (needs python3-jsonschema, or else answers 77)
"""
import copy
import ctypes
import itertools
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(os.environ.get("TOBIUO_SOURCE", pathlib.Path(__file__).parents[2]))
PAGES = {"scene": "docs/scene.md", "schema": "docs/scene.schema.json"}
# What the reader sees and a schema cannot: rules between values, names, files, 2-D, the world itself.
READER_ONLY = re.compile(
    r"must be greater|is zero|already the name|cannot find|has 2 entries|reaches from|overlaps|"
    r"must not be above|periodic on one side|more than \d+ outputs|the domain has only|"
    r"params belong|in a 2-D scene|not no-slip|along the side|the domain reaches|"
    r"there is no (column|body|probe) |without one the view fits|is for a vessel|"
    r"without one nothing is cut off|is not below picture.max")


def call(program, *arguments):
    return subprocess.run([program, *arguments], capture_output=True, text=True)


def without_comments(text):
    """Comments blanked; strings may hold # and //."""
    return re.sub(r'("(?:\\.|[^"\\])*")|(?:#|//)[^\n]*', lambda m: m.group(1) or "", text)


def write_example(folder):
    """The example of the page, its files as the page names them."""
    page = (ROOT / PAGES["scene"]).read_text()
    mesh = re.search(r"```\n(v .*?)```", page, re.S).group(1)
    scene = re.search(r"```jsonc\n(.*?)```", page, re.S).group(1)
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    (folder / "box.obj").write_text(mesh)
    (folder / "scene.json").write_text(scene)
    return folder / "scene.json"


def check_tutorials(program):
    """Their commands, with `check` for `run`; a folder that the reader copies is what it is copied from."""
    failed = count = 0
    for path in ("docs/tutorial.md", "docs/tutorial.ja.md"):
        text = (ROOT / path).read_text().replace("\\\n", " ")
        copies = dict((b, a) for a, b in re.findall(r"^cp -r (\S+) (\S+)$", text, re.M))
        for scene, line in re.findall(r"^build/release/tobiuo run (\S+) (.*)$", text, re.M):
            words = re.sub(r"--frames|--out \S+", "", line).split()
            result = call(program, "check", str(ROOT / copies.get(scene, scene)), *words)
            count += 1
            if result.returncode != 0:
                print(f"{path}: the command does not work:", scene, line, result.stderr)
                failed += 1
    return failed or count < 8


def check_page(program):
    failed = 0
    for topic, path in PAGES.items():
        file = ROOT / path
        if not file.exists() or call(program, "describe", topic).stdout != file.read_text():
            print(f"{path} is out of date: tobiuo describe {topic} > {path}")
            failed += 1
    scene = write_example(pathlib.Path("example"))
    result = call(program, "run", str(scene), "--quiet", "--force", "--until", "0.04", "--out", "example/out")
    if result.returncode != 0 or not pathlib.Path("example/out/fluid/fluid_000002.vtu").exists():
        print("the page's example does not run:", result.stderr)
        failed += 1
    page = (ROOT / PAGES["scene"]).read_text()
    commands = re.findall(r"^tobiuo run scene.json (.*)$", page, re.M)
    for line in commands:
        result = call(program, "check", str(scene), *(word.strip("'") for word in re.split(r" (?=--|')|(?<=--set) ", line)))
        if result.returncode != 0:
            print("the page's command does not work:", line, result.stderr)
            failed += 1
    print(f"{len(PAGES)} files, 1 example, {len(commands)} commands; {failed} failed")
    return failed or not commands or check_tutorials(program)


class Library:
    """The few calls of the shared library that a reader of scenes needs."""

    def __init__(self, path):
        self.c = ctypes.CDLL(path)
        for name in ("describe", "resolved"):
            getattr(self.c, "tobi_scene_" + name).restype = ctypes.c_void_p
        self.c.tobi_report_line.restype = ctypes.c_char_p
        self.c.tobi_report_line.argtypes = [ctypes.c_void_p, ctypes.c_int]
        self.c.tobi_report_free.argtypes = self.c.tobi_scene_free.argtypes = [ctypes.c_void_p]
        self.c.tobi_scene_resolved.argtypes = [ctypes.c_void_p]

    def describe(self, topic):
        return ctypes.string_at(self.c.tobi_scene_describe(topic.encode())).decode()

    def load(self, path):
        """(the lines of the report, the scene with every default or None)"""
        scene, report = ctypes.c_void_p(), ctypes.c_void_p()
        self.c.tobi_scene_load(str(path).encode(), None, ctypes.byref(scene), ctypes.byref(report), None)
        lines = [self.c.tobi_report_line(report, i).decode() for i in range(self.c.tobi_report_count(report))]
        resolved = ctypes.string_at(self.c.tobi_scene_resolved(scene)).decode() if scene else None
        self.c.tobi_report_free(report)
        self.c.tobi_scene_free(scene)
        return lines, resolved and json.loads(resolved)


def full_scene(library):
    """A scene that gives every key: the example with its defaults made explicit, and every motion."""
    scene = library.load(write_example(pathlib.Path("full")))[1]
    pathlib.Path("full/stay.lua").write_text("function place(t) return 0, 0, 0 end\n")
    motions = [
        {"script": "stay.lua", "params": {"any": 1}},
        {"translation": {"velocity": [0, 0, 0.1]}},
        {"rotation": {"centre": [0, 0, 0], "axis": [0, 0, 1], "rate": 5}},
    ]
    for i, motion in enumerate(motions):
        body = copy.deepcopy(scene["bodies"][0])
        body.update(name=f"body{i}", motion=motion)
        scene["bodies"].append(body)
    scene["fluids"][0]["fill"].append(
        {"mesh": "box.obj", "scale": 0.02, "translation": [0.1, 0.05, 0.2], "velocity": [0, 0, 0]})
    pathlib.Path("full/flow.lua").write_text("function velocity(x, y, z) return 0, 0, 0 end\n")
    scene["fluids"][0]["fill"][0]["flow"] = {"script": "flow.lua", "params": {"any": 1}}
    scene["probes"] = [{"name": "gauge", "kind": "level", "position": [0.1, 0.05, 0.1]}]
    rest = {"file": "box.obj", "x": "t [s]", "y": "F/m, g", "x_scale": 0.001, "y_scale": -1, "x_offset": 0.5, "y_offset": 1, "label": "a, b"}
    scene["references"] = [{"body": "body0", "column": "position_x", **rest},
                           {"probe": "gauge", "column": "level", **rest}]
    scene["$schema"] = "scene.schema.json"
    return scene


def places(value, path=()):
    """Every place in a scene; what is below params is the script's own."""
    yield path
    if path and path[-1] == "params":
        return
    members = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, member in members:
        yield from places(member, path + (key,))


def at(scene, path):
    for key in path:
        scene = scene[key]
    return scene


def without_scripts(scene):
    """The same without scripts: each is a process of its own, at every load."""
    scene = copy.deepcopy(scene)
    scene["bodies"] = [b for b in scene["bodies"] if "script" not in (b.get("motion") or {})]
    for fill in scene["fluids"][0]["fill"]:
        fill.pop("flow", None)
    return scene


def is_of_script(scene, path):
    return "flow" in path or path[:1] == ("bodies",) and path[2:3] == ("motion",) and \
        "script" in scene["bodies"][path[1]]["motion"]


def damage(scene, counts=lambda path: True):
    """(what was done, below which key of the scene, the damaged scene), one damage each."""
    for path in list(places(scene)):
        if path == ("$schema",) or not counts(path):
            continue
        old = at(scene, path)
        if isinstance(old, dict) and path[-1:] != ("params",):
            new = copy.deepcopy(scene)
            at(new, path)["nonsense"] = 1
            yield f"{path} + unknown key", path[:1], new
        if not path:
            continue
        if isinstance(path[-1], str):
            new = copy.deepcopy(scene)
            del at(new, path[:-1])[path[-1]]
            yield f"{path} removed", path[:1], new
        if isinstance(path[-1], int) and path[-1] > 0:
            continue                # one entry of a list stands for all
        others = ["no such word", None, {}, [], -1, 1e300]
        for other in others:
            if type(other) is type(old) and not isinstance(old, (str, int, float)):
                continue
            if path[-1] in ("name", "mesh", "script", "fields") and isinstance(other, str):
                continue            # a good name, a file that is not there, a list as one text
            if path[-1] in ("domain", "spacing", "end_time", "interval", "time_step") and other == 1e300:
                continue
            new = copy.deepcopy(scene)
            at(new, path[:-1])[path[-1]] = other
            yield f"{path} = {other!r}", path[:1], new


def check_schema(library):
    try:
        import jsonschema
    except ImportError:
        print("python3-jsonschema is missing")
        return 77
    schema = json.loads(library.describe("schema"))
    jsonschema.Draft7Validator.check_schema(schema)
    validator = jsonschema.Draft7Validator(schema)
    parts = schema["properties"]
    whole = jsonschema.Draft7Validator({**schema, "properties": dict.fromkeys(parts, {})})

    def accepts(damaged, keys):         # as validator.is_valid, without the keys that are whole
        return whole.is_valid(damaged) and all(validator.evolve(schema=parts[key]).is_valid(damaged[key])
                                               for key in keys if key in damaged)

    failed = shipped = refused = kept = 0
    for file in sorted((ROOT / "scenes").glob("*/*.json")):
        for error in validator.iter_errors(json.loads(without_comments(file.read_text()))):
            print(f"{file}: {error.message}")
            failed += 1
        shipped += 1
    scene = full_scene(library)
    for error in validator.iter_errors(scene):
        print("the full scene:", list(error.path), error.message)
        failed += 1
    plain = without_scripts(scene)
    for what, keys, damaged in itertools.chain(damage(plain), damage(scene, lambda p: is_of_script(scene, p))):
        pathlib.Path("full/damaged.json").write_text(json.dumps(damaged))
        lines = library.load("full/damaged.json")[0]
        reader = [line for line in lines if not READER_ONLY.search(line)]
        by_schema = not accepts(damaged, keys)
        refused += by_schema
        kept += not by_schema
        if by_schema != bool(reader) and not (by_schema and lines):
            print(f"{what}: the schema {'refuses' if by_schema else 'accepts'} it, the reader says",
                  (reader or lines or ["nothing"])[0])
            failed += 1
    print(f"{shipped} shipped scenes; {refused} damaged ones refused, {kept} still good; {failed} failed")
    return 1 if failed or shipped < 6 or refused < 300 or kept < 20 else 0


if __name__ == "__main__":
    if len(sys.argv) != 3 or sys.argv[1] not in ("page", "schema"):
        sys.exit(__doc__)
    tested = os.path.abspath(sys.argv[2])
    sys.exit(int(check_page(tested) if sys.argv[1] == "page" else check_schema(Library(tested))))
