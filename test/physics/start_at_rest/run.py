#!/usr/bin/python3
"""Water at rest from the first step on: pressures of sensors against rho g h."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, read_table

METHODS = ("dfsph", "isph", "eisph", "wcsph")
case = Case("start_at_rest", "A start without a jump")

G, RHO, DEPTH, END = 9.81, 1000, 0.3, 0.2
PLACES = {"floor": (0.2, 0), "wall": (0, 0.1), "inside": (0.2, 0.15), "high": (0, 0.25)}


def start(method, layers):
    content = {"dimension": 2, "method": method, "domain": {"min": [0, 0], "max": [0.4, 0.45]}, "spacing": DEPTH/layers,
               "end_time": END, "gravity": [0, -G],
               "fluids": [{"name": "water", "density": RHO, "fill": [{"box": {"min": [0, 0], "max": [0.4, DEPTH]}}]}],
               "probes": [{"name": name, "position": list(at)} for name, at in PLACES.items()],
               "output": {"interval": END, "fields": ["velocity"]}}
    label = f"{method}_{layers}"
    table = read_table(case.run(label, scene=case.write_scene(label, content))/"probes.csv")
    name = f"{method}, {layers} layers"
    off = {place: [abs(p - RHO*G*(DEPTH - at[1]))/(RHO*G*DEPTH) for p in table[f"{place}_pressure"]]
           for place, at in PLACES.items()}
    most = max(max(values) for values in off.values())
    case.figure(f"{name}: largest deviation from the first step on", most, "<= 0.01", most <= 0.01)
    first = max(values[0] for values in off.values())
    case.figure(f"{name}: largest deviation in the first step", first, "<= 0.005", first <= 0.005)
    return name, table["time"], [p/(RHO*G*DEPTH) - 1 for p in table["floor_pressure"]], False


curves = [start(method, layers) for method in METHODS for layers in case.pick((20,), (20, 30, 40))]
case.plot("Pressure on the floor over rho g h, less 1", "t, s", "1", curves)
case.finish()
