#!/usr/bin/python3
"""Lock exchange: a heavy liquid beside a light one in a closed tank, the fronts against Benjamin's theory."""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, fit_line, read_series, read_table, read_vtu

case = Case("lock_exchange", "Lock exchange", methods=("dfsph", "wcsph"))
G, H, HALF = 9.81, 0.2, 0.8
THEORY = math.sqrt(G*(1 - 1000/1020)*H)/2
SCENE = pathlib.Path(__file__).resolve().parents[3]/"scenes"/"lock_exchange"/"scene.json"
SALT = 20                                          # g/kg
END = 7                                            # s; by theory the fronts are at 3.4 H, 0.6 H from the walls


def fronts(out, d):
    """Times, and how far the salt water on the floor and the fresh water under the lid have come, m."""
    times, floor, lid = [], [], []
    for t, file in read_series(out):
        data = read_vtu(file)
        points = list(zip(data["Points"][0::3], data["Points"][1::3], data["material"]))
        times.append(t)
        floor.append(max(x for x, y, m in points if m == 0 and y < 3*d) + d/2 - HALF)
        lid.append(HALF - min(x for x, y, m in points if m == 1 and y > H - 3*d) + d/2)
    return times, floor, lid


def salt_fronts(out, d):
    """The same where the salt is a concentration: of water with more and less than half of it."""
    times, floor, lid = [], [], []
    for t, file in read_series(out):
        data = read_vtu(file)
        points = list(zip(data["Points"][0::3], data["Points"][1::3], data["concentration"]))
        times.append(t)
        floor.append(max(x for x, y, c in points if c > SALT/2 and y < 3*d) + d/2 - HALF)
        lid.append(HALF - min(x for x, y, c in points if c < SALT/2 and y > H - 3*d) + d/2)
    return times, floor, lid


def speed(times, places):
    """Over that of theory, on the way from 1.5 depths to 3, or to the end of the run; 0 if there is no such way."""
    way = [(t, x) for t, x in zip(times, places) if 1.5*H <= x <= HALF - H]
    if len(way) < 3:
        return 0
    return fit_line([t for t, x in way], [x for t, x in way])[0]/THEORY


def exchange(n):
    d = H/n
    out = case.run(f"depth_{n}", "--spacing", d, "--until", END, "--set", "output.interval=0.1", "--set",
                   "output.frames=false", scene=SCENE)
    times, floor, lid = fronts(out, d)
    heavy, light = speed(times, floor), speed(times, lid)
    case.figure(f"{n} over the depth: speed on the floor over theory", heavy, "within 0.1", abs(heavy - 1) <= 0.1)
    case.figure(f"{n} over the depth: speed under the lid over theory", light, "within 0.1", abs(light - 1) <= 0.1)
    uneven = abs(heavy - light)/max(heavy, light) if light and heavy else math.inf
    case.figure(f"{n} over the depth: difference of the two speeds", uneven, "<= 0.05", uneven <= 0.05)
    history = read_table(out/"history.csv")
    free = history["potential_energy"][0] - history["potential_energy"][-1]
    share = history["kinetic_energy"][-1]/free if free > 0 else math.inf
    case.figure(f"{n} over the depth: kinetic energy over potential energy set free", share, "<= 1", share <= 1)
    case.hold(f"{n} over the depth: no particle is lost", max(history["particles_lost"]) == 0)
    return times, [x/H for x in floor], [x/H for x in lid]


def exchange_salt(n):
    """One liquid that carries the salt, with the weight of the same mixture."""
    d = H/n
    out = case.run(f"salt_{n}", "--spacing", d, "--until", END, "--set", "output.interval=0.1", scene=case.write_scene("salt", {
        "dimension": 2, "method": "isph", "spacing": d, "end_time": END, "gravity": [0, -G],
        "domain": {"min": [0, 0], "max": [2*HALF, H]},
        "fluids": [{"name": "water", "viscosity": 1e-3, "fill": [{"box": {"min": [0, 0], "max": [2*HALF, H]}}]}],
        "scalars": [{"field": "concentration", "diffusivity": 1.5e-9, "expansion": -0.02/SALT}],
        "scalar_values": [{"field": "concentration", "box": {"min": [0, 0], "max": [HALF, H]}, "value": SALT}]}))
    times, floor, lid = salt_fronts(out, d)
    theory = THEORY*math.sqrt(1.02)          # here g' is of the fresh water
    heavy, light = speed(times, floor)*THEORY/theory, speed(times, lid)*THEORY/theory
    name = f"salt as a concentration, {n} over the depth"
    case.figure(f"{name}: speed on the floor over theory", heavy, "within 0.1", abs(heavy - 1) <= 0.1)
    case.figure(f"{name}: speed under the lid over theory", light, "within 0.1", abs(light - 1) <= 0.1)
    history = read_table(out/"history.csv")
    share = history["kinetic_energy"][-1]/history["buoyancy_work"][-1]
    case.figure(f"{name}: kinetic energy over work of the weight", share, "<= 1", share <= 1)
    table = read_table(out/"scalars.csv")
    case.hold(f"{name}: the salt stays", abs(table["concentration_amount"][-1]/table["concentration_amount"][0] - 1) < 1e-6)
    case.hold(f"{name}: no water has more or less than there was",
              min(table["concentration_min"]) >= -1e-6 and max(table["concentration_max"]) <= SALT + 1e-6)
    return times, [x/H for x in floor], [x/H for x in lid]


curves = [("Benjamin 1968", [0, END], [0, THEORY*END/H], False)]
sizes = {"dfsph": (20, 30), "wcsph": (20,)}
for size in case.pick((12,), sizes.get(case.args.method, (20, 30, 40))):
    at, below, above = exchange(size)
    curves += [(f"floor, {size}", at, below, False), (f"lid, {size}", at, above, False)]
for size in case.pick((12,), (20, 30) if case.args.method in (None, "dfsph") else ()):
    at, below, above = exchange_salt(size)
    curves += [(f"floor, {size}, concentration", at, below, False), (f"lid, {size}, concentration", at, above, False)]
case.plot("Way of the fronts over the depth", "t, s", "x/H", curves)
case.finish()
