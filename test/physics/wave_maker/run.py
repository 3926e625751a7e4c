#!/usr/bin/python3
"""Waves of a piston against Biesel, what a beach gives back, a solitary wave, a focused group and recorded levels."""
import bisect
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, read_table
from waves import G, amplitude, solve, split, wave_number

case = Case("wave_maker", "Wave maker, beach and solitary wave",
            methods=("wcsph", "isph", "eisph"))

DEPTH = 0.3
GAUGES = 40


PEAK, FOCUS, MIDDLE = 1.2, 3.0, 1.5          # s; m, gauges


def compute(label, spacing, length, top, end, motion, xs, zones=()):
    block = 6*spacing
    content = {"dimension": 2, "domain": {"min": [-3*block, 0], "max": [length, top]}, "spacing": spacing, "end_time": end,
               "fluids": [{"name": "water", "density": 1000, "viscosity": 0, "fill": [{"box": {"min": [0, 0], "max": [length, DEPTH]}}]}],
               "bodies": [{"name": "piston", "box": {"min": [-block, 0], "max": [0, top - spacing]}, "motion": {"piston": motion}}],
               "damping_zones": list(zones),
               "probes": [{"name": f"g{i}", "kind": "level", "position": [x, 0]} for i, x in enumerate(xs)],
               "output": {"interval": end, "probe_interval": end/400, "fields": ["velocity"], "surfaces": False}}
    table = read_table(case.run(label, scene=case.write_scene(label, content)) / "probes.csv")
    return table["time"], [[y - DEPTH for y in table[f"g{i}_level"]] for i in range(len(xs))]


def regular(layers, period, height):
    spacing, k = DEPTH/layers, wave_number(DEPTH, period)
    wave, name = 2*math.pi/k, f"kh = {k*DEPTH:.2f}, H = {height/DEPTH:.2g} h, h/{layers}"
    lengths = case.pick(1.2, 2)
    length = round((1.5*DEPTH + (lengths + 1)*wave)/spacing)*spacing
    end = round((4 + 1.5*lengths)*period, 6)
    xs = [round(1.5*DEPTH + wave*i/(GAUGES - 1), 4) for i in range(GAUGES)]
    zone = {"box": {"min": [length - wave, 0], "max": [length, 2*DEPTH]}, "rate": 10/period}
    motion = {"depth": DEPTH, "ramp": 2*period, "regular": {"height": height, "period": period}}
    times, levels = compute(f"regular_{layers}_{period}_{height}", spacing, length, 2*DEPTH, end, motion, xs, [zone])
    at = [n for n, t in enumerate(times) if t > end - 2*period]
    found = [amplitude([times[n] for n in at], [y[n] for n in at], 2*math.pi/period) for y in levels]
    away, back = split(xs, found, k)
    case.figure(f"{name}: height over that asked for, deviation", 2*away/height - 1, "within 0.03", abs(2*away/height - 1) <= 0.03)
    case.figure(f"{name}: with the beach, waves that come back over those that go", back/away, "below 0.1", back/away < 0.1)
    # 0.90 to 0.97 seen at 15 to 30 layers; waves lose height on their way.
    case.hold(f"{name}: height within 20 %", abs(2*away/height - 1) <= 0.2)
    return times, levels[0], name


def solitary(layers, height):
    spacing, name = DEPTH/layers, f"solitary, H = {height/DEPTH:.2g} h, h/{layers}"
    length, c = 30*DEPTH, math.sqrt(G*(DEPTH + height))
    end = 29*DEPTH/c + 2*4.1*DEPTH/math.sqrt(0.75*height/DEPTH)/c/2
    xs = [5*DEPTH, 25*DEPTH]
    times, levels = compute(f"solitary_{layers}", spacing, length, 2*DEPTH, end, {"depth": DEPTH, "solitary": {"height": height}}, xs)

    def crest(level):
        """The top by a parabola through what is near the highest sample: levels come in steps."""
        top = max(range(len(level)), key=lambda n: level[n])
        near = range(max(top - 8, 0), min(top + 9, len(level)))
        a, _, bend = (z.real for z in solve([[1 + 0j, n - top + 0j, (n - top)**2 + 0j] for n in near],
                                            [complex(level[n]) for n in near]))
        return a if bend < 0 else max(level)
    first, last = crest(levels[0]), crest(levels[1])
    case.figure(f"{name}: height at 5 depths over that asked for, deviation", first/height - 1, "within 0.05", abs(first/height - 1) <= 0.05)
    case.figure(f"{name}: height 20 depths further over that, deviation", last/first - 1, "within 0.03", abs(last/first - 1) <= 0.03)
    case.hold(f"{name}: keeps two thirds of its height", last > 0.66*first)
    return times, levels, name


def group(label, layers, waves):
    """Levels half way to the focus and there."""
    spacing = DEPTH/layers
    zone = {"box": {"min": [4.2, 0], "max": [6, 2*DEPTH]}, "rate": 10/PEAK}
    motion = {"depth": DEPTH, "ramp": PEAK, **waves}
    return compute(f"{label}_{layers}", spacing, 6, 2*DEPTH, 11, motion, [MIDDLE, FOCUS], [zone])


def focused(layers, height):
    name, time = f"focused group, crest {height/DEPTH:.2g} h, h/{layers}", 8
    times, levels = group(f"focused_{height}", layers,
                          {"focused": {"height": height, "peak_period": PEAK, "distance": FOCUS, "time": time}})
    top = max(range(len(times)), key=lambda n: levels[1][n])
    case.figure(f"{name}: height of the crest over that asked for, deviation", levels[1][top]/height - 1, "within 0.1",
                abs(levels[1][top]/height - 1) <= 0.1)
    case.figure(f"{name}: how late it comes, over the peak period", (times[top] - time)/PEAK, "within 0.05",
                abs(times[top] - time) <= 0.05*PEAK)
    # By dfsph on 12 layers it is 37 % too low and 0.16 periods too early.
    case.hold(f"{name}: the crest is there, within a quarter of a period and 45 %",
              abs(times[top] - time) <= 0.25*PEAK and abs(levels[1][top]/height - 1) <= 0.45)
    return times, levels, name


def recorded(layers, times, levels):
    """The levels half way, read from a file, at another piston: do they come again there and at the focus?"""
    name, path = f"recorded levels, h/{layers}", case.out/f"record_{layers}.csv"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("time [s],G1 [mm]\n" + "".join(f"{t},{1e3*y}\n" for t, y in zip(times, levels[0])))
    again, found = group("recorded", layers, {"recorded": {"file": str(path), "column": "G1", "distance": MIDDLE}})
    for where, given, other in zip(("where they were measured", "twice as far away"), levels, found):
        at = [n for n, t in enumerate(times) if t > 3]
        close = [other[min(bisect.bisect_left(again, times[n]), len(again) - 1)] for n in at]
        size = math.sqrt(sum(given[n]**2 for n in at))
        error = math.sqrt(sum((given[n] - y)**2 for n, y in zip(at, close)))/size
        case.figure(f"{name}: rms of the difference {where} over that of the levels", error, "<= 0.15", error <= 0.15)
        case.hold(f"{name}: rms of the difference {where} below a half", error < 0.5)
    return again, found


many_steps = case.args.method in ("wcsph", "eisph")
all_periods = ((10, 1.2), (10, 0.9), (10, 1.8), (20, 0.9), (20, 1.2), (20, 1.8), (30, 1.2))
curves = []
for layers, period in case.pick(((12, 1.2),), all_periods[:1] if many_steps else all_periods):
    times, level, name = regular(layers, period, 0.15*DEPTH)
    curves.append((name, times, level, False))
case.plot("Level at 1.5 depths", "t, s", "m", curves)
curves = []
for layers in case.pick((10,), (10,) if many_steps else (10, 20)):
    times, levels, name = solitary(layers, 0.3*DEPTH)
    curves += [(f"{name}: {x} depths", times, y, False) for x, y in zip((5, 25), levels)]
case.plot("Solitary wave", "t, s", "m", curves)
if not many_steps:
    curves = []
    for layers, height in case.pick(((12, 0.2*DEPTH),), ((10, 0.2*DEPTH), (20, 0.2*DEPTH), (20, 0.1*DEPTH))):
        times, levels, name = focused(layers, height)
        curves.append((name, times, levels[1], False))
        if case.smoke or (layers, height) == (20, 0.1*DEPTH):
            again, found = recorded(layers, times, levels)
            curves.append((f"its levels half way, recorded and made again, h/{layers}", again, found[1], False))
    case.plot("Focused group", "t, s", "m", curves)
case.finish()
