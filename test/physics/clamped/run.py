#!/usr/bin/python3
"""Soft solids that rigid bodies hold: a beam, a rod on a hub that turns, a weight that hangs and swings."""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, mean, read_series, read_table, read_vtu

case = Case("clamped", "Solids clamped to bodies")

BEAM = 1000*9.81*4*(10**4/(8*1e8*16/12) + 10**2/(2*5/6*0.5e8*4))      # m


def beam(across, aside, deep=1):
    """Sinking of the end of the axis, force and moment on the body over those of the weight. deep: m that it reaches into it."""
    cell = 2/across
    d, shift = cell/2, aside*cell
    out = case.solids(f"beam_{across}_{aside}_{deep}", {
        "domain": {"min": [-3 - shift, -2], "max": [11, 4]}, "gravity": [0, -9.81], "spacing": d, "end_time": 2.5,
        "bodies": [{"name": "wall", "box": {"min": [-2, -1], "max": [0, 3]}}],
        "solids": [{"name": "beam", "density": 1000, "youngs_modulus": 1e8, "poissons_ratio": 0, "damping": 12,
                    "clamped_to": "wall", "fill": [{"box": {"min": [-deep, 0], "max": [10, 2]}}]}],
        "output": {"interval": 0.125, "fields": ["rest_position"]}})
    series = read_series(out)
    rest, now = (read_vtu(series[k][1])["Points"] for k in (0, -1))
    ends = [[now[i + 1] - rest[i + 1] for i in range(0, len(rest), 3)
             if lower < rest[i] < upper and abs(rest[i + 1] - 1) < 0.5] for lower, upper in ((10 - 2*d, 10), (10 - 4*d, 10 - 2*d))]
    table = read_table(out/"bodies.csv")
    weight = 1000*9.81*2*(10 + deep)
    at = mean([now[i] for i in range(0, len(now), 3)])      # of the centre of mass; that of the body is at -1
    return (-1.5*mean(ends[0]) + 0.5*mean(ends[1]), -table["mean_pressure_force_y"][-1]/weight,
            -table["mean_pressure_torque_z"][-1]/(weight*(at + 1)))


def rod(across):
    """Radial force on the hub and stretch of the rod, means over ten swings, over those of the theory."""
    height, R, r, modulus, turn = 0.08, 0.6, 0.1, 1e6, 2*math.pi
    swing = 4*(R - r)/math.sqrt(modulus/1000)
    out = case.solids(f"rod_{across}", {
        "domain": {"min": [-0.75, -0.75], "max": [0.75, 0.75]}, "spacing": height/across/2, "end_time": 12*swing,
        "bodies": [{"name": "hub", "box": {"min": [-0.1, -0.1], "max": [0.1, 0.1]},
                    "motion": {"rotation": {"center": [0, 0, 0], "axis": [0, 0, 1], "rate": 360}}}],
        "solids": [{"name": "rod", "density": 1000, "youngs_modulus": modulus, "poissons_ratio": 0, "clamped_to": "hub",
                    "fill": [{"box": {"min": [0, -height/2], "max": [R, height/2]},
                              "velocity": [0, turn*R/2, 0], "spin": [0, 0, turn]}]}],
        "output": {"interval": swing/16, "fields": ["rest_position"]}})
    table = read_table(out/"bodies.csv")
    force, last = [], 0
    for t, x, y in zip(table["time"], table["mean_pressure_force_x"], table["mean_pressure_force_y"]):
        middle = 0.5*turn*(t + last)
        if last > 1.99*swing:
            force.append(x*math.cos(middle) + y*math.sin(middle))
        last = t
    series = read_series(out)
    rest = read_vtu(series[0][1])["Points"]
    tip = [i for i in range(0, len(rest), 3) if rest[i] > R - height/across/2]
    reach = [mean([math.hypot(p[i], p[i + 1]) - math.hypot(rest[i], rest[i + 1]) for i in tip])
             for p in (read_vtu(file)["Points"] for t, file in series if t > 1.99*swing)]
    case.plot(f"rod on {across} cells", "output", "force on the hub, N/m", [("radial", list(range(len(force))), force, False)])
    return (mean(force)/(1000*height*turn**2*R**2/2),
            mean(reach)/(1000*turn**2/(2*modulus)*(R*R*(R - r) - (R**3 - r**3)/3)))


def weight(across, density, parts):
    """Sinking and period of the weight over those of the theory."""
    width, modulus, L, g = 0.1, 1e6, 0.55, 1.0
    M, m, area = 0.02*density + 1000*width*0.05, 1000*width*L, width
    low, high = 0.0, math.pi/2
    for _ in range(60):
        b = (low + high)/2
        low, high = (b, high) if b*math.tan(b) < m/M else (low, b)
    period = 2*math.pi*L/(b*math.sqrt(modulus/1000))
    bar = {"density": 1000, "youngs_modulus": modulus, "poissons_ratio": 0}
    solids = [{"name": "bar", "clamped_to": ["ceiling", "weight"], **bar,
               "fill": [{"box": {"min": [-width/2, 0.1], "max": [width/2, 0.75]}}]}]
    if parts == 2:
        solids = [{"name": name, "clamped_to": body, **bar, "fill": [{"box": {"min": [-width/2, low], "max": [width/2, high]}}]}
                  for name, body, low, high in (("upper", "ceiling", 0.4, 0.75), ("lower", "weight", 0.1, 0.4))]
    out = case.solids(f"weight_{across}_{density}_{parts}", {
        "domain": {"min": [-0.2, -0.1], "max": [0.2, 0.9]}, "gravity": [0, -g], "spacing": width/across/2,
        "end_time": 6*period,
        "bodies": [{"name": "ceiling", "box": {"min": [-0.1, 0.7], "max": [0.1, 0.8]}},
                   {"name": "weight", "box": {"min": [-0.1, 0.05], "max": [0.1, 0.15]}, "density": density,
                    "dynamics": "free"}],
        "solids": solids, "output": {"interval": period/50, "fields": ["rest_position"]}})
    table = read_table(out/"bodies.csv")
    rows = [k for k, name in enumerate(table["name"]) if name == "weight"]
    t, y = [table["time"][k] for k in rows], [table["position_y"][k] for k in rows]
    middle = 0.5*(max(y) + min(y))
    up = [t[k] + (t[k + 1] - t[k])*(middle - y[k])/(y[k + 1] - y[k]) for k in range(len(y) - 1) if y[k] < middle <= y[k + 1]]
    case.plot(f"weight on {across} cells, density {density}, solids {parts}", "t, s", "height, m", [("centre", t, y, False)])
    return (y[0] - middle)/((M + m/2)*g*L/(modulus*area)), (up[-1] - up[0])/(len(up) - 1)/period


def raft(method):
    """Height of the middle of the body over still water at rest, m, mean over the second second."""
    out = case.run(f"raft_{method}", scene=case.write_scene(f"raft_{method}", {
        "method": method, "dimension": 2, "domain": {"min": [0, 0], "max": [0.6, 0.4]}, "gravity": [0, -9.81],
        "spacing": 0.01, "end_time": 2,
        "fluids": [{"name": "water", "viscosity": 0.5, "fill": [{"box": {"min": [0, 0], "max": [0.6, 0.2]}}]}],
        "bodies": [{"name": "raft", "box": {"min": [0.2, 0.19], "max": [0.4, 0.23]}, "density": 500, "dynamics": "free"}],
        "solids": [{"name": "foam", "density": 200, "youngs_modulus": 1e5, "clamped_to": "raft",
                    "fill": [{"box": {"min": [0.22, 0.14], "max": [0.38, 0.2]}}]}],
        "output": {"interval": 0.05}}))
    table = read_table(out/"bodies.csv")
    return mean([y for t, y in zip(table["time"], table["position_y"]) if t > 1])


# Of 5.92 kg/m: the slab, of which 0.05 m lie in water or air, dips in. The water had 0.110 m2 at the start.
DISPLACED = 0.2*0.04*0.5 + 0.16*0.06*0.2
RAFT = (0.110 + DISPLACED)/0.6 - DISPLACED/0.16 + 0.05 + 0.02

for across, aside in case.pick([(8, 0)], [(8, 0), (8, 0.5), (16, 0), (16, 0.5)]):
    sinking, force, moment = beam(across, aside)
    text = f"beam, {across} cells high, {aside} cells aside"
    case.figure(f"{text}: sinking, m", sinking, "0.380 within 2 %", abs(sinking/BEAM - 1) <= 0.02)
    case.figure(f"{text}: force over weight", force, "1 within 0.001", abs(force - 1) <= 0.001)
    case.figure(f"{text}: moment over that of the weight", moment, "1 within 0.001", abs(moment - 1) <= 0.001)
for across in case.pick([], [8, 16]):
    case.state(f"beam on the face of the body, one layer held, {across} cells high: sinking, m", beam(across, 0, 0)[0])
for across in case.pick([4], [4, 8]):
    force, stretch = rod(across)
    case.figure(f"rod, {across} cells high: force over m w^2 r", force, "1 within 0.01", abs(force - 1) <= 0.01)
    case.figure(f"rod, {across} cells high: stretch over theory", stretch, "1 within 0.02", abs(stretch - 1) <= 0.02)
for across, density, parts in case.pick([(4, 5000, 1)], [(4, 5000, 1), (8, 5000, 1), (8, 5000, 2), (8, 500, 1)]):
    sinking, period = weight(across, density, parts)
    text = f"weight of {density} kg/m3, {across} cells wide, bar of {parts} solid{'s'*(parts - 1)}"
    case.figure(f"{text}: sinking over theory", sinking, "1 within 0.02", abs(sinking - 1) <= 0.02)
    case.figure(f"{text}: period over theory", period, "1 within 0.02", abs(period - 1) <= 0.02)
for method in case.pick([], ["dfsph", "isph"]):
    height = raft(method)
    # Drafts of bodies are good to half a spacing (theory/rigid.md).
    case.figure(f"raft by {method}: height, m", height, f"{RAFT:.4f} within 0.005", abs(height - RAFT) <= 0.005)
case.finish()
