#!/usr/bin/python3
"""How thin a wing may be: water that gets through a plate at 2 m/s."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, read_series, read_table, read_vtu

case = Case("thin_wing", "Thin wing")

SPEED, END, FRONT = 2.0, 0.1, 0.07
thinnest, curves = None, []
for spacing in case.pick((0.01,), (0.01, 0.005)):
    for thickness in (0.05, 0.25, 0.5, 1, 2, 3):
        thick = thickness*spacing
        out = case.run(f"wing{spacing:g}_{thickness:g}", "--spacing", spacing, "--set", f"bodies[0].box.min[0]={FRONT - thick}")
        points = read_vtu(read_series(out)[-1][1])["Points"]
        middle = FRONT - thick/2 + SPEED*END
        behind = sum(x < middle for x in points[0::3])
        lost = int(read_table(out / "history.csv")["particles_lost"][-1])
        share = (behind + lost)/(len(points)//3 + lost)
        case.figure(f"{thickness:g} spacings of {1000*spacing:g} mm ({1000*thick:.3g} mm): share of the water that gets through",
                    share, "0", share == 0)
        table = read_table(out / "bodies.csv")
        force = table["mean_pressure_force_x"][-1]
        curves.append((f"{thickness:g} spacings of {1000*spacing:g} mm", table["time"][1:], table["mean_pressure_force_x"][1:], False))
        case.hold(f"{thickness:g} spacings: the water pushes back ({force:.2f} N)", force < 0)
        case.hold(f"{thickness:g} spacings: tight", share == 0)
        if share == 0:
            thinnest = min(thinnest or thickness, thickness)
case.state("thinnest wing that holds, spacings", thinnest if thinnest else "none")
case.plot("Force on the wing", "t, s", "N", curves)
case.finish()
