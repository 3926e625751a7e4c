#!/usr/bin/python3
"""Water that begins beside the walls falls to them: its level."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, mean, read_table

case = Case("gap_start", "Water that begins beside the walls")

D, END = 0.02, 4


def settle(dimension, gap):
    """Level over that of the water's volume, and the share of particles at a surface at the end."""
    size, depth = [0.6, 0.4][:dimension - 1], 0.32
    low = [gap]*dimension
    high = [s - gap for s in size] + [depth + gap]
    places = [[0.15], [0.3], [0.45]] if dimension == 2 else [[0.3, 0.2]]
    label = f"pool_{dimension}d_{'gap' if gap else 'sides'}"
    scene = case.write_scene(label, {
        "dimension": dimension, "domain": {"min": [0]*dimension, "max": size + [0.5]},
        "gravity": [0]*(dimension - 1) + [-9.81], "spacing": D, "end_time": END,
        "fluids": [{"name": "water", "density": 1000, "viscosity": 1e-3, "fill": [{"box": {"min": low, "max": high}}]}],
        "probes": [{"name": f"p{k}", "kind": "level", "position": place + [0]} for k, place in enumerate(places)],
        "output": {"interval": 0.5, "fields": ["velocity"]}})
    out = case.run(label, scene=scene)
    volume, floor = 1.0, 1.0
    for a, b in zip(low, high):
        volume *= b - a
    for s in size:
        floor *= s
    probes = read_table(out / "probes.csv")
    late = [k for k, t in enumerate(probes["time"]) if t > END - 1]
    level = mean([mean([probes[f"p{k}_level"][i] for i in late]) for k in range(len(places))])
    return level*floor/volume, read_table(out / "history.csv")["surface_share"][-1]


shares = {}
for dimension in case.pick((2,), (2, 3)):
    for gap in 0, 1.5*D:
        level, share = settle(dimension, gap)
        what = f"{dimension}-D, " + ("gap of 1.5 spacings" if gap else "begun at the sides")
        case.figure(f"{what}: level over that of the volume", level, "1 within 0.01", abs(level - 1) <= 0.01)
        case.state(f"{what}: share of particles at a free surface", share)
        # Sides: a tenth of a spacing is 0.6 %. Gap: 1.1 % seen in 3-D; voids that stay are 4 to 6 %.
        limit = 0.02 if gap else 0.01
        case.hold(f"{what}: level within {limit:g}", abs(level - 1) <= limit)
        shares[gap] = share
    # Voids would be told by surface_share in history.csv, as 0.17 beside 0.06.
    case.hold(f"{dimension}-D: with a gap no voids stay", shares[1.5*D] < 1.3*shares[0])
case.finish()
