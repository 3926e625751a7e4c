#!/usr/bin/python3
"""Sensors in a tank: a wall at rest against hydrostatics, the swing after a tilt against linear theory."""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, mean, read_table

case = Case("sensors", "Sensors in a tank")

G, RHO, LENGTH, DEPTH = 9.81, 1000, 0.9, 0.2
D = case.pick(0.02, 0.01)
TILT = 4
SLOPE = math.tan(math.radians(TILT))
WALL = {"name": "wall", "kind": "patch", "position": [LENGTH, DEPTH/2], "normal": [-1, 0], "length": DEPTH}
SENSORS = [WALL, {"name": "right", "kind": "level", "position": [LENGTH, 0]},
           {"name": "flow", "kind": "flow", "position": [LENGTH/2, 0.2], "normal": [1, 0], "length": 0.4},
           {"name": "half", "kind": "volume", "position": [0.75*LENGTH, 0.2], "length": LENGTH/2, "height": 0.4}]


def scene(method, tilt, end):
    turn = math.radians(tilt)
    return {"method": method, "dimension": 2, "domain": {"min": [0, 0], "max": [LENGTH, 0.4]},
            "gravity": [G*math.sin(turn), -G*math.cos(turn)], "spacing": D, "end_time": end, "probes": SENSORS,
            method: {"support": 2.5},
            "fluids": [{"name": "water", "fill": [{"box": {"min": [0, 0], "max": [LENGTH, DEPTH]}}]}],
            "output": {"interval": end/4}}


def theory(t):
    waves = 0
    for n in range(1, 40, 2):
        k = n*math.pi/LENGTH
        waves += math.cos(math.sqrt(G*k*math.tanh(k*DEPTH))*t)/n**2
    return DEPTH + SLOPE*LENGTH/2*(1 - 8/math.pi**2*waves)


def run(method, what, tilt, end):
    label = f"{what}_{method}"
    return read_table(case.run(label, scene=case.write_scene(label, scene(method, tilt, end))) / "probes.csv")


METHODS = ["dfsph", "isph", "eisph", "wcsph"]
curves = []
for method in METHODS:
    table = run(method, "rest", 0, 0.4)
    late = [k for k, t in enumerate(table["time"]) if t > 0.2]

    def last(column):
        return mean([table[column][k] for k in late])
    force = last("wall_force_x")/(RHO*G*DEPTH**2/2) - 1
    moment = last("wall_moment_z")/(RHO*G*DEPTH**3/12) - 1
    level = (last("right_level") - DEPTH)/D
    case.figure(f"{method}: force on the wall at rest, deviation", force, "within 0.03", abs(force) <= 0.03)
    case.figure(f"{method}: its moment, deviation", moment, "within 0.1", abs(moment) <= 0.1)
    case.figure(f"{method}: level at rest, error in spacings", level, "within 0.2", abs(level) <= 0.2)
    case.hold(f"{method}: force on the wall within 10 %", abs(force) <= 0.1)
    table = run(method, "tilt", TILT, 1.4)
    t, h = table["time"], table["right_level"]
    off = mean([abs(a - theory(b)) for a, b in zip(h, t)])/(SLOPE*LENGTH)
    case.figure(f"{method}: level at the wall against linear theory", off, "<= 0.05", off <= 0.05)
    case.hold(f"{method}: within 0.15 of the swing", off <= 0.15)
    jitter = max(abs(a - 2*b + c) for a, b, c in zip(h[2:], h[3:], h[4:]))/D
    case.figure(f"{method}: largest second difference of the level, spacings", jitter, "<= 0.2", jitter <= 0.2)
    half = [k for k in range(len(t)) if 0.05 < t[k] < 0.6]
    passed = sum((table["flow_flow"][k] + table["flow_flow"][k - 1])/2*(t[k] - t[k - 1]) for k in half[1:])
    change = table["half_volume"][half[-1]] - table["half_volume"][half[0]]
    case.figure(f"{method}: flow against the change of volume", passed/change - 1, "within 0.1",
                abs(passed/change - 1) <= 0.1)
    curves.append((method, t, [(x - DEPTH)*1000 for x in h], False))
exact = [k*0.01 for k in range(141)]
case.plot("Level at the right wall after a tilt of 4 degrees", "t, s", "mm", curves + [
    ("linear theory", exact, [(theory(x) - DEPTH)*1000 for x in exact], True)])
case.finish()
