#!/usr/bin/python3
"""Balls and boxes on an incline, against the formulas of mechanics."""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, read_table

case = Case("incline_rigid", "Rigid bodies on an incline")

G, THETA, R = 9.81, math.radians(30), 0.1
out = case.run("incline", *([] if case.smoke else ["--set", "time_step=2e-4", "--set", "end_time=1.4"]))
table = read_table(out / "bodies.csv")


def column(body, name):
    return [v for v, b in zip(table[name], table["name"]) if b == body]


time = column("rolling", "time")
exact = {"rolling": 5/7*G*math.sin(THETA), "slipping": G*(math.sin(THETA) - 0.1*math.cos(THETA)),
         "sliding": G*(math.sin(THETA) - 0.3*math.cos(THETA))}
curves = []
for body, a in exact.items():
    way = [x - 0.5 for x in column(body, "position_x")]
    error = way[-1]/(0.5*a*time[-1]**2) - 1
    case.figure(f"{body}: way after {time[-1]:g} s over the formula, minus 1", error, "within 0.02", abs(error) <= 0.02)
    # A step of 1 ms is of first order: dt/t = 0.001 of the way.
    case.hold(f"{body}: within 0.5 %", abs(error) <= 0.005)
    curves += [(body, time, way, False), (body + ", formula", time, [0.5*a*t*t for t in time], True)]
spin = column("rolling", "angular_velocity_y")[-1]*R/column("rolling", "velocity_x")[-1]
case.figure("rolling: turn times radius over speed", spin, "1 within 0.001", abs(spin - 1) <= 0.001)
case.hold("it rolls", abs(spin - 1) <= 0.001)
slip = column("slipping", "angular_velocity_y")[-1]/(2.5*0.1*G*math.cos(THETA)/R*time[-1])
case.figure("slipping: turn over 5/2 mu g cos t / r", slip, "1 within 0.02", abs(slip - 1) <= 0.02)
case.hold("it turns by friction alone", abs(slip - 1) <= 0.02)
crept = column("sticking", "position_x")[-1] - 0.5
case.figure("sticking: way of the box that must stay, m", crept, "below 1e-6", abs(crept) <= 1e-6)
case.hold("it stays", abs(crept) <= 1e-6)
case.plot("On an incline of 30 degrees", "t, s", "x - x0, m", curves)
case.finish()
