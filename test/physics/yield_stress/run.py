#!/usr/bin/python3
"""Liquids with a yield stress and a flow index: a channel against theory, a cylinder that slumps."""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import ROOT, Case, read_series, read_vtu

case = Case("yield_stress", "Liquids with a yield stress")

HALF, PULL, HIGH, RHO, G = 0.02, 2, 0.2, 2000, 9.81


def channel(method, layers, consistency, stress, index):
    """What flows over theory, and places and speeds."""
    d = HALF/layers
    out = case.run(f"channel_{method}_{layers}_{stress}", scene=case.write_scene(f"channel_{method}_{layers}_{stress}", {
        "dimension": 2, "domain": {"min": [0, -HALF], "max": [8*d, HALF], "walls": {"x": "periodic", "y": "no-slip"}},
        "gravity": [PULL, 0], "spacing": d, "end_time": 1, "method": method, "implicit_viscosity": True,
        "fluids": [{"name": "mud", "viscosity": consistency, "yield_stress": stress, "flow_index": index,
                    "fill": [{"box": {"min": [0, -HALF], "max": [8*d, HALF]}}]}],
        "output": {"interval": 1, "surfaces": False}}))
    last = read_vtu(read_series(out)[-1][1])
    ys, us = list(last["Points"][1::3]), list(last["velocity"][0::3])
    return sum(us)/sum(speed(y, consistency, stress, index) for y in ys), ys, us


def speed(y, consistency, stress, n):
    """m/s: below the yield stress the middle of the channel moves as one piece."""
    fall = 1000*PULL
    solid, p = stress/fall, (n + 1)/n
    return n/(n + 1)*(fall/consistency)**(1/n)*((HALF - solid)**p - max(abs(y) - solid, 0)**p)


def slump(method, layers, share):
    """Times, and what is lost of the height on the axis, over the height."""
    d, room = HIGH/layers, 2*HIGH
    label = f"slump_{method}_{layers}_{share}"
    out = case.run(label, scene=case.write_scene(label, {
        "domain": {"min": [-room, -room, 0], "max": [room, room, 1.2*HIGH], "walls": {"z": "no-slip"}}, "spacing": d,
        "end_time": case.pick(2, 4), "method": method, "implicit_viscosity": True,
        "fluids": [{"name": "concrete", "density": RHO, "viscosity": 100, "yield_stress": share*RHO*G*HIGH,
                    "fill": [{"mesh": str(ROOT/"test"/"meshes"/"cylinder.obj"), "scale": HIGH, "translation": [0, 0, HIGH/2]}]}],
        "output": {"interval": 0.2, "surfaces": False}}))
    times, lost = [], []
    for t, path in read_series(out):
        p = read_vtu(path)["Points"]
        times.append(t)
        lost.append(1 - (max(z for x, y, z in zip(p[0::3], p[1::3], p[2::3]) if math.hypot(x, y) < 2*d) + d/2)/HIGH)
    return times, lost


curves = []
for method in "dfsph", "isph":
    for layers in case.pick((10,), (10, 20, 40)):
        for consistency, stress, index in (1, 10, 1), (10, 0, 0.5):
            flow, ys, us = channel(method, layers, consistency, stress, index)
            kind = f"yield stress {stress} Pa" if stress else f"flow index {index}"
            text = f"{method}: channel of {2*layers} layers, {kind}: flow over theory"
            case.figure(text, flow, "1 within 0.02", abs(flow - 1) <= 0.02)
            if method == "isph" and layers == case.pick(10, 40) and stress:
                curves += [("theory", [HALF*k/100 for k in range(101)], [speed(HALF*k/100, 1, 10, 1) for k in range(101)], False),
                           (f"isph, {2*layers} layers", [abs(y) for y in ys], us, True)]
case.plot("Bingham liquid in a channel", "distance from the middle, m", "m/s", curves)
for method in "dfsph", "isph":
    for layers in case.pick((8,), (10, 16)):
        for share in case.pick((0.1,), (0.1, 0.2)):
            times, lost = slump(method, layers, share)
            exact = 1 - 2*share*(1 - math.log(2*share))
            text = f"{method}: cylinder of {layers} layers, {share:g} rho g H: slump less that of theory, {exact:.3f}"
            case.figure(text, lost[-1] - exact, "within 0.05", abs(lost[-1] - exact) <= 0.05)
            mises = math.sqrt(3)*share
            case.state(f"{method}: cylinder of {layers} layers, {share:g} rho g H: the same by von Mises", lost[-1] - 1 + mises*(1 - math.log(mises)))
            case.hold(f"{method}, {layers} layers: it slumps and stops, {lost[-1] - lost[-2]:.4f} in the last 0.2 s",
                      0.1 < lost[-1] < 0.6 and lost[-1] - lost[-2] < 0.02)
case.finish()
