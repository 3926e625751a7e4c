#!/usr/bin/python3
"""Nothing passes a closed body thicker than a cell."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, read_series, read_table, read_vtu

case = Case("leak", "Leak through a body")

curves = []


def shoot(label, dim, model, angle=0, moving=0):
    """Most particles behind the middle of the plate at any output."""
    d = 0.0125 if dim == 2 else 0.02
    cell, reach = 2*d, 1.0
    at = 0.3 + cell/3
    thin = 1.2*cell
    solid = {"name": "jet", "model": model, "fill": [
        {"box": {"min": [0.02] + [0.4]*(dim - 1), "max": [0.22] + [0.6]*(dim - 1)},
         "velocity": [0 if moving else 10, 0, 0][:dim]}]}
    solid.update({"liquid": {"bulk_modulus": 1e6}, "sand": {"youngs_modulus": 1e6}}.get(model, {"youngs_modulus": 1e5}))
    plate = {"name": "plate", "box": {"min": [-thin/2, -0.45, -0.45], "max": [thin/2, 0.45, 0.45]},
             "translation": [at, 0.5, 0.5 if dim == 3 else 0],
             "rotation": {"axis": [0, 0, 1], "angle": angle}}
    if moving:
        plate["motion"] = {"translation": {"velocity": [-moving, 0, 0][:dim]}}
    end = 0.03
    out = case.solids(label, {
        "domain": {"min": [-0.6] + [0]*(dim - 1), "max": [0.8] + [reach]*(dim - 1)}, "spacing": d, "end_time": end,
        "solids": [solid], "bodies": [plate],
        "output": {"interval": end/15, "fields": ["velocity"], "surfaces": False}})
    behind = 0
    slope = {0: 0.0, 20: 0.36397}[angle]
    for t, path in read_series(out):
        x = read_vtu(path)["Points"]
        behind = max(behind, sum(1 for i in range(0, len(x), 3) if x[i] > at - moving*t - slope*(x[i + 1] - 0.5)))
    h = read_table(out/"history.csv")
    curves.append((label, h["time"], [p/(1000*10*0.2**dim) for p in h["momentum_x"]], False))
    case.hold(f"{label}: the plate was hit", max(h["contacts"]) > 0)
    return behind, h["fluid_particles"][0], h["particles_lost"][-1]


for dim, model, angle, moving in case.pick(
        [(2, "neo-hookean", 0, 0), (2, "liquid", 0, 0), (2, "liquid", 20, 0), (2, "sand", 0, 0), (2, "neo-hookean", 20, 0),
         (2, "liquid", 0, 10), (3, "liquid", 0, 0)],
        [(2, "neo-hookean", 0, 0), (2, "liquid", 0, 0), (2, "liquid", 20, 0), (2, "sand", 0, 0), (2, "snow", 20, 0),
         (2, "neo-hookean", 20, 0), (2, "liquid", 0, 10), (3, "liquid", 0, 0), (3, "neo-hookean", 20, 0), (3, "sand", 0, 10)]):
    label = f"{dim}d_{model}_{angle}_{moving}"
    behind, count, lost = shoot(label, dim, model, angle, moving)
    text = f"{dim}-D, {model}, turned by {angle} degrees, {'plate' if moving else 'material'} at 10 m/s"
    case.figure(f"{text}: particles of {int(count)} behind the plate", behind, "0", behind == 0)
    case.hold(f"{text}: none behind, none lost", behind == 0 and lost == 0)
case.plot("Momentum of the material towards the plate, over that of the shot", "t, s", "1", curves)
case.finish()
