#!/usr/bin/python3
"""Water that slides over a floor: the friction of a turbulent layer."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, mean, read_series, read_vtu

case = Case("plate", "Friction of a floor")

U, DEPTH, NU = 2.0, 0.04, 1e-6


def thickness(t):
    return (0.225*U**0.75*NU**0.25*t)**0.8


def run(spacing, dimension):
    width = [] if dimension == 2 else [10*spacing]
    walls = {"x": "periodic", **({"y": "no-slip"} if dimension == 2 else {"y": "periodic", "z": "no-slip"})}
    box = {"min": [0]*dimension, "max": [max(0.1, 20*spacing), *width, DEPTH]}
    label = f"{spacing*1000:g}_mm_{dimension}d"
    out = case.run(label, scene=case.write_scene(label, {
        "dimension": dimension, "domain": {"min": [0]*dimension, "max": box["max"][:-1] + [2*DEPTH], "walls": walls},
        "gravity": [0]*(dimension - 1) + [-9.81], "spacing": spacing, "end_time": 0.5,
        "fluids": [{"name": "water", "density": 1000, "viscosity": 1e-3,
                    "fill": [{"box": box, "velocity": [U] + [0]*(dimension - 1)}]}],
        "output": {"interval": 0.1, "fields": ["velocity"]}}))
    rows = []
    for time, path in read_series(out):
        data = read_vtu(path)
        speeds, heights = data["velocity"][0::3], data["Points"][dimension - 1::3]
        rows.append((time, 1000*DEPTH*(U - mean(speeds)), heights, speeds))
    return rows


curves, profiles = [], []
for spacing, dimension in case.pick(((0.01, 2), (0.005, 2)), ((0.01, 2), (0.005, 2), (0.0025, 2), (0.005, 3))):
    rows = run(spacing, dimension)
    time, lost, heights, speeds = rows[-1]
    expected = 1000*U*thickness(time)/8
    name = f"{dimension}-D, {spacing*1000:g} mm"
    case.figure(f"{name}: momentum lost, {lost:.3f} against {expected:.3f} kg/(m s), deviation", lost/expected - 1, "within 0.15",
                abs(lost/expected - 1) <= 0.15)
    # A wall that brakes by mu u/s takes a tenth of this at 5 mm.
    case.hold(f"{name}: momentum lost within a third", abs(lost/expected - 1) <= 1/3)
    curves.append((name, [r[0] for r in rows], [r[1] for r in rows], False))
    layers = [[u for y, u in zip(heights, speeds) if k*0.01 <= y < (k + 1)*0.01] for k in range(4)]
    profiles.append((name, [(k + 0.5)*0.01 for k in range(4)], [mean(layer) for layer in layers], True))
times, ys = [k/50 for k in range(26)], [k/2000 for k in range(1, 81)]
case.plot("Momentum lost per area", "t, s", "kg/(m s)", curves + [("turbulent layer", times, [1000*U*thickness(t)/8 for t in times], False)])
case.plot("Speed at 0.5 s, by layers of 10 mm", "height, m", "m/s", profiles + [
    ("1/7 power", ys, [U*min(1, y/thickness(0.5))**(1/7) for y in ys], False)])
case.finish()
