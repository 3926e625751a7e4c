#!/usr/bin/python3
"""Two liquids: layers at rest, the jump of the pressure in a disc, the rising bubble of Hysing et al."""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, mean, read_series, read_vtu

case = Case("two_liquids", "Two liquids")
G = 9.81
BUBBLE = pathlib.Path(__file__).resolve().parents[3]/"scenes"/"rising_bubble"/"scene.json"


def layers(density):
    out = case.run(f"layers_{density}", "--set", f"fluids[1].density={density}", "--until", case.pick(0.2, 1),
                   scene=case.folder/"layers.json")
    data = read_vtu(read_series(out)[-1][1])
    floor, worst, low, high = G*0.2*(density + 1000), 0, 1, 0
    for y, p, m in zip(data["Points"][1::3], data["pressure"], data["material"]):
        right = G*density*(0.4 - y) if y > 0.2 else G*(density*0.2 + 1000*(0.2 - y))
        worst = max(worst, abs(p - right)/floor)
        low, high = (min(low, y), high) if m else (low, max(high, y))
    case.figure(f"layers 1000 on {density} kg/m3: error of the pressure", worst, "<= 0.002", worst <= 0.002)
    case.figure(f"layers 1000 on {density} kg/m3: distance of the liquids, spacings", (low - high)/0.01,
                "> 0.5", low - high > 0.005)


def jump():
    out = case.run("disc", "--spacing", 0.025, "--set", "gravity=[0,0]", "--until", 0.3, scene=BUBBLE)
    data = read_vtu(read_series(out)[-1][1])
    inside, outside = [], []
    for x, y, p in zip(data["Points"][0::3], data["Points"][1::3], data["pressure"]):
        r = math.hypot(x - 0.5, y - 0.5)
        if r < 0.12:
            inside.append(p)
        if 0.38 < r < 0.5:
            outside.append(p)
    found = (mean(inside) - mean(outside))/(24.5/0.25)
    case.figure("disc, 10 spacings to its radius: jump over tension/radius", found, "within 0.02",
                abs(found - 1) <= 0.02)


def share(points, material, d):
    """Share of the bubble in the kernel, on a grid of half a spacing."""
    h, s, cells = 2.5*d, d/2, {}
    for x, y, m in zip(points[0::3], points[1::3], material):
        cells.setdefault((int(x/h), int(y/h)), []).append((x, y, m))
    own = [(x, y) for x, y, m in zip(points[0::3], points[1::3], material) if m]
    low = [int((min(p[a] for p in own) - 2*d)/s) for a in (0, 1)]
    high = [int((max(p[a] for p in own) + 2*d)/s) + 1 for a in (0, 1)]
    value = {}
    for i in range(low[0], high[0] + 1):
        for j in range(low[1], high[1] + 1):
            all_of, part = 1e-30, 0
            for u in (-1, 0, 1):
                for v in (-1, 0, 1):
                    for x, y, m in cells.get((int(i*s/h) + u, int(j*s/h) + v), ()):
                        q = math.hypot(x - i*s, y - j*s)/h
                        if q < 1:
                            w = (1 - q)**4*(1 + 4*q)
                            all_of, part = all_of + w, part + w*m
            value[i, j] = part/all_of
    return value, s


def circularity(points, material, d):
    """Perimeter of the circle of the same area over that of the contour at a share of one half."""
    value, s = share(points, material, d)
    length = 0
    for i, j in value:
        for triangle in (((i, j), (i + 1, j), (i + 1, j + 1)), ((i, j), (i + 1, j + 1), (i, j + 1))):
            if any(p not in value for p in triangle):
                continue
            v, ends = [value[p] - 0.5 for p in triangle], []
            for a in range(3):
                b = (a + 1) % 3
                if (v[a] > 0) != (v[b] > 0):
                    t = v[a]/(v[a] - v[b])
                    ends.append([s*(triangle[a][c] + t*(triangle[b][c] - triangle[a][c])) for c in (0, 1)])
            if len(ends) == 2:
                length += math.dist(*ends)
    return 2*math.sqrt(math.pi*sum(material)*d*d)/length


def bubble(across):
    d = 0.5/across
    out = case.run(f"bubble_{across}", "--spacing", d, "--until", case.pick(1.2, 3), scene=BUBBLE)
    times, speed, round_, centre = [], [], [], []
    for t, file in read_series(out):
        data = read_vtu(file)
        material = data["material"]
        count = sum(material)
        times.append(t)
        centre.append(sum(y*m for y, m in zip(data["Points"][1::3], material))/count)
        speed.append(sum(v*m for v, m in zip(data["velocity"][1::3], material))/count)
        round_.append(1 if case.smoke else circularity(data["Points"], material, d))
    fastest = max(speed)
    case.figure(f"bubble, {across} across: largest rise velocity over 0.2417 m/s", fastest/0.2417, "within 0.01",
                abs(fastest/0.2417 - 1) <= 0.01)
    case.hold(f"bubble, {across} across: rise velocity within 3 %", abs(fastest/0.2417 - 1) <= 0.03)
    if case.smoke:
        return times, speed
    case.figure(f"bubble, {across} across: centre of mass at 3 s over 1.081 m", centre[-1]/1.081, "within 0.01",
                abs(centre[-1]/1.081 - 1) <= 0.01)
    case.figure(f"bubble, {across} across: least circularity over 0.901", min(round_)/0.901, "within 0.01",
                abs(min(round_)/0.901 - 1) <= 0.01)
    case.hold(f"bubble, {across} across: circularity within 3 %", abs(min(round_)/0.901 - 1) <= 0.03)
    return times, speed


for light in (500, 1):
    layers(light)
jump()
sizes = case.pick((16,), (20, 30))
curves = [(f"{n} across", *bubble(n), False) for n in sizes]
case.plot("Rise velocity of the bubble", "t, s", "m/s", curves)
case.finish()
