#!/usr/bin/python3
"""A sphere towed at constant speed: its drag becomes steady."""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, mean, read_table

case = Case("towed", "Towed sphere",
            methods=("isph",))

D, U, RHO = 0.04, 0.1, 1000
curves = []


def tow(label, across, box, end):
    """Times, drag and its viscous part in N, side force over drag and the mean density error at the end."""
    size = [round(b*D, 6) for b in box]
    place = [1.5*D, size[1]/2, size[2]/2]
    out = case.run(label, "--until", end, "--spacing", D/across, "--set", f"domain.max={size}",
                   "--set", f"fluids[0].fill[0].box.max={size}", "--set", f"bodies[0].translation={place}")
    bodies = read_table(out / "bodies.csv")
    force = {a: [p + v for p, v in zip(bodies[f"mean_pressure_force_{a}"], bodies[f"mean_viscous_force_{a}"])] for a in "xyz"}
    late = [k for k, t in enumerate(bodies["time"]) if t > end/2]
    drag, viscous = [-f for f in force["x"]], [-v for v in bodies["mean_viscous_force_x"]]
    level = mean([drag[k] for k in late])
    curves.append((label.replace("_", " "), bodies["time"][1:], drag[1:], False))
    return {"level": level, "variation": math.sqrt(mean([(drag[k] - level)**2 for k in late]))/abs(level),
            "viscous": mean([viscous[k] for k in late])/level, "side": max(abs(mean([force[a][k] for k in late])) for a in "yz")/level,
            "coefficient": level/(RHO*U*U/2*math.pi*D*D/4), "density": read_table(out / "history.csv")["density_error_mean"][-1]}


main = tow(*case.pick(("sphere", 5, (6, 3, 3), 0.8), ("sphere", 8, (15, 10, 10), 2.8)))
case.figure("drag, variation in the last half (standard deviation / mean)", main["variation"], "<= 0.10", main["variation"] <= 0.10)
case.figure("drag coefficient, 1.09 unbounded", main["coefficient"], "within 10 %", abs(main["coefficient"]/1.09 - 1) <= 0.10)
case.state("viscous share of the drag", main["viscous"])
case.state("mean density error at the end", main["density"])
case.figure("mean side force over drag", main["side"], "<= 0.05", abs(main["side"]) <= 0.05)
for across in case.pick((), (5, 8, 12)):
    small = tow(f"small_{across}", across, (6, 4, 4), 1.6)
    case.state(f"box of 6 x 4 x 4 D, {across} across: drag coefficient", small["coefficient"])
    case.state(f"box of 6 x 4 x 4 D, {across} across: its viscous part", small["coefficient"]*small["viscous"])
# Five particles across the sphere: a factor of two in the coefficient is what such a sphere allows.
case.hold("the force is a drag: against the motion", main["level"] > 0)
case.hold("drag coefficient between 0.5 and 2.2", 0.5 <= main["coefficient"] <= 2.2)
# Before the fluid is set in motion there is a peak; afterwards single particles may matter at this size.
case.hold("drag varies by less than a third", main["variation"] <= 0.34)
case.plot("Drag", "t, s", "N", curves)
case.finish()
