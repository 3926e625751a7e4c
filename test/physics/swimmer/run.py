#!/usr/bin/python3
"""An eel that swims by its own body wave: its speed, and no motion without water."""
import math
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, ROOT, read_table

case = Case("swimmer", "A free swimmer", methods=("isph",))

U = 0.54
curves = []


def find_mass():
    """kg per metre of depth: the mesh is a strip between the right side and its mirror image."""
    lines = (ROOT/"scenes/eel/meshes/eel.obj").read_text().splitlines()
    points = sorted({(float(x), abs(float(y))) for kind, x, y, *_ in (line.split() for line in lines) if kind == "v"})
    return 1000*sum((b[0] - a[0])*(a[1] + b[1]) for a, b in zip(points, points[1:]))


def swim(label, spacing, end, *options):
    out = case.run(label, "--spacing", spacing, "--until", end, *options, scene=ROOT/"scenes/eel/scene.json")
    eel, history = read_table(out/"bodies.csv"), read_table(out/"history.csv")
    mass = find_mass()
    together = [abs(h + mass*b) for h, b in zip(history["momentum_x"], eel["velocity_x"])]
    x, y, t = eel["position_x"], eel["position_y"], eel["time"]
    curves.append((f"{spacing*1000:g} mm", t[1:], [-v for v in eel["velocity_x"]][1:], False))

    def speed(first, beats):
        a, b = (min(range(len(t)), key=lambda k: abs(t[k] - at)) for at in (first, first + beats))
        return math.hypot(x[b] - x[a], y[b] - y[a])/(t[b] - t[a])

    def power(first, beats):
        a, b = (min(range(len(t)), key=lambda k: abs(t[k] - at)) for at in (first, first + beats))
        return (eel["motion_work"][b] - eel["motion_work"][a])/(t[b] - t[a])
    left = (eel["kinetic_energy"][-1] + history["kinetic_energy"][-1])/eel["motion_work"][-1]
    return {"speed": speed, "power": power, "left": left, "together": max(together)/(mass*max(abs(v) for v in eel["velocity_x"])),
            "x": x, "y": y}


dry = case.unit("test_swimmer")
found = re.search(r"([\d.e+-]+) m/s and ([\d.e+-]+) m2/s, by a lattice ([\d.e+-]+) and ([\d.e+-]+)", dry)
for text, value in zip(("momentum, m/s", "angular momentum, m2/s"), found.groups()[:2]):
    case.figure(f"without water: largest {text}", float(value), "<= 1e-11", float(value) <= 1e-11)

if case.smoke:
    small = ["--set", "domain.max=[3, 1]", "--set", "fluids[0].fill[0].box.max=[3, 1]",
             "--set", "bodies.eel.translation=[1.9, 0.5, 0]", "--set", "bodies.eel.motion.params.nose=[1.9, 0.5]"]
    run = swim("small", 0.04, 1.6, *small)
    # Four particles across the head, started from rest: it has not reached its speed.
    case.hold("the eel swims ahead at 0.2 to 0.6 L/T in its second beat", 0.2 <= run["speed"](0.6, 1) <= 0.6)
    # All that is given is in eel and water, but for what viscosity takes.
    case.hold(f"eel and water have 0.2 to 1 of the energy that was given ({run['left']:.3f})", 0.2 <= run["left"] <= 1)
    case.hold("and moves aside by less than a tenth of its length", abs(run["y"][-1] - run["y"][0]) < 0.1)
else:
    speeds, powers = {}, {}
    for spacing in (0.02, 0.0125):
        run = swim(f"eel_{spacing:g}", spacing, 7)
        label = f"{spacing*1000:g} mm"
        speeds[spacing] = run["speed"](5, 2)
        case.figure(f"{label}: speed, L/T; 0.54 published", speeds[spacing], "within 10 %", abs(speeds[spacing]/U - 1) <= 0.10)
        change = run["speed"](6, 1)/run["speed"](5, 1) - 1
        case.figure(f"{label}: change of speed from beat to beat", change, "within 0.02", abs(change) <= 0.02)
        case.state(f"{label}: Strouhal number of the wave, 2 x 0.125 L/(U T)", 0.25/speeds[spacing])
        powers[spacing] = run["power"](5, 2)
        case.state(f"{label}: power, W per metre of depth", powers[spacing])
        case.state(f"{label}: energy of eel and water at the end over that given", run["left"])
        case.figure(f"{label}: momentum of all over the eel's", run["together"], "<= 1e-3", run["together"] <= 1e-3)
    change = speeds[0.02]/speeds[0.0125] - 1
    case.figure("speed at 20 mm over that at 12.5 mm, less 1", change, "within 0.05", abs(change) <= 0.05)
    change = powers[0.02]/powers[0.0125] - 1
    case.figure("power at 20 mm over that at 12.5 mm, less 1", change, "within 0.1", abs(change) <= 0.1)
if case.smoke:
    case.figure("momentum of all over the eel's", run["together"], "<= 1e-3", run["together"] <= 1e-3)
case.plot("Speed", "t, s", "m/s", curves)
case.finish()
