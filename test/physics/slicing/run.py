#!/usr/bin/python3
"""Pushing and drawing a blade: the shares of its edge's force, and a free blade that is stopped or not."""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, mean, read_table, write_blade

case = Case("slicing", "Pushing and drawing a blade")

R, WIDE, PUSH, MASS = 250, 0.03, 0.25, 0.02
cells = case.pick(6, 12)
d = WIDE/cells/2
FULL = R*WIDE


def press(label, reach, end, damping, **knife):
    """reach: m, by which the blade sticks out of the block at either end; the edge starts on the block."""
    mesh = write_blade(case.out/f"blade_{reach:.4f}.obj", 1e-3, 3e-3, 0.045, -reach - WIDE/2, reach + WIDE/2, "y")
    far = WIDE/2 + 2*reach + 0.02
    out = case.solids(label, {
        "domain": {"min": [-0.03, -far, 0], "max": [0.03, far, 0.1], "walls": {"x": "separate", "y": "separate", "z": "no-slip"}},
        "spacing": d, "end_time": end,
        "solids": [{"name": "block", "density": 1000, "youngs_modulus": 1e6, "poissons_ratio": 0.3, "cut_friction": 0,
                    "damping": damping, "fill": [{"box": {"min": [-WIDE/2, -WIDE/2, 0], "max": [WIDE/2, WIDE/2, WIDE]}}]}],
        "bodies": [{"name": "knife", "mesh": str(mesh), "blade": True, "edge_resistance": R, "friction_coefficient": 0, **knife}],
        "output": {"interval": end/100, "fields": ["piece"], "surfaces": False}})
    return read_table(out/"bodies.csv"), read_table(out/"history.csv")


pushes, slices, ratios = [], [], case.pick([0, 2], [0, 0.5, 1, 2, 4])


def draw(xi, damping):
    """Mean force of the edge downwards and along, over R W."""
    way = 0.9*WIDE
    b, _ = press(f"drawn_{xi}_{damping}", xi*way/2 + 0.005, way/PUSH, damping, translation=[3e-4, -xi*way/2, WIDE],
                 motion={"translation": {"velocity": [0, xi*PUSH, -PUSH]}})
    inside = [k for k, t in enumerate(b["time"]) if 0.3*WIDE <= PUSH*t <= 0.8*WIDE]
    return mean([b["mean_edge_force_z"][k] for k in inside])/FULL, mean([-b["mean_edge_force_y"][k] for k in inside])/FULL


for xi in ratios:
    push, along = draw(xi, 1000)
    pushes.append(push)
    slices.append(along)
    want = [1/(1 + xi*xi), xi/(1 + xi*xi)]
    case.figure(f"xi = {xi}: F_push over R W", push, f"{want[0]:.4g} within 5 %", abs(push/want[0] - 1) <= 0.05)
    if xi:
        case.figure(f"xi = {xi}: F_slice over R W", along, f"{want[1]:.4g} within 5 %", abs(along/want[1] - 1) <= 0.05)
    # 6 cells: the ends of the edge in the block are uncertain by a quarter of a cell each.
    case.hold("both within 10 %", abs(push - want[0]) <= 0.1*want[0] and abs(along - want[1]) <= max(0.1*want[1], 0.01))

if not case.smoke:
    push, along = draw(2, 0)
    case.state("xi = 2 without damping: F_push over R W", push)
    case.state("xi = 2 without damping: F_slice over R W", along)

ramp = case.out/"ramp.lua"
ramp.write_text("""function control(t, body)
    local share = math.min(1, t/params.rise)
    return { force = { 0, share*params.along, -share*params.down } }
end
""")
for label, down, along in (("pushed with 0.8 R W", 0.8, 0), ("pushed with 1.5 R W", 1.5, 0),
                           ("pushed and drawn with 0.8 R W each", 0.8, 0.8)):
    through = down**2 + along**2 > 1
    rise, end = 0.05, 0.1 if through else 0.15
    b, h = press(label.replace(" ", "_"), 0.06, end, 0, translation=[3e-4, 0, WIDE], dynamics="controlled", mass=MASS,
                 locked="x,turn", control={"script": str(ramp.resolve()), "params": {
                     "rise": rise, "along": along*FULL, "down": down*FULL}})
    deep = (b["position_z"][0] - min(b["position_z"]))/WIDE
    spent = h["fracture_work"][-1]/FULL/WIDE
    if through:
        case.figure(f"{label}: depth over the height", deep, "at least 0.9", deep >= 0.9)
        case.hold("it goes through", deep >= 0.9)
        continue
    at = [next(z for z, t in zip(b["position_z"], b["time"]) if t >= when*(1 - 1e-9)) for when in (rise, rise + 0.1)]
    case.state(f"{label}: way of the blade over the spacing, the block's giving way included", deep*WIDE/d)
    case.figure(f"{label}: depth cut over the spacing", spent*WIDE/d, "at most 1", spent*WIDE/d <= 1)
    case.figure(f"{label}: way in the last 0.1 s over the spacing", (at[0] - at[1])/d, "at most 0.1", (at[0] - at[1])/d <= 0.1)
    # What is left of the way is the block that goes on giving way. Pieces of the edge that start from their mean creep by 0.7 mm/s besides.
    case.hold("it stays", spent*WIDE <= d and at[0] - at[1] <= 0.15*d)
xs = [k/25 for k in range(101)]
case.plot("Force of the edge over R W", "xi", "", [
    ("F_push", ratios, pushes, True), ("F_slice", ratios, slices, True), ("1/(1 + xi^2)", xs, [1/(1 + x*x) for x in xs], False),
    ("xi/(1 + xi^2)", xs, [x/(1 + x*x) for x in xs], False)])
case.finish()
