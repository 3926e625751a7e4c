#!/usr/bin/python3
"""Soft solids in water: draft of an elastic ball, its stiff limit, momentum, no water inside."""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, mean, read_series, read_table, read_vtu

case = Case("soft_bodies", "Soft solids in water")

SIDE, HALF, DEPTH, G = 0.1, 0.05, 0.125, 9.81


def scene(label, across, end, method="dfsph", youngs=1e5, rigid=False):
    d, size = SIDE/across, 0.2
    ball = {"name": "ball", "density": 500}
    sphere = {"sphere": {"centre": [size/2, size/2, DEPTH], "radius": HALF}}
    mesh = {"mesh": str(case.folder.parents[1] / "meshes" / "sphere.obj"), "scale": SIDE, "translation": [size/2, size/2, DEPTH]}
    owner = {"bodies": [{**ball, "dynamics": "free", **mesh}]} if rigid else \
            {"solids": [{**ball, "youngs_modulus": youngs, "fill": [sphere]}]}
    return case.write_scene(label, {
        "method": method, "domain": {"min": [0, 0, 0], "max": [size, size, 0.25]}, "gravity": [0, 0, -G], "spacing": d, "end_time": end,
        "fluids": [{"name": "water", "density": 1000, "viscosity": 1e-3, "fill": [{"box": {"min": [0, 0, 0], "max": [size, size, DEPTH]}}]}],
        **owner, "output": {"interval": 0.05, "fields": ["velocity"] if rigid else ["velocity", "material"], "surfaces": False}})


def find_level(points, rows, across):
    """Of the water in the corners, more than 0.09 m from the middle: of its topmost particles, as many as a layer has, half a spacing
    above their mean. The gauges of the program read a quarter of a spacing more in corners as narrow as these."""
    d, side, reach = SIDE/across, 0.2, 0.09
    heights = sorted((points[3*i + 2] for i in rows if math.dist(points[3*i:3*i + 2], (side/2, side/2)) > reach), reverse=True)
    return mean(heights[:round((side**2 - math.pi*reach**2)/d**2)]) + d/2


def follow(out, across, ball=None):
    """Height and draft over time, and the nearest that water comes to the ball's centre at the end. ball: heights, of a body."""
    heights, drafts, nearest = [], [], 0
    for k, (time, path) in enumerate(read_series(out)):
        arrays = read_vtu(path)
        points, material = arrays["Points"], arrays.get("material") or [0]*(len(arrays["Points"])//3)
        rows = [i for i in range(len(material)) if material[i] == 1]
        water = [i for i in range(len(material)) if material[i] == 0]
        at = [mean([points[3*i + a] for i in rows]) for a in range(3)] if rows else [0, 0, ball[k]]
        heights.append((time, at[2]))
        drafts.append((find_level(points, water, across) - at[2] + HALF)/SIDE)
        nearest = min(math.dist(points[3*i:3*i + 3], at) for i in water)
    return heights, mean(drafts[-len(drafts)//5:]), nearest


def judge_ball(label, across, end, **more):
    out = case.run(label, scene=scene(label, across, end, **more))
    heights, draft, nearest = follow(out, across)
    return out, draft, nearest, heights


curves = []
for across in case.pick((8,), (8, 12, 16)):
    out, draft, nearest, heights = judge_ball(f"ball_{across}", across, case.pick(1, 2))
    name = f"ball of half the water's density, {across} across"
    case.figure(f"{name}: draft over height", draft, "0.5 within 0.01", abs(draft - 0.5) <= 0.01)
    # The surface is known to a quarter of a spacing, which is 0.03 of the height here.
    case.hold(f"{name}: draft {draft:.3f}, within 3 % of the height", abs(draft - 0.5) <= 0.03)
    case.hold(f"{name}: water comes to {(HALF - nearest)*across/SIDE:.2f} spacings inside", nearest >= HALF - SIDE/across)
    history = read_table(out / "history.csv")
    energy = [sum(each) for each in zip(history["kinetic_energy"], history["potential_energy"], history["elastic_energy"])]
    # The lattice that the water starts as swells in the first three tenths of a second, as beside bodies.
    late = [e for t, e in zip(history["time"], energy) if t >= 0.3]
    weight = 500*math.pi/6*SIDE**3*G*SIDE
    gain = (max(late) - late[0])/weight
    case.figure(f"{name}: energy gained after 0.3 s, over the ball's weight times height", gain, "<= 0.02", gain <= 0.02)
    curves.append((f"{across} across", [t for t, z in heights], [z for t, z in heights], False))
case.plot("Height of the ball's centre", "t, s", "z, m", curves)

for method in case.pick((), ("isph", "eisph", "wcsph")):
    out, draft, nearest, heights = judge_ball(f"ball_{method}", 8, 1, method=method)
    case.figure(f"{method}, 8 across: draft over height", draft, "0.5 within 0.03", abs(draft - 0.5) <= 0.03)

across, end = 8, case.pick(1, 2)
stiff = judge_ball("stiff", across, end, youngs=1e8)[1]
out = case.run("rigid", scene=scene("rigid", across, end, rigid=True))
rigid = follow(out, across, read_table(out / "bodies.csv")["position_z"])[1]
case.figure("ball of 1e8 Pa, 8 across: draft less that of a rigid body, over height", stiff - rigid, "within 0.02", abs(stiff - rigid) <= 0.02)
# Both move by a hundredth in a swell of their own at this size.
case.hold(f"stiff limit: {stiff:.3f} beside {rigid:.3f} of a rigid body", abs(stiff - rigid) <= 0.04)



def find_heights(across, density, rigid=False, *options, low=0.2, end=0.4):
    """Of the centre of a block, m, every 0.02 s."""
    low, high = [0.4, low], [0.6, low + 0.2]
    block = {"name": "block", "density": density}
    owner = {"bodies": [{**block, "dynamics": "free", "friction": "slip", "box": {"min": low, "max": high}}]} if rigid else \
            {"solids": [{**block, "youngs_modulus": 1e6, "fill": [{"box": {"min": low, "max": high}}]}]}
    label = "_".join([f"block_{across}_{density}", "rigid" if rigid else "soft", *(o.split("=")[1].strip('"') for o in options)])
    out = case.run(label, *(word for o in options for word in ("--set", o)), scene=case.write_scene(label, {
        "dimension": 2, "domain": {"min": [0, 0], "max": [1, 1]}, "gravity": [0, -G], "spacing": 0.2/across, "end_time": end,
        "fluids": [{"name": "water", "density": 1000, "viscosity": 1e-3, "fill": [{"box": {"min": [0, 0], "max": [1, 0.9]}}]}],
        **owner, "output": {"interval": 0.02, "fields": ["velocity"], "surfaces": False}}))
    table = read_table(out / ("bodies.csv" if rigid else "solids.csv"))
    return table["position_y"]


def find_rise(*words):
    heights = find_heights(*words)
    return heights[-1] - heights[0]


def find_fall(across, rigid, option):
    """Spacings left below a heavy block, at the end and at least; the time when one is left, s."""
    d = 0.2/across
    gaps = [(y - 0.1)/d for y in find_heights(across, 2000, rigid, option, low=4*d, end=0.5)]
    return gaps[-1], min(gaps), next((0.02*k for k, gap in enumerate(gaps) if gap < 1), math.inf)


for method in ("dfsph", "wcsph", *case.pick((), ("isph",))):
    for across, goal in case.pick(((8, 0.2),), ((8, 0.2), (16, 0.1))):
        option = f'method="{method}"'
        ratio = find_rise(across, 800, False, option)/find_rise(across, 800, True, option)
        name = f"{method}, block of 0.8 of the water's density, {across} across: rise over that of a rigid one"
        case.figure(name, ratio, f"1 within {goal:g}", abs(ratio - 1) <= goal)
        case.hold(f"{name} {ratio:.3f}, 1 within 0.4", abs(ratio - 1) <= 0.4)
    drift = find_rise(8, 1000, False, option)*8/0.2
    case.figure(f"{method}, block as dense as water, 8 across: way in spacings", drift, "within 0.1", abs(drift) <= 0.1)

for method in ("dfsph", *case.pick((), ("wcsph", "isph"))):
    for across in case.pick((8,), (8, 16)):
        option = f'method="{method}"'
        (gap, least, time), (rigid, _, other) = (find_fall(across, each, option) for each in (False, True))
        name = f"{method}, block of twice the water's density, {across} across"
        case.figure(f"{name}: spacings left, less those of a rigid one", gap - rigid, "<= 0.5", gap <= rigid + 0.5)
        case.figure(f"{name}: time to one spacing, over that of a rigid one", time/other, "1 within 0.3", abs(time/other - 1) <= 0.3)
        case.hold(f"{name}: comes to {least:.2f} spacings", -0.2 <= least <= max(rigid, 0) + 0.5)

path = case.write_scene("shot", {
    "domain": {"min": [0, 0, 0], "max": [0.2, 0.2, 0.4]}, "gravity": [0, 0, 0], "spacing": 0.01, "end_time": 0.08,
    "fluids": [{"name": "water", "density": 1000, "fill": [{"box": {"min": [0.07]*3, "max": [0.13]*3}, "velocity": [0.05, 0, 0.5]}]}],
    "solids": [{"name": "jelly", "density": 300, "youngs_modulus": 2e4, "fill": [{"box": {"min": [0.08, 0.08, 0.14], "max": [0.12, 0.12, 0.18]}}]}],
    "output": {"interval": 0.01, "fields": ["velocity", "material"], "surfaces": False}})
out = case.run("shot", scene=path)
history, last = read_table(out / "history.csv"), read_vtu(read_series(out)[-1][1])
rows = [i for i in range(len(last["material"])) if last["material"][i] == 1]
given = 300*0.04**3*mean([last["velocity"][3*i + 2] for i in rows])
lost = max(abs(m - history[f"momentum_{a}"][0]) for a in "xyz" for m in history[f"momentum_{a}"])/given
case.figure("momentum of water and jelly, largest change over that of the jelly", lost, "<= 1e-6", lost <= 1e-6)
case.hold(f"the jelly took {given/(0.06**3*1000*0.5):.2f} of the water's momentum", given > 0.02*0.06**3*1000*0.5)
case.finish()
