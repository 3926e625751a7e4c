#!/usr/bin/env python3
"""Short scenes whose results are known to the last bit: scenes *.json, results in hashes.csv.

usage: run.py --tobiuo PROGRAM [--every] [SCENE...]
       run.py --tobiuo PROGRAM --write        writes hashes.csv anew

Each scene runs with the kernels of x86-64-v2, v3 and v4 (on older processors the best there is), each with
another number of threads, once in two parts (run, then resume), and once as on a processor without fused
multiply-add, where the C library computes sines and powers in another way. --every: each kernel set with 1, 2 and
4 threads. All must agree with the table in two numbers:
`state`, the state_hash of summary.json, and `files`, the names and bytes of all files but summary.json
(times), resolved.json (paths) and checkpoints. `added` counts when scenes came: pages of docs/validation that
are older than a scene do not know it.
A commit that changes the table says why. Prints one line per difference; exits 1 if there was one.
"""
import argparse, concurrent.futures, csv, hashlib, json, os, pathlib, shutil, subprocess, sys, tempfile

HERE = pathlib.Path(__file__).resolve().parent
TABLE = HERE / "hashes.csv"
LEVELS, THREADS = (2, 3, 4), (1, 2, 4)
OLD_PROCESSOR = "glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4,-AVX512F,-AVX2_Usable,-FMA_Usable"
APART = {"summary.json", "resolved.json", "inputs.json", "checkpoints"}


def variants(every=False):
    for level, own in zip(LEVELS, THREADS):
        for threads in THREADS if every else [own]:
            yield f"v{level}, threads {threads}", {"TOBIUO_ISA": str(level)}, threads, False
    yield "resumed", {}, 2, True
    yield "processor without FMA", {"TOBIUO_ISA": "2", "GLIBC_TUNABLES": OLD_PROCESSOR}, 2, False


def call(program, env, *words):
    done = subprocess.run([program, *words], env={**os.environ, "OMP_WAIT_POLICY": "passive", **env},
                          capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(f"{' '.join(words)}: exit code {done.returncode}\n{done.stderr}")


def hash_files(folder):
    total = hashlib.sha256()
    for path in sorted(folder.rglob("*")):
        name = path.relative_to(folder)
        if path.is_file() and not APART.intersection(name.parts):
            total.update(str(name).encode() + b"\0" + hashlib.sha256(path.read_bytes()).digest())
    return total.hexdigest()[:16]


def run(work, program, scene, variant, times=()):
    """Hashes and times of outputs; those are needed for two parts."""
    name, env, threads, parts = variant
    out = work/(scene.stem + "-" + name.replace(" ", "_").replace(",", ""))
    always = [str(scene), "--quiet", "--threads", str(threads), "--out", str(out), "--set", "output.compression=none"]
    call(program, env, "run", *always, *(["--until", times[1]] if parts else []))
    if parts:
        call(program, env, "resume", str(out), "--quiet", "--until", times[-1])
    with (out / "history.csv").open(newline="") as file:
        times = [row["time"] for row in csv.DictReader(file)]
    result = {"state": json.loads((out / "summary.json").read_text())["state_hash"], "files": hash_files(out)}
    shutil.rmtree(out)
    return result, times


def read_table():
    with TABLE.open(newline="") as file:
        return {row["scene"]: row for row in csv.DictReader(file)}


def write_table(found):
    known = read_table()
    latest = 1 + max((int(row["added"]) for row in known.values()), default=-1)
    with TABLE.open("w", newline="") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(["scene", "state", "files", "added"])
        rows.writerows([name, result["state"], result["files"], known[name]["added"] if name in known else latest]
                       for name, result in sorted(found.items()))


def compare(scene, known, results):
    """Lines that say what differs: from the table, or from the first variant where all differ from the table."""
    first = results[0][1]
    for key in ("state", "files"):
        if known is None:
            yield f"{scene.stem}: is not in {TABLE.name}"
            return
        if all(result[key] == first[key] != known[key] for _, result in results):
            yield f"{scene.stem}: {key} is {first[key]}, {TABLE.name} has {known[key]}"
            continue
        for name, result in results:
            if result[key] != known[key]:
                yield f"{scene.stem} ({name}): {key} is {result[key]}, not {known[key]}"


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("--tobiuo", required=True)
    parser.add_argument("--every", action="store_true")
    parser.add_argument("--write", action="store_true")
    parser.add_argument("scenes", nargs="*")
    options = parser.parse_args()
    program = str(pathlib.Path(options.tobiuo).resolve())
    scenes = [s for s in sorted(HERE.glob("*.json")) if not options.scenes or s.stem in options.scenes]
    if options.write and options.scenes:
        parser.error("--write takes all scenes")
    table, found, faults = {} if options.write else read_table(), {}, []
    if not options.scenes:
        faults += [f"{name}: there is no such scene" for name in table if name not in {s.stem for s in scenes}]
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(2) as pool:
        work = pathlib.Path(folder)
        for scene in scenes:
            names = list(variants(options.every))
            first, times = run(work, program, scene, names[0])
            others = pool.map(lambda v, s=scene, t=times: run(work, program, s, v, t)[0], names[1:])
            results = list(zip([v[0] for v in names], [first, *others]))
            found[scene.stem] = results[0][1]
            faults += compare(scene, found[scene.stem] if options.write else table.get(scene.stem), results)
    if faults:
        print("\n".join(faults))
        print(f"Where a change was meant: {os.path.relpath(HERE)}/run.py --tobiuo PROGRAM --write, and the commit says why")
        return 1
    if options.write:
        write_table(found)
    print(f"{len(scenes)} scenes, {len(list(variants(options.every)))} runs of each, all alike")
    return 0


if __name__ == "__main__":
    sys.exit(main())
