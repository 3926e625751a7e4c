#!/usr/bin/python3
"""Run-up of a solitary wave on a plane beach against Synolakis."""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from beach import G, scene, soliton
from harness import Case, read_table

case = Case("solitary_runup", "Run-up of a solitary wave", methods=("isph",))

D = 0.3


def law(cot, height):
    """R/d of a wave that does not break."""
    assert height < 0.8183*cot**(-10/9)
    return 2.831*math.sqrt(cot)*height**1.25


def run_up(cot, height, layers):
    spacing, meant = D/layers, law(cot, height)
    k, c = soliton(height)
    flat = round((2*2.65/k + 2)*D/spacing)*spacing       # the wave fits before the slope
    speed = c*math.sqrt(G*D)
    end = round(2*4.1*D/k/speed + (flat + 2.2*D*cot)/speed, 4)
    label = f"cot_{cot}_{height}_{layers}"
    content = scene(case.out/f"slope_{cot}_{height}_{layers}.obj", D, height, cot, layers, flat, meant, end, [("gauge", -D)])
    table = read_table(case.run(label, scene=case.write_scene(label, content)) / "probes.csv")
    times, level = table["time"], [y - D for y in table["gauge_level"]]
    name = f"slope 1:{cot}, H = {height} d, d/{layers}"
    found = max(table["shore_run_up"])/D - 1
    case.figure(f"{name}: R/d over Synolakis's {meant:.3f}, deviation", found/meant - 1, "within 0.05", abs(found/meant - 1) <= 0.05)
    case.state(f"{name}: largest level over d before the slope, less 1, over H/d", max(level)/D/height)
    curves.append((name, times, [y/D - 1 for y in table["shore_run_up"]], False))
    curves.append((f"{name}: Synolakis", [times[0], end], [meant, meant], False))
    # Seen at d/10: 0.76 by dfsph, 0.82 by isph, 0.48 by wcsph.
    case.hold(f"{name}: runs up, 0.4 to 1.3 of the law", 0.4 <= found/meant <= 1.3)


curves = []
for cot, height, layers in case.pick([(3, 0.15, 10)], [(3, 0.15, 15), (3, 0.15, 30)]):
    run_up(cot, height, layers)
case.plot("Run-up over depth", "t, s", "1", curves)
case.finish()
