#!/usr/bin/python3
"""A rubber gate that water bends: how far its free end moves, by spacing and by method."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, mean, read_series, read_vtu

case = Case("elastic_gate", "A gate of rubber")

BULK, SHEAR = 2e7, 4.27e6
YOUNG = 9*BULK*SHEAR/(3*BULK + SHEAR)
POISSON = (3*BULK - 2*SHEAR)/(2*(3*BULK + SHEAR))
FINEST = ("dfsph", 1.25, 0.625)


def find_tip(out):
    """Times, and where the particles at the lower end of the gate are in the mean."""
    times, places, tip = [], [], None
    for time, path in read_series(out):
        data = read_vtu(path)
        rows = {i: (x, y) for i, x, y, m in zip(data["particle_id"], data["Points"][0::3], data["Points"][1::3], data["material"])
                if m == 1}
        if tip is None:
            lowest = min(y for _, y in rows.values())
            tip = [i for i, (_, y) in rows.items() if y < lowest + 1e-5]
        times.append(time)
        places.append([mean([rows[i][a] for i in tip]) for a in range(2)])
    return times, places


def run(method, water, gate):
    label = f"{method}_{water:g}_{gate:g}"
    scene = case.write_scene(label, {
        "method": method, "dimension": 2, "gravity": [0, -9.81], "spacing": 1e-3*water, "end_time": 0.25,
        "domain": {"min": [0, 0], "max": [0.4, 0.16], "walls": {"x": "separate", "y": "separate"}},
        "fluids": [{"name": "water", "density": 1000, "viscosity": 1e-3, "fill": [{"box": {"min": [0, 0], "max": [0.1, 0.14]}}]}],
        "solids": [
            {"name": "gate", "density": 1100, "youngs_modulus": YOUNG, "poissons_ratio": POISSON,
             "fill": [{"box": {"min": [0.1, 0], "max": [0.105, 0.079]}}]},
            {"name": "clamp", "model": "stationary", "density": 2e6,
             "fill": [{"box": {"min": [0.1, 0.079], "max": [0.105, 0.15]}}]}],
        "mlsmpm": {"spacing": 1e-3*gate},
        "output": {"interval": 0.005, "surfaces": False, "fields": ["material", "particle_id"]}})
    times, places = find_tip(case.run(label, scene=scene))
    way = [(x - places[0][0])*1e3 for x, y in places]
    curves.append((f"{method}, water {water:g} mm, gate {gate:g} mm", times, way, False))
    most = max(way)
    return most, times[way.index(most)], max(y - places[0][1] for x, y in places)*1e3


curves = []
cases = case.pick([("dfsph", 2.5, 1.25)],
                  [FINEST, ("dfsph", 2.5, 1.25), ("dfsph", 2.5, 0.625), ("dfsph", 1.25, 1.25), ("wcsph", 2.5, 1.25),
                   ("isph", 2.5, 1.25)])
finest = None
for method, water, gate in cases:
    most, when, lift = run(method, water, gate)
    name = f"{method}, water {water:g} mm, gate {gate:g} mm"
    case.state(f"{name}: largest way of the free end, mm", most)
    case.state(f"{name}: its lift, mm", lift)
    case.state(f"{name}: at, s", when)
    # 38.9 seen by dfsph, 36.6 by isph; a gate that no water presses stays, one that leaks or tears goes farther
    case.hold(f"{name}: between 34 and 43 mm ({most:.1f})", 34 < most < 43)
    if finest is not None:
        case.figure(f"{name}: way over that of the finest", most/finest, "1 within 0.03", abs(most/finest - 1) <= 0.03)
    if (method, water, gate) == FINEST:
        finest = most
case.plot("Way of the free end along x", "t, s", "mm", curves)
case.finish()
