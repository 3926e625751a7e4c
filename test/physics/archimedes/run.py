#!/usr/bin/python3
"""Buoyancy of held bodies: Archimedes."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import ROOT, Case, mean, read_table

case = Case("archimedes", "Archimedes")

G, RHO, SIZE = 9.81, 1000, 0.1


def read_volume(path):
    """Volume of a closed triangle mesh (OBJ), by the divergence theorem."""
    points, total = [], 0.0
    for line in path.read_text().splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            points.append([float(w) for w in words[1:4]])
        elif words[:1] == ["f"]:
            a, b, c = (points[int(w.split("/")[0]) - 1] for w in words[1:])
            total += (a[0]*(b[1]*c[2] - b[2]*c[1]) - a[1]*(b[0]*c[2] - b[2]*c[0]) + a[2]*(b[0]*c[1] - b[1]*c[0]))/6
    return total


curves = []
for shape in ("sphere", "box"):
    volume = read_volume(ROOT / "test" / "meshes" / f"{shape}.obj")*SIZE**3
    for across in case.pick((6,), (8, 12, 16)):
        out = case.run(f"{shape}{across}", "--spacing", SIZE/across, "--until", case.pick(1.4, 2),
                       "--set", f"bodies[0].mesh=../../meshes/{shape}.obj")
        table = read_table(out / "bodies.csv")
        ratio = [f/(RHO*G*volume) for f in table["mean_pressure_force_z"]]
        value = mean([r for t, r in zip(table["time"], ratio) if t > 1.001])
        case.figure(f"{shape}, {across} across: buoyancy over rho g V, deviation", value - 1, "within 0.01",
                    abs(value - 1) <= 0.01)
        # Before the field inside the body was whole this was 0.2; six spacings across it is 0.05 to 0.08.
        case.hold(f"{shape}, {across} across: within 10 %", abs(value - 1) <= 0.10)
        curves.append((f"{shape}, {across} across", table["time"][1:], ratio[1:], False))
# A full tank: gravity is taken out of the flow and its pressure added exactly.
out = case.run("full", "--spacing", 0.025, "--until", 0.2, "--set", "fluids[0].fill[0].box.max=[0.3, 0.3, 0.4]",
               "--set", "bodies[0].mesh=../../meshes/box.obj")
full = read_table(out / "bodies.csv")["mean_pressure_force_z"][-1]/(RHO*G*SIZE**3)
case.hold(f"box in a full tank: {full:.6f} of its buoyancy", abs(full - 1) <= 1e-6)
case.plot("Buoyancy", "t, s", "F / rho g V", curves)
case.finish()
