#!/usr/bin/python3
"""Natural convection in a square cavity with a warm and a cold wall, against de Vahl Davis (1983)."""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, read_series, read_table, read_vtu

case = Case("natural_convection", "Natural convection")

PR = 0.71
REFERENCE = {1e3: (1.118, 3.649, 3.697), 1e4: (2.243, 16.178, 19.617), 1e5: (4.519, 34.73, 68.59)}    # Nu, u, v


def cavity(method, ra, n):
    """Mean Nusselt number at the warm wall, largest u and v on the middle lines in a/L, temperatures."""
    nu = math.sqrt(0.01*PR/ra)
    a = nu/PR
    end = round(0.35/a, 6)
    content = {"dimension": 2, "method": method, "spacing": 1/n, "end_time": end, "gravity": [0, -0.1],
               "domain": {"min": [0, 0], "max": [1, 1], "walls": {"x": "no-slip", "y": "no-slip"}},
               "fluids": [{"name": "air", "density": 1, "viscosity": nu, "fill": [{"box": {"min": [0, 0], "max": [1, 1]}}]}],
               "scalars": [{"field": "temperature", "value": 0.5, "diffusivity": a, "expansion": 0.1}],
               "scalar_values": [{"name": "warm", "field": "temperature", "side": "x_min", "value": 1},
                                 {"name": "cold", "field": "temperature", "side": "x_max", "value": 0}],
               "output": {"interval": end, "probe_interval": end/200}}
    if method == "wcsph":
        content["wcsph"] = {"stiffness": 0.5}       # Pa: sound of 1.9 m/s, where air moves by 0.02 m/s
    label = f"{method}_{ra:.0f}_{n}"
    out = case.run(label, scene=case.write_scene(label, content))
    table = read_table(out/"scalars.csv")
    flows = [f for t, f in zip(table["time"], table["warm_temperature_flow"]) if t > 0.9*end]
    last = read_vtu(read_series(out)[-1][1])
    x, velocity = last["Points"], last["velocity"]
    u, v = (max(abs(velocity[k + c])/a for k in range(0, len(x), 3) if abs(x[k + c] - 0.5) < 0.5/n) for c in (0, 1))
    return sum(flows)/len(flows)/a, u, v, min(table["temperature_min"]), max(table["temperature_max"])


runs = [("dfsph", 1e4, 20)] if case.smoke else (
    [(m, ra, 40) for m in ("isph", "dfsph") for ra in (1e3, 1e4, 1e5)] +
    [("isph", 1e4, 20), ("isph", 1e4, 80), ("isph", 1e5, 80), ("eisph", 1e4, 40), ("wcsph", 1e4, 40)])
for method, ra, n in runs:
    nusselt, u, v, least, most = cavity(method, ra, n)
    expected = REFERENCE[ra]
    name = f"{method}, Ra = {ra:.0e}, L/{n}".replace("e+0", "e")
    for what, value, goal in (("Nusselt number", nusselt, expected[0]), ("largest u", u, expected[1]),
                              ("largest v", v, expected[2])):
        case.figure(f"{name}: {what} over that of the reference", value/goal, "1 within 0.03", abs(value/goal - 1) < 0.03)
    case.state(f"{name}: least temperature", least)
    case.state(f"{name}: largest temperature", most)
case.finish()
