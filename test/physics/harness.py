"""What every physics case needs: runs the program, reads its files, prints and records figures.

A case is a file test/physics/<case>/run.py with a Case; page.md beside it is the text of its page. It prints each figure with its goal, met or
MISS, and the exit code follows them and case.hold(): statements with a tolerance of their own, each
justified where it stands. Figures for which the smoke size is too coarse are in coarse.csv (case, and
text with * for numbers that are measured): they are judged at reference size only. There the rows and the
plot go to docs/validation/<case>.{md,svg} (validation.py). A case with `methods` is run by each of these too,
their rows stand below with the method's name before them. Only the standard library is needed.
"""
import argparse
import array
import csv
import fnmatch
import hashlib
import json
import math
import os
import pathlib
import platform
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import time
import zlib

import plots
import validation

ROOT = pathlib.Path(__file__).resolve().parents[2]
VALIDATION = ROOT / "docs" / "validation"
INTERRUPTED = 130
TYPES = {"Float32": "f", "Float64": "d", "Int32": "i", "Int64": "q", "UInt8": "B"}


class Case:
    def __init__(self, name, title, methods=()):
        self.name, self.title, self.others = name, title, methods
        parser = argparse.ArgumentParser(description=title)
        parser.add_argument("--tobiuo", required=True, help="the program")
        parser.add_argument("--size", choices=["smoke", "reference"], default="smoke")
        parser.add_argument("--out", help="folder for the results (a temporary one, removed at the end)")
        parser.add_argument("--commit", help="for the page (default: that of the clone)")
        parser.add_argument("--machine", help="for the page (default: this one)")
        parser.add_argument("--threads", type=int, help="default: 1 at smoke size, all cores at reference size")
        parser.add_argument("--reference", default=os.environ.get("TOBIUO_REFERENCE"), metavar="DIR",
                            help="folder of published reference data (default: $TOBIUO_REFERENCE; without "
                                 "one, the cases use the few values that stand in them)")
        parser.add_argument("--resume", action="store_true",
                            help="with --out: finished runs there are taken, interrupted ones go on; removed at the end")
        parser.add_argument("--method", help="computes the fluids by this method; no page")
        parser.add_argument("--rows", metavar="FILE", help="writes the figures as JSON")
        self.args = parser.parse_args()
        if self.args.reference and not os.path.isdir(self.args.reference):
            parser.error(f"--reference: there is no folder {self.args.reference}")
        self.program = os.path.abspath(self.args.tobiuo)
        if self.args.threads is None:
            self.args.threads = 1 if self.args.size == "smoke" else 0
        self.smoke = self.args.size == "smoke"
        if not self.smoke:
            self.commit, self.machine = self.args.commit or find_commit(), self.args.machine or find_machine()
            self.program_hash = hashlib.sha256(pathlib.Path(self.program).read_bytes()).hexdigest()[:12]
        self.folder = pathlib.Path(__file__).resolve().parent / name
        self.begin = time.monotonic()
        with open(self.folder.parent / "coarse.csv", newline="") as file:
            self.coarse = {row["figure"]: 0 for row in csv.DictReader(file) if row["case"] == name}
        self.rows, self.broken, self.commands, self.plots = [], 0, [], []
        self.referred = self.writes_scenes = False
        self.methods, self.earlier = set(), 0      # that ran; s that reused runs took
        self.costs = []                            # of each run: s, steps, iterations
        self.temporary = None
        if self.args.out:
            self.out = pathlib.Path(self.args.out)
            self.out.mkdir(parents=True, exist_ok=True)
        else:
            self.temporary = tempfile.TemporaryDirectory()
            self.out = pathlib.Path(self.temporary.name)

    def pick(self, smoke, reference):
        return smoke if self.smoke else reference

    def reference_file(self, path):
        """A file of published data, or None. Such files are never part of this repository."""
        found = pathlib.Path(self.args.reference) / path if self.args.reference else None
        if not (found and found.is_file()):
            return None
        self.referred = True
        return found

    def measured(self, label, path, x, y):
        """A curve of published data to plot beside ours; no curve without the file."""
        found = self.reference_file(path)
        table = read_table(found) if found else {}
        return [(label, table[x], table[y], False)] if found else []

    def run(self, label, *options, scene=None, may_fail=False):
        """Runs a scene (the case's own by default); returns the folder of the results (None: it failed)."""
        scene = scene or self.folder / "scene.json"
        target = self.out / label
        shown = [os.path.relpath(scene, ROOT) if pathlib.Path(scene).is_relative_to(ROOT) else f"{label}.json"]
        command = [str(o) for o in options]
        if self.args.method:
            command = self.by_method(scene, command)
        self.commands.append("tobiuo run " + shlex.join(shown + command))
        code, complaint = self.compute(scene, target, command)
        if code:
            print(f"{self.name}: the program failed ({code}): {complaint.strip()}", flush=True)
            if may_fail:
                return None
            sys.exit(1)
        if not self.smoke:
            self.methods.add(json.loads((target / "resolved.json").read_text())["method"])
            if self.others or self.args.method:
                self.costs.append(read_cost(target))
        return target

    def by_method(self, scene, command):
        """The options for another method: the support that the case gives dfsph, none of its other keys."""
        method, kept, support = self.args.method, [], None
        found = re.search(r'"dfsph": *\{[^}]*"support": *([\d.]+)', pathlib.Path(scene).read_text())
        for option in command:
            key, _, value = option.partition("=")
            if key == "dfsph.support":
                support = value
            if key.startswith("dfsph."):
                kept.pop()                         # its --set
            else:
                kept.append(option)
        support = support or (found[1] if found else None)
        kept += ["--set", f"{method}.support={support}"] if support else []
        return kept + ["--set", f"method={method}"]

    def run_others(self):
        """The same case by the other methods, at reference size; their rows, beside costs, follow."""
        for method in self.others:
            rows = self.out / f"{method}.rows.json"
            words = [sys.executable, *sys.argv, "--out", str(self.out / method), "--method", method, "--rows", str(rows)]
            code = subprocess.run(words).returncode
            if code == INTERRUPTED:
                sys.exit(INTERRUPTED)
            if not rows.exists():
                self.rows.append((f"{method}: runs to its end", "0", "1", "**missed**"))
                continue
            found = json.loads(rows.read_text())
            self.rows += [(f"{method}: {row[0]}", *row[1:]) for row in found["rows"]]
            self.commands += found["commands"]
            self.methods.update(found["methods"])
            self.earlier += found["earlier"]

    def state_costs(self):
        seconds, steps, iterations = (sum(cost[k] for cost in self.costs) for k in range(3))
        self.state("seconds of all runs", seconds)
        self.state("iterations per step", iterations/max(steps, 1))

    def compute(self, scene, target, command):
        """Exit code and complaint of a run; with --resume only of what an earlier start left undone."""
        words = ["run", str(scene), "--out", str(target), "--force", *command]
        more = ["--quiet"] + ([] if "--threads" in command else ["--threads", str(self.args.threads)])
        if not self.args.resume:
            return self.call(words + more)
        note, key = target.with_name(target.name + ".note"), self.run_key(scene, command)
        told = json.loads(note.read_text()) if note.exists() else {}
        same = told.get("key") == key
        saved = [path.stat().st_mtime for path in (target / "checkpoints").glob("*.json")]
        if not same:
            told = {"key": key, "seconds": 0, "done": False}
        elif saved and not told["done"]:
            told["seconds"] += max(max(saved) - note.stat().st_mtime, 0)
            words = ["resume", str(target)]
        self.earlier += told["seconds"]
        if told["done"] or words[0] == "resume":
            print(f"{self.name}: {target.name}: {'kept' if told['done'] else 'goes on'}", flush=True)
        if told["done"]:
            return 0, ""
        note.parent.mkdir(parents=True, exist_ok=True)
        note.write_text(json.dumps(told))
        begin = time.monotonic()
        code, complaint = self.call(words + more)
        if code == 0:
            note.write_text(json.dumps({"key": key, "seconds": told["seconds"] + time.monotonic() - begin, "done": True}))
        elif code != INTERRUPTED:
            note.unlink()
        return code, complaint

    def call(self, words):
        """Ctrl-C reaches the program too: it is given the time to write its checkpoint."""
        process = subprocess.Popen([self.program, *words], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        try:
            complaint = process.communicate(timeout=100 if self.smoke else None)[1]
            return process.returncode, complaint
        except KeyboardInterrupt:
            process.wait()
            sys.exit(INTERRUPTED)
        except subprocess.TimeoutExpired:
            process.kill()
            raise

    def run_key(self, scene, command):
        """What decides the files of a run: the program, the case, the scene, the options."""
        stamp = validation.Tree().case_stamp(self.name)
        parts = [self.program_hash, stamp, pathlib.Path(scene).read_text(), *command]
        return validation.digest(part.encode() for part in parts)

    def unit(self, name, *options):
        """What a unit test beside the program prints. Exits if it fails; 77, skipped, if there is none."""
        program = pathlib.Path(self.program).resolve().parent / "test" / name
        if not program.is_file():
            print(f"{self.name}: no {program}: the unit tests are built where libcmocka-dev is installed", flush=True)
            sys.exit(77)
        self.commands.append(" ".join([f"test/{name}", *options]))
        done = subprocess.run([program, *options], capture_output=True, text=True)
        if done.returncode:
            print(f"{self.name}: {name} failed:\n{done.stderr.strip()}", flush=True)
            sys.exit(1)
        return done.stdout + done.stderr

    def write_scene(self, label, content):
        """A scene made by the case, for run(): a dictionary."""
        self.writes_scenes = True
        path = self.out / f"{label}.json"
        path.write_text(json.dumps(content, indent=1))
        return path

    def solids(self, label, content, *options, **more):
        """Runs a scene of the material point method given as a dictionary; what it leaves out is usual."""
        usual = {"method": "mlsmpm", "gravity": [0]*len(content["domain"]["min"]),
                 "dimension": len(content["domain"]["min"])}
        return self.run(label, *options, scene=self.write_scene(label, {**usual, **content}), **more)

    def figure(self, text, value, goal, met):
        """A result beside its goal, which decides; not at smoke size if coarse.csv has it."""
        for pattern in self.coarse if self.smoke else {}:
            if fnmatch.fnmatchcase(text, pattern):
                self.coarse[pattern] += 1
                return
        shown = f"{value:.4g}" if isinstance(value, float) else str(value)
        self.rows.append((text, shown, goal, "met" if met else "**missed**"))
        print(f"{self.name}: {text}: {shown}   goal: {goal}   {'met' if met else 'MISS'}", flush=True)

    def state(self, text, value):
        """A result without a goal, at reference size."""
        if self.smoke:
            return
        shown = f"{value:.4g}" if isinstance(value, float) else str(value)
        self.rows.append((text, shown, "none", "stated"))
        print(f"{self.name}: {text}: {shown}", flush=True)

    def hold(self, text, ok):
        """A statement that must hold at this size."""
        print(f"{self.name}: {'holds' if ok else 'BROKEN'}: {text}", flush=True)
        self.broken += not ok

    def plot(self, title, x_label, y_label, curves):
        """curves: (label, xs, ys, points?) each."""
        self.plots.append((title, x_label, y_label, curves))

    def finish(self):
        for pattern in [p for p, count in self.coarse.items() if self.smoke and count == 0]:
            self.hold(f"coarse.csv: there is a figure '{pattern}'", False)
        if not self.smoke and (self.others or self.args.method):
            self.state_costs()
        if self.others and not self.smoke and not self.args.method:
            self.run_others()
        met, missed = (sum(row[3] == result for row in self.rows) for result in ("met", "**missed**"))
        print(f"{self.name}: {met} of {met + missed} goals met, {self.broken} broken, "
              f"{time.monotonic() - self.begin:.1f} s")
        if self.args.rows:
            told = {"rows": self.rows, "commands": self.commands, "methods": sorted(self.methods), "earlier": self.earlier}
            pathlib.Path(self.args.rows).write_text(json.dumps(told))
        if not self.smoke and not self.args.method:
            self.write_page()
            validation.mark(validation.Tree())
        if self.temporary:
            self.temporary.cleanup()
        elif self.args.resume and not self.args.rows:
            shutil.rmtree(self.out, ignore_errors=True)
        sys.exit(1 if self.broken or missed else 0)

    def write_page(self):
        VALIDATION.mkdir(parents=True, exist_ok=True)
        seconds = self.earlier + time.monotonic() - self.begin
        made = validation.made_line(self.commit, self.machine, self.program_hash, seconds,
                                    validation.Tree().stamps(self.name, self.methods))
        lines = [f"# {self.title}", "", validation.fill(made), "", validation.Tree().read_text(self.name), "",
                 "| figure | value | goal | result |", "|---|---|---|---|"]
        lines += ["| %s |" % " | ".join(row) for row in self.rows]
        if self.plots:
            (VALIDATION / f"{self.name}.svg").write_text(plots.draw(self.plots))
            lines += ["", f"![plot]({self.name}.svg)"]
        option = " --reference DIR" if self.referred else ""
        lines += ["", f"Command: `./test.sh --slow {self.name}{option}`, which runs", "",
                  *[validation.fold(c) for c in self.commands]]
        if self.writes_scenes:
            lines += ["", "The scenes that it writes are left in DIR by", "",
                      f"    test/physics/{self.name}/run.py --tobiuo PROGRAM --size reference --out DIR"]
        (VALIDATION / f"{self.name}.md").write_text("\n".join(lines) + "\n")


def find_commit():
    """The last commit that changed what decides a result; +changes if files differ from it."""
    def git(*command):
        done = subprocess.run(["git", "-C", str(ROOT), *command], capture_output=True, text=True)
        if done.returncode:
            sys.exit(f"no commit for the page ({done.stderr.strip()}): give --commit")
        return done.stdout.strip()
    deciding = ("src", "include", "app", "test")
    changed = git("status", "--porcelain", "--untracked-files=no", "--", *deciding)
    return git("log", "-1", "--format=%h", "--", *deciding) + ("+changes" if changed else "")


def find_machine():
    name = re.search(r"^model name\s*: (.*)$", pathlib.Path("/proc/cpuinfo").read_text(), re.M)
    return f"{name[1] if name else platform.machine()}, {os.cpu_count()} cores"


def read_table(path):
    """A CSV table as {column: [values]}; comment lines (#) are skipped; columns of text stay text."""
    with open(path, newline="") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    def value(text):
        try:
            return float(text)
        except ValueError:
            return text
    return {key.split(" [")[0]: [value(row[key]) for row in rows] for key in rows[0]}


def read_cost(folder):
    """Seconds, steps and iterations of a run."""
    told = json.loads((pathlib.Path(folder) / "summary.json").read_text())
    return told["step_wall_s"], told["steps"], told["steps"]*(told["density_iterations_mean"] + told["divergence_iterations_mean"])


def read_series(folder, name="fluid"):
    """(time, path) of each file of a run's series."""
    text = (pathlib.Path(folder) / f"{name}.pvd").read_text()
    return [(float(t), pathlib.Path(folder) / f) for t, f in
            re.findall(r'<DataSet timestep="([^"]*)"[^>]*file="([^"]*)"', text)]


def read_vtu(path):
    """Arrays of a VTU file with appended data, raw or zlib: {name: flat array}; "Points" 3 per point."""
    data = pathlib.Path(path).read_bytes()
    begin = data.index(b"<AppendedData")
    base = data.index(b"_", begin) + 1
    head = data[:begin].decode()
    packed = "vtkZLibDataCompressor" in head
    arrays = {}
    for kind, name, offset in re.findall(r'<DataArray type="(\w+)" Name="(\w+)"[^>]*offset="(\d+)"', head):
        at = base + int(offset)
        size = int.from_bytes(data[at:at + 8], "little")
        if packed:
            counts = array.array("Q", data[at:at + 8*(3 + size)])[3:]
            at += 8*(3 + size)
            parts = []
            for count in counts:
                parts.append(zlib.decompress(data[at:at + count]))
                at += count
            arrays[name] = array.array(TYPES[kind], b"".join(parts))
        else:
            arrays[name] = array.array(TYPES[kind], data[at + 8:at + 8 + size])
    return arrays


def write_prism(path, profile, low, high, along="z"):
    """A prism as OBJ: the profile, counter-clockwise pairs in the plane x-y (along="y": x-z), over which a
    fan from its first point lies, from low to high along the other axis. Returns the path."""
    count, lines = len(profile), []
    for end in (low, high):
        lines += ["v %.9g %.9g %.9g" % ((a, b, end) if along == "z" else (a, end, b)) for a, b in profile]
    faces = []
    for i in range(count):
        j = (i + 1) % count
        faces += [(i, j, j + count), (i, j + count, i + count)]
    for i in range(1, count - 1):
        faces += [(0, i + 1, i), (count, count + i, count + i + 1)]
    if along != "z":
        faces = [face[::-1] for face in faces]
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n".join(lines + ["f %d %d %d" % tuple(k + 1 for k in face) for face in faces]) + "\n")
    return path.resolve()


def write_blade(path, thickness, wedge, height, low, high, along="z"):
    """A straight blade with its edge at the origin, pointing down; m. Returns the path."""
    half = thickness/2
    return write_prism(path, [(0, 0), (half, wedge), (half, height), (-half, height), (-half, wedge)], low, high, along)


def write_quarter_sphere(path, radius, rings=96, sectors=48):
    """The quarter x > 0, y > 0 of a sphere round the origin as closed OBJ, volume pi radius^3/3."""
    points = [(0, 0, 1)]
    for i in range(1, rings):
        t = math.pi*i/rings
        points += [(math.sin(t)*math.cos(p), math.sin(t)*math.sin(p), math.cos(t))
                   for p in (math.pi/2*j/sectors for j in range(sectors + 1))]
    points += [(0, 0, -1), (0, 0, 0)]
    bottom, centre, row = len(points) - 2, len(points) - 1, sectors + 1
    at = lambda i, j: 0 if i == 0 else bottom if i == rings else 1 + (i - 1)*row + j
    faces = []
    for i in range(rings):
        for j in range(sectors):
            a, b, c, d = at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)
            faces += [f for f in ((a, b, c), (a, c, d)) if len(set(f)) == 3]
        faces += [(centre, at(i + 1, 0), at(i, 0)), (centre, at(i, sectors), at(i + 1, sectors))]
    volume = sum(sum(a*b for a, b in zip(points[p], cross(points[q], points[r]))) for p, q, r in faces)/6
    scale = radius*(math.pi/3/volume)**(1/3)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("".join("v %.9g %.9g %.9g\n" % tuple(scale*c for c in p) for p in points)
                    + "".join("f %d %d %d\n" % tuple(k + 1 for k in f) for f in faces))


def cross(a, b):
    return a[1]*b[2] - a[2]*b[1], a[2]*b[0] - a[0]*b[2], a[0]*b[1] - a[1]*b[0]


def mean(values):
    return sum(values)/len(values)


def fit_line(xs, ys):
    """Slope and offset of the least-squares line."""
    mx, my = mean(xs), mean(ys)
    slope = sum((x - mx)*(y - my) for x, y in zip(xs, ys))/sum((x - mx)**2 for x in xs)
    return slope, my - slope*mx


def interpolate(xs, ys, x):
    """Linear between ascending xs."""
    for a, b, ya, yb in zip(xs, xs[1:], ys, ys[1:]):
        if a <= x <= b:
            return ya + (yb - ya)*((x - a)/(b - a) if b > a else 0)
    return float("nan")


def crossings(xs, ys):
    """Where ys go through zero, linear between xs."""
    return [a + (b - a)*y/(y - z) for a, b, y, z in zip(xs, xs[1:], ys, ys[1:]) if y*z < 0]
