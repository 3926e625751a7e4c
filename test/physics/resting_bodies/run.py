#!/usr/bin/python3
"""Bodies come to rest and stay: a tower of ten, balls that bounce."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, read_table

case = Case("resting_bodies", "Rigid bodies that bounce and rest")


def column(table, body, name):
    return [v for v, b in zip(table[name], table["name"]) if b == body]


def drift(table):
    """How far the boxes of the tower are from where they were put, m."""
    worst = 0
    for k in range(10):
        x, y, z = (column(table, f"box{k}", f"position_{a}")[-1] for a in "xyz")
        worst = max(worst, abs(x - 0.35), abs(y - 0.35), abs(z - 0.05 - 0.1*k))
    return worst


END = case.pick(2, 10)
WEIGHT = 1000*0.1**3*9.81
fine = read_table(case.run("fine", "--until", END) / "bodies.csv")
for k, e in enumerate((0.3, 0.6, 0.9)):
    z, v = (column(fine, f"ball{k}", name) for name in ("position_z", "velocity_z"))
    up = next(i for i, speed in enumerate(v) if speed > 0)
    top = max(z[up:next(i for i in range(up, len(v)) if v[i] < 0) + 1]) - 0.05
    error = top/(0.5*e*e) - 1
    case.figure(f"ball with e = {e}: height after the first bounce over e^2 h, minus 1", error, "within 0.02",
                abs(error) <= 0.02)
    # It bounces where its step begins, up to v dt = 3 mm above the floor, and outputs are 5 ms apart.
    case.hold(f"e = {e}: within 4 %", abs(error) <= 0.04)
coarse = read_table(case.run("coarse", "--until", END, "--set", f"time_step={1/60}", "--set", "output.interval=0.1") /
                    "bodies.csv")
for label, table, dt in (("steps of 1 ms", fine, 1e-3), ("60 steps a second", coarse, 1/60)):
    worst = drift(table)
    speeds = [sum(column(table, f"box{k}", f"velocity_{a}")[-1]**2 for a in "xyz") for k in range(10)]
    energy = max(speeds)/(9.81*dt)**2
    case.figure(f"tower after {END} s, {label}: farthest from its place, m", worst, "<= 0.001", worst <= 0.001)
    case.figure(f"tower after {END} s, {label}: energy of a box over that of one step's fall", energy, "<= 1e-6",
                energy <= 1e-6)
    case.hold(f"{label}: the tower stays and rests", worst <= 0.001 and energy <= 1e-6)
    # what bodies and sides do to each box carries it: the one below less the ones above
    load = max(abs(column(table, f"box{k}", "mean_contact_force_z")[-1]/WEIGHT - 1) for k in range(10))
    case.figure(f"tower after {END} s, {label}: contact force on a box over its weight, minus 1", load, "within 0.01",
                load <= 0.01)
    case.hold(f"{label}: contact carries every box", load <= 0.01)
case.plot("Balls on the floor", "t, s", "height, m",
          [(f"e = {e}", column(fine, f"ball{k}", "time"), [z - 0.05 for z in column(fine, f"ball{k}", "position_z")],
            False) for k, e in enumerate((0.3, 0.6, 0.9))])
case.finish()
