#!/usr/bin/python3
"""A screen that a carriage draws through a closed flume: all water must pass it, so that its force is known."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, mean, read_table

METHODS = ("dfsph", "isph", "wcsph", "eisph")
case = Case("carried_screen", "A screen that a carriage draws")

RHO, G, LENGTH, DEPTH, LOSS, SPEED, MASS = 1000, 9.81, 0.8, 0.16, 8, 0.1, 20
FORCE = LOSS*RHO/2*SPEED**2*DEPTH        # N/m, of water that passes at SPEED
BEGIN, END = 2, 4


def run(method, layers, name, carriage, joints=()):
    label = f"{name}_{method}_{layers}"
    body = {"name": "carriage", "box": {"min": [0.18, 0.2], "max": [0.22, 0.22]}, **carriage}
    return case.run(label, scene=case.write_scene(label, {
        "dimension": 2, "method": method, "domain": {"min": [0, 0], "max": [LENGTH, 0.24]}, "spacing": DEPTH/layers,
        "end_time": END, "gravity": [0, -G],
        "fluids": [{"name": "water", "density": RHO, "fill": [{"box": {"min": [0, 0], "max": [LENGTH, DEPTH]}}]}],
        "bodies": [body], "joints": list(joints),
        "porous_zones": [{"name": "screen", "body": "carriage", "screen": {"loss": LOSS}, "direction": [1, 0],
                          "box": {"min": [0.18, 0], "max": [0.22, 0.2]}}],
        "output": {"interval": 0.02, "surfaces": False, "fields": ["velocity"]}}))


def tow(method, layers):
    """At a speed that is given."""
    out = run(method, layers, "towed", {"motion": {"translation": {"velocity": [SPEED, 0], "ramp": 1}}})
    table = read_table(out/"bodies.csv")
    force = [-f for f in table["mean_viscous_force_x"]]
    label = f"towed, {method}, {layers} layers"
    off = mean([f for t, f in zip(table["time"], force) if t > BEGIN])/FORCE - 1
    case.figure(f"{label}: force, deviation", off, "within 0.03", abs(off) <= 0.03)
    # Of a carried zone: the heat, less what the body gives. The water as a whole stays where it is.
    work, given = read_table(out/"porous_zones.csv")["screen_work"][-1], table["motion_work"][-1]
    case.figure(f"{label}: what the water lost over the work of the motion", work/given, "within 0.02", abs(work/given) <= 0.02)
    return label, table["time"], force, False


def push(method, layers):
    """By a force that is given."""
    out = run(method, layers, "pushed", {"dynamics": "free", "density": MASS/(0.04*0.02), "force": [FORCE, 0]},
              [{"name": "rail", "kind": "slide", "body": "carriage", "point": [0.2, 0.21], "axis": [1, 0]}])
    table = read_table(out/"bodies.csv")
    speed = table["velocity_x"]
    label = f"pushed, {method}, {layers} layers"
    off = mean([v for t, v in zip(table["time"], speed) if t > BEGIN])/SPEED - 1
    case.figure(f"{label}: speed at the end, deviation", off, "within 0.02", abs(off) <= 0.02)
    return label, table["time"], speed, False


towed, pushed = [], []
for method in case.pick(("dfsph", "isph"), METHODS):
    for layers in case.pick((16,), (8, 16, 32)):
        towed.append(tow(method, layers))
        pushed.append(push(method, layers))
case.plot("Force on a screen that is towed", "t, s", "N", towed)
case.plot("Speed of a screen that is pushed", "t, s", "m/s", pushed)
case.finish()
