#!/usr/bin/python3
"""A drop in another liquid swings about its round shape with the frequency of Rayleigh and Lamb."""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, crossings, mean, read_series, read_vtu, write_prism

case = Case("oscillating_drop", "A drop that swings")

RADIUS, STRETCH, TENSION, HALF = 0.25, 1.05, 30, 0.75
LAMB = 2*math.pi/math.sqrt(6*TENSION/((1000 + 100)*RADIUS**3))


def scene(label, d):
    profile = [(STRETCH*RADIUS*math.cos(t), RADIUS/STRETCH*math.sin(t)) for t in (2*math.pi*k/96 for k in range(96))]
    write_prism(case.out/"drop.obj", profile, -0.1, 0.1)
    fluids = [{"name": "outer", "density": 100, "viscosity": 0.02, "fill": [{"box": {"min": [-HALF, -HALF], "max": [HALF, HALF]}}]},
              {"name": "drop", "density": 1000, "viscosity": 0.2, "fill": [{"mesh": str((case.out/"drop.obj").resolve())}]}]
    return case.write_scene(label, {
        "method": "isph", "dimension": 2, "domain": {"min": [-HALF, -HALF], "max": [HALF, HALF]}, "gravity": [0, 0], "spacing": d,
        "end_time": 2.5, "fluids": fluids, "interfaces": [{"fluid": "drop", "to_fluid": "outer", "tension": TENSION}],
        "output": {"interval": 0.04, "surfaces": False, "fields": ["material"]}})


def find_shape(path):
    """How much longer the drop is along x than along y, by second moments; 0: it is round."""
    data = read_vtu(path)
    own = [(x, y) for x, y, m in zip(data["Points"][0::3], data["Points"][1::3], data["material"]) if m]
    x, y = mean([p[0] for p in own]), mean([p[1] for p in own])
    a, b = mean([(p[0] - x)**2 for p in own]), mean([(p[1] - y)**2 for p in own])
    return (a - b)/(a + b)


curves = []
for across in case.pick((10,), (10, 20)):
    out = case.run(f"drop_{across}", scene=scene(f"drop_{across}", RADIUS/across))
    times, shapes = zip(*((t, find_shape(path)) for t, path in read_series(out)))
    round_at = crossings(times, shapes)
    case.hold(f"{across} spacings: the drop is round at {', '.join(f'{t:.3f}' for t in round_at)} s", len(round_at) >= 3)
    period = round_at[2] - round_at[0]
    case.figure(f"{across} spacings to the radius: period over that of Lamb", period/LAMB, "within 0.03", abs(period/LAMB - 1) <= 0.03)
    case.hold(f"{across} spacings: period {period:.3f} s, within 10 % of {LAMB:.3f} s", abs(period/LAMB - 1) <= 0.1)
    curves.append((f"{across} spacings to the radius", times, shapes, False))
case.plot("Shape of the drop", "t, s", "difference of second moments over their sum", curves)
case.finish()
