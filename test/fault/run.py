#!/usr/bin/env python3
"""The n-th allocation, opening, writing or reading of a run fails: what is left must be clean.

usage: run.py --tobiuo PROGRAM --preload fail_nth.so [--slow] [--frames] [--only SWEEP[:N]] [--keep]

A tiny scene (fluid, a body moved by a script, tables, checkpoints) is run, and resumed from
the middle, once without a fault and then once for each n (every few n, unless --slow). After each:
  exit code 0   the fault was survived: the results are those of the reference, byte for byte;
  exit code 1   one to three lines on stderr, each beginning with "tobiuo: "; no *.part file; every file
                is the reference's or a whole beginning of it; `resume` without a fault ends with the
                reference's results (or, with nothing to resume, says so in words);
  exit code 3   the run went on to its end without files that could not be written: at most ten lines; the rest
                as for 1;
  anything else (a signal, a hang, another code) is a failure.
A scene of the Taichi program is checked and imported in the same way: after exit code 0 the table or the new
scene is the reference's, after exit code 1 there is no new scene.
Prints one line per failure and the counts; exits 1 if there was one.
"""
import argparse, concurrent.futures, json, os, pathlib, re, shutil, subprocess, sys, tempfile

# name: (kind, environment, how many n in an ordinary run)
SWEEPS = {
    "own": ("own", {}, 40),
    "child": ("child", {}, 8),
    "open": ("open", {"FAIL_ERRNO": "24"}, 10),
    "write": ("write", {"FAIL_ERRNO": "28"}, 30),
    "write-stays-full": ("write", {"FAIL_ERRNO": "28", "FAIL_ON": "1"}, 12),
    "write-io": ("write", {"FAIL_ERRNO": "5"}, 8),
    "write-short": ("write", {"FAIL_ERRNO": "28", "FAIL_SHORT": "1"}, 12),
    "write-interrupted": ("write", {"FAIL_ERRNO": "4"}, 8),
    "read": ("read", {"FAIL_ERRNO": "5"}, 8),
    "read-short": ("read", {"FAIL_ERRNO": "5", "FAIL_SHORT": "1"}, 6),
    "libraries": ("libraries", {}, 0),      # by hand: HDF5 1.10 cannot, see docs/architecture.md
}
OLD_SWEEPS = {"own": 40, "libraries": 20}      # of check and import, which hold no HDF5
SCENE = """{ "domain": {"min": [0, 0, 0], "max": [0.3, 0.3, 0.3]}, "spacing": 0.05, "end_time": 0.03,
"gravity": [0, 0, -9.81], "threads": 1,
"fluids": [{"name": "water", "density": 1000, "viscosity": 0.001,
            "fill": [{"box": {"min": [0, 0, 0], "max": [0.3, 0.3, 0.15]}}]}],
"bodies": [{"name": "box", "mesh": "box.obj", "translation": [0.15, 0.15, 0.15], "density": 1000,
            "motion": {"script": "swing.lua", "params": {"way": 0.02}}}],
"output": {"interval": 0.01, "checkpoint_interval": 0.01, "compression": "zlib"} }
"""
OLD = """{ "Configuration": { "domainEnd": [0.3, 0.3, 0.3], "particleRadius": 0.025, "viscosity": 1e-6,
  "gravitation": [0, 0, -9.81], "timeStepSize": 0.001, "cameraPosition": [1, 1, 1] },
"FluidBlocks": [ { "objectId": 0, "start": [0, 0, 0], "end": [0.3, 0.3, 0.15], "color": [1, 2, 3] } ],
"RigidBlocks": [ { "start": [0.1, 0.1, 0.16], "end": [0.2, 0.2, 0.18], "isDynamic": true, "density": 500 } ],
"RigidBodies": [ { "geometryFile": "box.obj", "translation": [0.15, 0.15, 0.24], "velocity": [0, 0, 0],
  "rotationAngle": 30, "isDynamic": true } ] }
"""
TIMED = {"summary.json"}


def write_scene(folder):
    corners = [(x, y, z) for z in (-.05, .05) for y in (-.05, .05) for x in (-.05, .05)]
    faces = ("1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6")
    (folder / "box.obj").write_text("".join("v %g %g %g\n" % c for c in corners) +
                                    "".join("f %s\n" % f for f in faces))
    (folder / "swing.lua").write_text("function place(t) return params.way*math.sin(20*t), 0, 0 end\n")
    (folder / "scene.json").write_text(SCENE)
    (folder / "old.json").write_text(OLD)


class Checker:
    def __init__(self, options, folder):
        self.options, self.folder = options, folder
        self.temporary = tempfile.TemporaryDirectory()         # LD_PRELOAD knows no path with a space
        self.preload = shutil.copy(options.preload, self.temporary.name)
        self.base = dict(os.environ, OMP_WAIT_POLICY="passive", OMP_NUM_THREADS="1", LC_ALL="C")
        write_scene(folder)
        self.reference = folder / "reference"
        self.stopped = folder / "stopped"
        self.run(["run", "scene.json", "--out", self.reference, *FRAMES], must=0)
        self.run(["run", "scene.json", "--out", self.stopped, *FRAMES, "--until", "0.01"], must=0)
        end = json.loads((self.stopped / "resolved.json").read_text())
        end["end_time"] = 0.03
        (self.stopped / "resolved.json").write_text(json.dumps(end))
        self.old = {c: self.translate(c, folder / "new.json")[1:] for c in ("check", "import")}
        self.files = {p.relative_to(self.reference): p.read_bytes()
                      for p in self.reference.rglob("*") if p.is_file()}

    def run(self, arguments, fault=None, must=None):
        environment = dict(self.base)
        if fault: environment.update(fault, LD_PRELOAD=str(self.preload))
        try:
            done = subprocess.run([str(self.options.tobiuo), *map(str, arguments), "--quiet"],
                                  cwd=self.folder, env=environment, timeout=100, capture_output=True,
                                  stdin=subprocess.DEVNULL)
            code, text = done.returncode, done.stderr.decode(errors="replace")
        except subprocess.TimeoutExpired:
            code, text = "no end", ""
        if must is not None and code != must:
            sys.exit(f"without a fault: tobiuo {' '.join(map(str, arguments))} ended with {code}: {text}")
        return code, text

    def translate(self, command, new, fault=None):
        """(code, what is to be like the reference, stderr) of `check` or `import` of the old scene."""
        environment = dict(self.base, **(fault or {}))
        if fault: environment["LD_PRELOAD"] = str(self.preload)
        arguments = [command, "old.json"] + (["--out", str(new), "--quiet"] if command == "import" else [])
        done = subprocess.run([str(self.options.tobiuo), *arguments], cwd=self.folder, env=environment,
                              timeout=100, capture_output=True, stdin=subprocess.DEVNULL)
        said = re.sub(rb"(?m)^wall clock .*$", b"wall clock", done.stdout)         # no two are equal
        result = new.read_bytes() if new.is_file() else said if command == "check" else b""
        if not fault and (done.returncode or not result):
            sys.exit(f"without a fault: {command} ended with {done.returncode}: {done.stderr}")
        return done.returncode, result, done.stderr.decode(errors="replace")

    def judge_old(self, command, new, fault):
        """(code, what is wrong) of `check` or `import` with a fault."""
        try: code, result, text = self.translate(command, new, fault)
        except subprocess.TimeoutExpired: return 1, "no end"
        lines, left = text.splitlines(), [p.name for p in self.folder.glob(f"{new.name}*")]
        new.unlink(missing_ok=True)
        if code == 0: return 0, None if result == self.old[command][0] else "exit 0, but the result differs"
        if code != 1 or not lines: return code, f"exit {code}: {text.strip()[:200]}"
        if text.lstrip().startswith("libgomp: "): return 1, None      # it ends the program with words of its own
        if len(lines) > 3 or any(not line.startswith("tobiuo: ") for line in lines):
            return 1, f"message: {text.strip()[:300]}"
        return 1, f"{left[0]} is left" if left else None

    def differs(self, folder):
        """Names of reference files that the finished folder lacks or has otherwise."""
        bad = []
        for name, content in self.files.items():
            if str(name) in TIMED or name.parts[0] == "checkpoints" or name.name == "resolved.json": continue
            path = folder / name
            if not path.is_file() or path.read_bytes() != content: bad.append(str(name))
        return bad

    def broken(self, folder):
        """What is wrong with the files that an interrupted run has left."""
        bad = []
        for path in folder.rglob("*"):
            if not path.is_file(): continue
            name = path.relative_to(folder)
            content, whole = path.read_bytes(), self.files.get(name)
            if path.suffix == ".part": bad.append(f"{name} is left")
            elif path.suffix == ".json":
                try: json.loads(content)
                except ValueError: bad.append(f"{name} is no JSON")
            elif path.suffix == ".csv":
                if not (whole or b"").startswith(content) or (content and content[-1:] != b"\n"):
                    bad.append(f"{name} is no beginning of the reference")
            elif path.suffix == ".pvd":
                if b"</VTKFile>" not in content: bad.append(f"{name} has no end")
                for part in re.findall(rb'file="([^"]*)"', content):
                    if not (folder / part.decode()).is_file(): bad.append(f"{name} names {part.decode()}")
            elif path.suffix != ".h5" and content != whole: bad.append(f"{name} differs")
        return bad

    def judge(self, code, text, folder):
        # HDF5 says so itself as the program ends, after a file that it could not read
        text = text.split("HDF5: infinite loop closing library")[0]
        lines = text.splitlines()
        if code == 0:
            bad = self.differs(folder)
            return f"exit 0, but {bad[0]} differs" if bad else None
        if code not in (1, 3): return f"exit {code}: {text.strip()[:200]}"
        if not lines: return f"exit {code} without a message"
        if len(lines) > (3 if code == 1 else 10) or any(not line.startswith("tobiuo: ") for line in lines):
            return f"message: {text.strip()[:300]}"
        if not folder.is_dir(): return None
        bad = self.broken(folder)
        if bad: return f"{bad[0]} ({lines[0]})"
        code, text = self.run(["resume", folder])
        if code == 1 and "there is no run to resume" in text:
            left = [p for p in folder.rglob("*") if p.suffix == ".h5"]
            return "a checkpoint, but nothing to resume" if left else None
        if code != 0: return f"resume: exit {code}: {text.strip()[:200]} (after {lines[0]})"
        bad = self.differs(folder)
        return f"resume: {bad[0]} differs (after {lines[0]})" if bad else None

    def one(self, command, sweep, n):
        kind, extra, _ = SWEEPS[sweep]
        folder = self.folder / f"{command}_{sweep}_{n}"
        log = self.folder / f"{command}_{sweep}_{n}.log"
        fault = dict(extra, FAIL_KIND=kind, FAIL_AT=str(n), FAIL_LOG=str(log))
        if command in ("check", "import"):
            code, wrong = self.judge_old(command, folder.with_suffix(".json"), fault)
        elif command == "resume":
            shutil.copytree(self.stopped, folder)
            code, text = self.run(["resume", folder], fault)
        else:
            code, text = self.run(["run", "scene.json", "--out", folder, *FRAMES], fault)
        count, call = (log.read_text().split() + ["?", "?"])[:2] if log.is_file() else ("?", "?")
        if command in ("run", "resume"): wrong = self.judge(code, text, folder)
        if not self.options.keep:
            shutil.rmtree(folder, ignore_errors=True)
            log.unlink(missing_ok=True)
        return code, int(count) if count.isdigit() else 0, call, wrong


FRAMES = []


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--tobiuo", type=pathlib.Path, required=True)
    parser.add_argument("--preload", type=pathlib.Path, required=True)
    parser.add_argument("--slow", action="store_true")
    parser.add_argument("--only", default="")
    parser.add_argument("--keep", action="store_true")
    parser.add_argument("--frames", action="store_true", help="with pictures: seconds per run")
    options = parser.parse_args()
    options.tobiuo, options.preload = options.tobiuo.resolve(), options.preload.resolve()
    if options.frames: FRAMES.append("--frames")
    only, _, at = options.only.partition(":")
    folder = pathlib.Path(tempfile.mkdtemp(prefix="fault_", dir="."))
    checker = Checker(options, folder.resolve())
    failures = runs = 0
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        for command in ("run", "resume", "check", "import"):
            for sweep, (_, _, wanted) in SWEEPS.items():
                if command in ("check", "import"): wanted = OLD_SWEEPS.get(sweep)
                if wanted is None: continue
                if only and only not in (sweep, f"{command}-{sweep}"): continue
                if not only and not wanted: continue
                code, total, _, wrong = checker.one(command, sweep, 0)
                if code or wrong: sys.exit(f"counting {command} {sweep}: {code} {wrong}")
                if not total: sys.exit(f"counting {command} {sweep}: no such call was seen, so none can fail")
                if command == "resume": wanted = (wanted + 1)//2
                stride = 1 if options.slow else max(1, total//(wanted or 60))
                places = [int(at)] if at else list(range(1, total + 1, stride))
                survived = bad = 0
                for n, (code, _, call, wrong) in zip(
                        places, pool.map(lambda n: checker.one(command, sweep, n), places)):
                    survived += code == 0
                    if not wrong: continue
                    bad += 1
                    print(f"FAILED {command} {sweep}:{n} ({call}): {wrong}", flush=True)
                print(f"{command} {sweep}: {len(places)} of {total} places, {survived} survived, {bad} failed",
                      flush=True)
                failures += bad
                runs += len(places)
    if not options.keep: shutil.rmtree(folder)
    print(f"{runs - failures} passed, {failures} failed")
    return failures > 0 or runs == 0


sys.exit(main())
