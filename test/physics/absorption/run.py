#!/usr/bin/python3
"""A piston that absorbs: waves that it gives back, at the end of a flume and while it makes waves itself."""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, read_table
from waves import G, amplitude, split, wave_number

case = Case("absorption", "Active absorption by a piston")

DEPTH, STEEP, GAUGES = 0.3, 0.1, 24


def find_waves(table, xs, k, omega, begin, end):
    """Amplitudes of the waves that go and that come back, from gauges between two times."""
    at = [n for n, t in enumerate(table["time"]) if begin < t <= end]
    times = [table["time"][n] for n in at]
    return split(xs, [amplitude(times, [table[f"g{g}_level"][n] - DEPTH for n in at], omega) for g in range(GAUGES)], k)


def flume(method, layers, period, at_end):
    d, k = DEPTH/layers, wave_number(DEPTH, period)
    wave, block, room = 2*math.pi/k, 6*d, round(0.6*layers)*d
    length, top = round(2.5*wave/d)*d, 1.8*DEPTH
    xs = [round(1.2*DEPTH + wave*i/(GAUGES - 1), 4) for i in range(GAUGES)]
    maker = {"depth": DEPTH, "ramp": 2*period, "absorb": not at_end, "regular": {"height": STEEP*DEPTH, "period": period}}
    bodies = [{"name": "piston", "box": {"min": [-block, 0], "max": [0, top]}, "motion": {"piston": maker}}]
    if at_end:
        beach = {"depth": DEPTH, "direction": [-1, 0], "absorb": True, "absorb_period": period}
        bodies += [{"name": "beach", "box": {"min": [length, 0], "max": [length + block, top]}, "motion": {"piston": beach}}]
    end = round((12 if at_end else case.pick(14, 18))*period, 6)
    content = {"dimension": 2, "method": method, "spacing": d, "end_time": end, "gravity": [0, -G],
               "domain": {"min": [-block - room, 0], "max": [length + (block + room)*at_end, 2*DEPTH]},
               "fluids": [{"name": "water", "density": 1000, "viscosity": 0, "fill": [{"box": {"min": [0, 0], "max": [length, DEPTH]}}]}],
               "bodies": bodies, "probes": [{"name": f"g{i}", "kind": "level", "position": [x, 0]} for i, x in enumerate(xs)],
               "output": {"interval": end, "probe_interval": period/60, "fields": ["velocity"], "surfaces": False}}
    label = f"{'end' if at_end else 'maker'}_{method}_{layers}_{period}"
    table = read_table(case.run(label, scene=case.write_scene(label, content))/"probes.csv")
    omega, name = 2*math.pi/period, f"{method}, kh = {k*DEPTH:.2f}, h/{layers}"
    away, back = find_waves(table, xs, k, omega, end - 4*period, end)
    if at_end:
        case.figure(f"{name}: at the end of a flume, waves that come back over those that go", back/away, "below 0.05", back/away < 0.05)
        return name, table
    first, _ = find_waves(table, xs, k, omega, 4*period, 6*period)
    case.figure(f"{name}: before a wall, what the maker gives back", abs(away - first)/back, "below 0.05", abs(away - first)/back < 0.05)
    # Without absorption the waves have doubled by then.
    case.hold(f"{name}: the waves that go are within 15 % of the first", abs(away/first - 1) < 0.15)
    return name, table


runs = [("isph", 12, 1.2)] if case.smoke else [("isph", 12, 1.2), ("isph", 16, 1.2), ("isph", 20, 1.2), ("isph", 16, 0.9),
                                               ("isph", 16, 1.8), ("dfsph", 12, 1.2), ("dfsph", 20, 1.2), ("eisph", 10, 1.2),
                                               ("wcsph", 10, 1.2)]
curves = []
for method, layers, period in runs:
    flume(method, layers, period, True)
    name, table = flume(method, layers, period, False)
    curves.append((name, table["time"], [y - DEPTH for y in table["g0_level"]], False))
case.plot("Level at 1.2 depths before a maker that absorbs, and a wall", "t, s", "m", curves)
case.finish()
