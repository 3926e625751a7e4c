#!/usr/bin/python3
"""Free rigid bodies on jelly and in mlsmpm water."""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, mean, read_table

case = Case("jelly", "Free bodies on jelly and in water")

SIDE, GRAVITY, DENSITY = 0.1, 9.81, 500


def settle(label, dim, solid, fill, start, end, friction):
    """Rows of the body."""
    middle = 0.3
    out = case.solids(label, {
        "domain": {"min": [0]*dim, "max": [0.6]*(dim - 1) + [0.5], "friction": 0.5,
                   "walls": {axis: ["separate", "slip"] for axis in "xyz"[dim - 1:dim]}},
        "gravity": [0]*(dim - 1) + [-GRAVITY], "spacing": SIDE/case.pick(8, 12), "end_time": end,
        "solids": [{"name": "matter", **solid, "fill": [{"box": fill}]}],
        "bodies": [{"name": "cube", "dynamics": "free", "friction_coefficient": friction, "density": DENSITY, "box": {
            "min": [-SIDE/2, -SIDE/2, -SIDE/2], "max": [SIDE/2, SIDE/2, SIDE/2]},
            "translation": ([middle]*(dim - 1) + [start] + [0, 0])[:3]}],
        "output": {"interval": end/100, "fields": ["velocity"], "surfaces": False}})
    b, up = read_table(out/"bodies.csv"), "xyz"[dim - 1]
    case.plot(label, "t, s", "height, m", [("centre", b["time"], b[f"position_{up}"], False)])
    return b, up, read_table(out/"history.csv")


for dim in case.pick((2,), (2, 3)):
    weight = DENSITY*SIDE**dim*GRAVITY
    box = {"min": [0.15]*(dim - 1) + [0], "max": [0.45]*(dim - 1) + [0.1]}
    b, up, h = settle(f"jelly_{dim}", dim, {"density": 1000, "youngs_modulus": 5e4, "damping": 5}, box, 0.25, 2.0, 0.5)
    force = [p + v for p, v in zip(b[f"mean_pressure_force_{up}"], b[f"mean_viscous_force_{up}"])]
    heights, speeds = b[f"position_{up}"], b[f"velocity_{up}"]
    carried = mean(force[-20:])/weight
    case.figure(f"{dim}-D jelly: carried weight at rest", carried, "1 within 1 %", abs(carried - 1) <= 0.01)
    case.state(f"{dim}-D jelly: indentation at rest, sides", (0.15 - heights[-1])/SIDE)
    case.state(f"{dim}-D jelly: speed of rebound over that of impact", max(speeds)/-min(speeds))
    case.hold("it bounced", max(speeds) > 0.1)
    # p = 490 Pa on 0.1 m of 5e4 Pa: 1 % of 0.1 m, twice that with the edges; half a spacing of contact aside.
    case.hold("it rests on the jelly, not in it", 0.14 < heights[-1] < 0.158)
    case.hold("it is at rest", max(heights[-10:]) - min(heights[-10:]) < 1e-4)
    case.hold("weight carried within 2 %", abs(carried - 1) <= 0.02)
    energy = [0.5*v*v + GRAVITY*z for v, z in zip(speeds, heights)]
    # A body moves before it is kicked: in fall it gains g^2 dt/2 per second and kilogram.
    gain = GRAVITY**2*max(h["dt"])/2*0.15
    case.hold("the body never had more energy than at the start", max(energy) <= energy[0] + gain)
    box = {"min": [0]*dim, "max": [0.6]*(dim - 1) + [0.2]}
    b, up, h = settle(f"water_{dim}", dim, {"model": "liquid", "bulk_modulus": 2e5, "damping": 4}, box, 0.25, 3.0, 0)
    heights = b[f"position_{up}"]
    level = 0.2*(1 + 0.5*SIDE**dim/(0.2*0.6**(dim - 1)))
    draft = (level - mean(heights[-20:]) + SIDE/2)/SIDE
    case.figure(f"{dim}-D water: draft over height", draft, "0.5 within 2 %", abs(draft - 0.5) <= 0.02)
    turn = 2*math.acos(min(1, abs(b["orientation_w"][-1])))
    case.state(f"{dim}-D water: turned by, degrees", math.degrees(turn))
    # Where water ends at a body is known to a spacing: half of it is the distance kept, the rest the smear of contact
    # over a cell of the grid. Seen too high on both occasions (0.38 at 8, 0.46 at 12 spacings): a miss, kept here.
    case.hold("draft within a spacing", abs(draft - 0.5) <= 1/case.pick(8, 12))
case.finish()
