#!/usr/bin/python3
"""Heave decay of a floating sphere against six codes."""
import csv
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, read_table, write_quarter_sphere

case = Case("heave", "Heave decay of a sphere")

R, G, RHO = 5.0, 9.81, 1000
# Time (s) and height (m) of the first three extrema: mean over ProteusDS, InWave, Marin, NREL CFD, WavEC and InWave+H.
EXTREMA = [(2.220, -0.875), (4.418, 0.638), (6.588, -0.479)]


def extrema(times, heights, count=3):
    """The first turning points, each by a parabola through its three samples."""
    found = []
    for (ta, a), (tb, b), (_, c) in zip(zip(times, heights), zip(times[1:], heights[1:]), zip(times[2:], heights[2:])):
        if (b - a)*(c - b) < 0 and len(found) < count:
            bend = a - 2*b + c
            shift = (a - c)/(2*bend)
            found.append((tb + shift*(tb - ta), b - (a - c)**2/(8*bend)))
    return found


def heave(across, far, deep, support):
    d = R/across
    mesh = case.out / "quarter.obj"
    write_quarter_sphere(mesh, R)
    scene = case.write_scene(f"heave{across}_{support}", {
        "dfsph": {"support": support},
        "domain": {"min": [0, 0, -deep], "max": [far, far, 8]}, "gravity": [0, 0, -G], "spacing": d, "end_time": 7.4,
        "fluids": [{"name": "water", "density": RHO, "viscosity": 0, "fill": [{"box": {"min": [0, 0, -deep], "max": [far, far, 0]}}]}],
        "bodies": [{"name": "sphere", "mesh": str(mesh), "density": 500, "dynamics": "free", "locked": "x,y,turn", "translation": [0, 0, 1]}],
        "output": {"interval": 0.05, "fields": ["velocity"], "surfaces": False}})
    table = read_table(case.run(f"out{across}_{support}", scene=scene) / "bodies.csv")
    return table["time"], table["position_z"]


curves = []
for across, far, deep, support in case.pick(((6, 15, 10, 2),), ((10, 27, 20, 2), (10, 27, 20, 2.5), (10, 27, 20, 3))):
    times, heights = heave(across, far, deep, support)
    text = f"R/d = {across}, support {support} d"
    curves.append((text, times, heights, False))
    found = extrema(times, heights)
    case.hold(f"{text}: three extrema", len(found) == 3)
    if len(found) < 3:
        continue
    period, expected = found[2][0] - found[0][0], EXTREMA[2][0] - EXTREMA[0][0]
    case.figure(f"{text}: period {period:.3f} s against {expected:.3f}, deviation", period/expected - 1, "within 0.02",
                abs(period/expected - 1) <= 0.02)
    for k, ((_, height), (_, right)) in enumerate(zip(found, EXTREMA)):
        case.figure(f"{text}: extremum {k + 1}: {height:.3f} m against {right:.3f}, deviation", height/right - 1, "within 0.05",
                    abs(height/right - 1) <= 0.05)
    # Six spacings in R and a small tank: -0.65 m; water lifted off its walls by a quarter of a spacing had -0.25.
    case.hold(f"{text}: period within 6 %", abs(period/expected - 1) <= 0.06)
    case.hold(f"{text}: falls to {found[0][1]:.2f} m", -1.1 <= found[0][1] <= -0.55)
data = case.reference_file("floating/oes_task10_sphere_decay_1m.csv")
if data:
    rows = [r for r in csv.reader(line for line in data.open() if line[0] != "#")]
    for name in ("NREL_CFD", "InWave_lin"):
        column = rows[0].index(name)
        points = [(float(r[0]), float(r[column])) for r in rows[1:] if float(r[0]) < 7.4]
        curves.append((name.replace("_", " "), *zip(*points), True))
case.plot("Heave decay", "t, s", "z, m", curves)
case.finish()
