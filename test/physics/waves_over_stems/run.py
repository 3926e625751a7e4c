#!/usr/bin/python3
"""Waves that pass over stems lose height: a porous zone against the theory of linear waves and rigid stems."""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, read_table
from waves import G, amplitude, wave_number

case = Case("waves_over_stems", "Waves over stems")

DEPTH, STEEP, GAUGES = 0.3, 0.1, 33
NUMBER, DIAMETER, DRAG = 1000, 0.01, 1.2      # 1/m2, m, 1: the waves lose some 40 % of their height


def theory(k, stem):
    """1/m2"""
    s = min(stem, DEPTH)
    return (8/(9*math.pi)*DRAG*DIAMETER*NUMBER*k*(math.sinh(k*s)**3 + 3*math.sinh(k*s)) /
            ((math.sinh(2*k*DEPTH) + 2*k*DEPTH)*math.sinh(k*DEPTH)))


def flume(method, layers, period, stem, waves):
    """The slope of 1/amplitude; stem = 0: there are none."""
    d, k = DEPTH/layers, wave_number(DEPTH, period)
    wave, block, room = 2*math.pi/k, 6*d, round(0.6*layers)*d
    begin, end_zone = round(0.8*wave/d)*d, round((0.8 + waves)*wave/d)*d
    length, top = round((2 + waves)*wave/d)*d, 1.8*DEPTH
    xs = [round(begin + (end_zone - begin)*(i + 0.5)/GAUGES, 4) for i in range(GAUGES)]
    end = round((7 + 1.5*waves)*period, 6)
    zones = [{"name": "stems", "box": {"min": [begin, 0], "max": [end_zone, stem]},
              "stems": {"number": NUMBER, "diameter": DIAMETER, "drag": DRAG}}] if stem else []
    maker = {"depth": DEPTH, "ramp": 2*period, "regular": {"height": STEEP*DEPTH, "period": period}}
    content = {"dimension": 2, "method": method, "spacing": d, "end_time": end, "gravity": [0, -G],
               "domain": {"min": [-block - room, 0], "max": [length, 2*DEPTH]},
               "fluids": [{"name": "water", "density": 1000, "viscosity": 0, "fill": [{"box": {"min": [0, 0], "max": [length, DEPTH]}}]}],
               "bodies": [{"name": "piston", "box": {"min": [-block, 0], "max": [0, top]}, "motion": {"piston": maker}}],
               "porous_zones": zones, "damping_zones": [{"box": {"min": [end_zone, 0], "max": [length, top]}, "rate": 10/period}],
               "probes": [{"name": f"g{i}", "kind": "level", "position": [x, 0]} for i, x in enumerate(xs)],
               "output": {"interval": end, "probe_interval": period/60, "fields": ["velocity"], "surfaces": False}}
    label = f"{method}_{layers}_{period}_{stem}"
    table = read_table(case.run(label, scene=case.write_scene(label, content))/"probes.csv")
    at = [n for n, t in enumerate(table["time"]) if t > end - 3*period]
    times = [table["time"][n] for n in at]
    a = [abs(amplitude(times, [table[f"g{g}_level"][n] - DEPTH for n in at], 2*math.pi/period)) for g in range(GAUGES)]
    x, y = [v - begin for v in xs], [1/v for v in a]
    mean_x, mean_y = sum(x)/GAUGES, sum(y)/GAUGES
    slope = sum((p - mean_x)*(q - mean_y) for p, q in zip(x, y))/sum((p - mean_x)**2 for p in x)
    return slope, k, x, a


runs = [("isph", 8, 1.2, 0.5)] if case.smoke else [(m, n, t, s) for m, n in (("isph", 12), ("isph", 20)) for t, s in
                                                   ((1.2, 0.5), (1.2, 0.18), (1.8, 0.5))] + [("dfsph", 20, 1.2, 0.5)]
curves = []
for method, layers, period, stem in runs:
    slope, k, x, a = flume(method, layers, period, stem, case.pick(1, 2))
    gamma = theory(k, stem)
    height = "stems above the water" if stem > DEPTH else f"stems {stem/DEPTH:.1f} h high"
    name = f"{method}, kh = {k*DEPTH:.2f}, {height}, h/{layers}"
    case.figure(f"{name}: slope of 1/amplitude over theory", slope/gamma, "1 within 0.1", abs(slope/gamma - 1) < 0.1)
    curves.append((name, x, a, False))
    mean = sum(1/v for v in a)/len(a) - gamma*sum(x)/len(x)
    curves.append((f"theory, {name}", x, [1/(mean + gamma*v) for v in x], True))
    if not case.smoke and stem > DEPTH:
        bare, _, x, a = flume(method, layers, period, 0, 2)
        case.state(f"{name}: slope without stems over that of the theory with them", bare/gamma)
case.plot("Amplitude along the stems", "x, m", "m", curves)
case.finish()
