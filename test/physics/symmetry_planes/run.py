#!/usr/bin/python3
"""A sinking sphere, whole and as a quarter between two planes of symmetry."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, read_table, write_quarter_sphere

case = Case("symmetry_planes", "Planes of symmetry")

SIDE, HALF, G, RHO, DENSITY, END = 0.1, 0.2, 9.81, 1000, 2000, 0.1
FALL = END*G*(DENSITY - RHO)/(DENSITY + RHO/2)


def sink(kind, across):
    """Downward velocity at the end over theory."""
    low = -HALF if kind == "whole" else 0
    if kind == "whole":
        shape = {"mesh": str(case.folder.parents[1] / "meshes" / "sphere.obj"), "scale": SIDE}
    else:
        write_quarter_sphere(case.out / "quarter.obj", SIDE/2)
        shape = {"mesh": "quarter.obj"}
    label = f"{kind}_{across}"
    box = {"min": [low, low, -HALF], "max": [HALF]*3}
    scene = case.write_scene(label, {
        "domain": box, "gravity": [0, 0, -G], "spacing": SIDE/across, "end_time": END,
        "fluids": [{"name": "water", "density": RHO, "viscosity": 0, "fill": [{"box": box}]}],
        "bodies": [{"name": "ball", "dynamics": "free", "density": DENSITY, "locked": "x,y,turn", **shape}],
        "output": {"interval": 0.01, "fields": ["velocity"], "surfaces": False}})
    return -read_table(case.run(label, scene=scene) / "bodies.csv")["velocity_z"][-1]/FALL


for across in case.pick((8,), (8, 12, 16)):
    whole, quarter = sink("whole", across), sink("quarter", across)
    case.state(f"{across} across: velocity of the whole sphere over theory", whole)
    case.figure(f"{across} across: velocity of the quarter over that of the whole", quarter/whole, "1 within 0.02",
                abs(quarter/whole - 1) <= 0.02)
    # 5 % seen at 8 across; of first order in the spacing.
    case.hold(f"{across} across: quarter within 6 % of the whole", abs(quarter/whole - 1) <= 0.06)
case.finish()
