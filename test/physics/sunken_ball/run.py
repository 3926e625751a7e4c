#!/usr/bin/python3
"""A heavy ball under water: what presses it as it sets off, and when it lies on the floor."""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, mean, read_table

case = Case("sunken_ball", "A ball that sinks and lies on the floor")

RHO, G, RADIUS, DENSITY = 1000, 9.81, 0.05, 7800
VOLUME = 4/3*math.pi*RADIUS**3


def compute(label, method, across, side, depth, height, end):
    path = case.write_scene(label, {
        "method": method, "domain": {"min": [0, 0, 0], "max": [side, side, depth + 0.05]}, "gravity": [0, 0, -G],
        "spacing": 2*RADIUS/across, "end_time": end,
        "fluids": [{"name": "water", "density": RHO, "viscosity": 1e-3,
                    "fill": [{"box": {"min": [0, 0, 0], "max": [side, side, depth]}}]}],
        "bodies": [{"name": "ball", "sphere": {"centre": [side/2, side/2, height], "radius": RADIUS}, "density": DENSITY,
                    "dynamics": "free"}],
        "output": {"interval": 0.01, "surfaces": False, "fields": ["velocity"]}})
    return read_table(case.run(label, scene=path) / "bodies.csv")


curves = []
for method in case.pick(("dfsph",), ("dfsph", "isph", "wcsph")):
    for across in case.pick((8,), (8, 12)):
        name = f"{method}, {across} across"
        table = compute(f"fall_{method}_{across}", method, across, 0.5, 0.45, 0.25, 0.02)
        acceleration = -table["velocity_z"][-1]/table["time"][-1]
        force = mean(table["mean_pressure_force_z"][1:])/(RHO*VOLUME*(G + acceleration/2))
        case.figure(f"{name}, falling: force over that of theory, deviation", force - 1, "within 0.03", abs(force - 1) <= 0.03)
        end = case.pick(0.45, 0.9)
        table = compute(f"rest_{method}_{across}", method, across, 0.24, 0.2, 0.08, end)
        ratio = [f/(RHO*G*VOLUME) for f in table["mean_pressure_force_z"]]
        rest = mean([r for t, r in zip(table["time"], ratio) if t > 2/3*end])
        case.figure(f"{name}, at rest: force over buoyancy, deviation", rest - 1, "within 0.05", abs(rest - 1) <= 0.05)
        curves.append((name, table["time"][1:], ratio[1:], False))
case.plot("Force of the water on a ball that lands on the floor", "t, s", "F / rho g V", curves)
case.finish()
