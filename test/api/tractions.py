#!/usr/bin/python3
"""output.tractions: the pressure on the files' surfaces, summed over their area, is the force in bodies.csv.

usage: tractions.py PROGRAM      works in a fresh folder that it removes; exit code 77 without VTK

A held box: 0.5 % of its buoyancy. A driven block: 10 % of its largest force, 20 % of its largest friction. The
file shows the particles where they are after the step, the force is of the step itself. The impulse of a
particle that was pushed out of a body is a part of the force alone: such outputs are left out. So is the sudden
start, at which the velocity of the water changes by as much as it is within a few steps.
"""
import csv
import json
import pathlib
import subprocess
import sys
import tempfile

try:
    import numpy
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy
except ImportError as problem:
    print("VTK for Python is missing:", problem)
    sys.exit(77)

HELD = {
    "domain": {"min": [0, 0, 0], "max": [0.24, 0.24, 0.24]}, "spacing": 0.01, "end_time": 0.02,
    "fluids": [{"name": "water", "fill": [{"box": {"min": [0, 0, 0], "max": [0.24, 0.24, 0.2]}}]}],
    "bodies": [{"name": "box", "box": {"min": [0.08, 0.08, 0.06], "max": [0.16, 0.16, 0.14]}}],
    "output": {"interval": 0.02, "tractions": True}}
DRIVEN = {
    "dimension": 2, "domain": {"min": [0, 0], "max": [0.48, 0.32]}, "gravity": [0, -9.81], "spacing": 0.01,
    "end_time": 0.15,
    "fluids": [{"name": "oil", "viscosity": 0.5, "fill": [{"box": {"min": [0, 0], "max": [0.48, 0.25]}}]}],
    "bodies": [{"name": "post", "box": {"min": [0.16, 0.08], "max": [0.24, 0.16]}, "friction": "no-slip",
                "motion": {"keyframes": {"file": "tow.csv"}}}],
    "output": {"interval": 0.01, "tractions": True}}
TOW = "time,x,y,z\n0,0,0,0\n0.05,0.0125,0,0\n0.1,0.0375,0,0\n0.15,0.0625,0,0\n"
passed = failed = 0


def check(what, ok):
    global passed, failed
    passed += ok
    failed += not ok
    print("ok    " if ok else "FAILED", what)


def integrate(path):
    """Forces by pressure and by shear of one file, and how far its surface is from closed."""
    reader = vtk.vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    data = reader.GetOutput()
    pressure, shear = (vtk_to_numpy(data.GetCellData().GetArray(name)) for name in ("pressure", "shear"))
    points = vtk_to_numpy(data.GetPoints().GetData())
    if data.GetNumberOfPolys():
        x = points.reshape(-1, 3, 3)
        area = 0.5 * numpy.cross(x[:, 1] - x[:, 0], x[:, 2] - x[:, 0])
    else:
        x = points.reshape(-1, 2, 3)
        area = numpy.cross(x[:, 1] - x[:, 0], [0, 0, 1])
    size = numpy.linalg.norm(area, axis=1)
    return -(pressure[:, None] * area).sum(0), (shear * size[:, None]).sum(0), abs(area.sum(0)).max() / size.sum()


def compare(program, scene, method, name, body):
    pathlib.Path(f"{name}.json").write_text(json.dumps({**scene, "method": method}))
    out = f"{name}_{method}"
    subprocess.run([program, "run", f"{name}.json", "--quiet", "--out", out], check=True, stderr=subprocess.DEVNULL)
    with open(f"{out}/bodies.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    with open(f"{out}/history.csv", newline="") as file:
        quiet = [scene is HELD or (int(row["contacts"]) == 0 and float(row["time"]) > 0.025)
                 for row in csv.DictReader(file)]
    told = [[numpy.array([float(row[f"{kind}_force_{c}"]) for c in "xyz"]) for kind in ("pressure", "viscous")]
            for row in rows]
    files = [integrate(f"{out}/tractions/{body}_tractions_{k:06d}.vtp") for k in range(len(rows))]
    check(f"{out}: the surface is closed", all(f[2] < 1e-12 for f in files))
    check(f"{out}: nothing before the first step", all(abs(part).max() == 0 for part in files[0][:2]))
    check(f"{out}: half of the outputs are quiet", sum(quiet) > 0.5 * len(quiet))
    return [(max(numpy.linalg.norm(f[k] - t[k]) for f, t, ok in zip(files, told, quiet) if ok),
             max(numpy.linalg.norm(t[k]) for t in told)) for k in (0, 1)]


def main():
    program = str(pathlib.Path(sys.argv[1]).resolve())
    with tempfile.TemporaryDirectory() as folder:
        import os
        os.chdir(folder)
        pathlib.Path("tow.csv").write_text(TOW)
        for method in ("dfsph", "wcsph", "isph"):
            (off, _), _ = compare(program, HELD, method, "held", "box")
            weight = 1000 * 9.81 * 0.08 ** 3
            check(f"held, {method}: off by {off / weight:.4f} of the buoyancy, at most 0.005", off <= 0.005 * weight)
            for what, most, (off, largest) in zip(("pressure", "shear"), (0.1, 0.2),
                                                  compare(program, DRIVEN, method, "driven", "post")):
                check(f"driven, {method}: {what} off by {off / largest:.4f}, at most {most}",
                      largest > 1 and off <= most * largest)
        got = subprocess.run([program, "check", "held.json", "--set", "method=mlsmpm", "--set", "fluids=[]"],
                             capture_output=True, text=True)
        check("mlsmpm is refused in words", got.returncode == 1)
        os.chdir("/")
    print(f"{passed} passed, {failed} failed")
    return failed > 0


sys.exit(main())
