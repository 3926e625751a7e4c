#!/usr/bin/python3
"""A vessel that rolls for many steps loses no particle, and its water no volume."""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, mean, read_series, read_table, read_vtu

METHODS = ("dfsph", "wcsph", "isph", "eisph")
case = Case("vessel_leak", "A vessel that rolls for 100 000 steps")

L, HEIGHT, DEPTH, SPACING, ROLL, PERIOD, MARGIN = 0.5, 0.3, 0.1, 0.0125, math.radians(8), 1.0, 0.12
END = {"dfsph": 216, "wcsph": 26, "isph": 330, "eisph": 33}          # s, for 100 000 steps


def compute(method, end):
    content = {"dimension": 2, "method": method, "domain": {"min": [-MARGIN, -MARGIN], "max": [L + MARGIN, HEIGHT + MARGIN]},
               "spacing": SPACING, "end_time": end, "fluids": [{"name": "water", "fill": [{"vessel": "tank", "level": DEPTH}]}],
               "bodies": [{"name": "tank", "vessel": True, "box": {"min": [0, 0], "max": [L, HEIGHT]},
                           "motion": {"yaw": {"center": [L/2, 0, 0], "amplitude": 8, "period": PERIOD, "ramp": PERIOD}}}],
               "output": {"interval": end/12, "surfaces": False, "fields": ["velocity"]}}
    out = case.run(method, scene=case.write_scene(method, content))
    history, beyond, heights = read_table(out/"history.csv"), 0, []
    for time, path in read_series(out):
        rise = 1 if time >= PERIOD else 0.5*(1 - math.cos(math.pi*time/PERIOD))
        c, s = math.cos(ROLL*rise*math.sin(2*math.pi*time/PERIOD)), math.sin(ROLL*rise*math.sin(2*math.pi*time/PERIOD))
        points = read_vtu(path)["Points"]
        places = [(c*(x - L/2) + s*y + L/2, c*y - s*(x - L/2)) for x, y in zip(points[0::3], points[1::3])]
        beyond += sum(max(-x, x - L, -y, y - HEIGHT) > 0.5*SPACING for x, y in places)
        heights.append(mean([y for _, y in places])/(DEPTH/2))
    lost = int(history["particles_lost"][-1])
    low = mean(heights[6:])
    text = f"{method}, {'a few' if case.smoke else int(history['step'][-1])} steps"
    case.figure(f"{text}: particles lost", lost, "0", lost == 0)
    case.figure(f"{text}: particles beyond the walls", beyond, "0", beyond == 0)
    case.figure(f"{method}: mean height over half the still depth", low, ">= 0.97", low >= 0.97)
    curves.append((method, [i/12 for i in range(len(heights))], heights, False))


curves = []
for method in METHODS:
    compute(method, case.pick(1.5, END[method]))
case.plot("Mean height of the water over half the still depth", "time over that of the run", "1", curves)
case.finish()
