#!/usr/bin/python3
"""A hull whose centre of mass is given heels as its metacentre says, or capsizes."""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, mean, read_table

case = Case("heel", "Heel of a hull")

G, RHO, WIDE, HIGH, DRAFT, KEEL = 9.81, 1000, 0.3, 0.2, 0.1, 0.2
BM, WEIGHT = WIDE**2/(12*DRAFT), RHO*G*WIDE*DRAFT


def roll(method, deep, above_keel, moment, resistance):
    """Times and angles of the hull, degrees, at a draft of `deep` spacings."""
    label = f"{method}_{deep}_{above_keel}"
    scene = case.write_scene(label, {
        "method": method, "dimension": 2, "domain": {"min": [0, 0], "max": [1.5, 0.5]}, "gravity": [0, -G], "spacing": DRAFT/deep,
        "end_time": 3, "fluids": [{"name": "water", "fill": [{"box": {"min": [0, 0], "max": [1.5, KEEL + DRAFT]}}]}],
        "bodies": [{"name": "hull", "box": {"min": [0.6, KEEL], "max": [0.6 + WIDE, KEEL + HIGH]}, "dynamics": "free",
                    "air_resistance": resistance, "mass": RHO*WIDE*DRAFT, "torque": [0, 0, moment],
                    "centre_of_mass": [0.6 + WIDE/2, KEEL + above_keel]}],
        "output": {"interval": 0.02, "surfaces": False}})
    table = read_table(case.run(label, scene=scene) / "bodies.csv")
    return table["time"], [math.degrees(2*math.atan2(z, w)) for w, z in zip(table["orientation_w"], table["orientation_z"])]


curves = []
for method in "dfsph", "isph":
    for deep in case.pick((6,), (6, 10, 16)):
        gm = DRAFT/2 + BM - 0.05
        times, angles = roll(method, deep, 0.05, WEIGHT*gm*math.sin(math.radians(4)), 4)
        share = mean(angles[-len(angles)//3:])/4
        curves.append((f"{method}, {deep} spacings deep", times, angles, False))
        case.figure(f"{method}, {deep} spacings deep: heel over theory", share, "1 within 0.05", abs(share - 1) <= 0.05)
        case.hold(f"{method}, {deep} spacings deep: heel within 10 %", abs(share - 1) <= 0.1)
case.plot("Heel under a moment", "t, s", "angle, degrees", curves)
for method in case.pick((), ("dfsph", "isph")):
    most = max(roll(method, 10, 0.15, 0.2, 0)[1])
    case.figure(f"{method}, 10 spacings deep, GM -0.025 m: farthest heel, degrees", most, "above 150", most > 150)
case.finish()
