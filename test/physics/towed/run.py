#!/usr/bin/python3
"""A sphere towed at constant speed: its drag becomes steady."""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, mean, read_table

case = Case("towed", "Towed sphere", """
A sphere D = 40 mm is towed at 0.1 m/s through liquid (1000 kg/m3, 0.04 Pa s): Re = 100. Steadiness: the standard
deviation over the mean of the drag in the last half of the run. Drag coefficient: the mean over rho U^2 / 2
pi D^2 / 4; 1.09 in an unbounded liquid (Roos & Willmarth 1971 and the textbook curve). Reference size: box of
15 x 10 x 10 D, periodic along the way, 8 particles across the sphere; the last half of 7 D of way.""")

D, U, RHO = 0.04, 0.1, 1000
end = case.pick(0.8, 2.8)
box, place, spacing = case.pick(("[0.24, 0.12, 0.12]", "[0.06, 0.06, 0.06]", 0.008),
                                ("[0.6, 0.4, 0.4]", "[0.06, 0.2, 0.2]", 0.005))
out = case.run("sphere", "--until", end, "--spacing", spacing, "--set", f"domain.max={box}",
               "--set", f"fluids[0].fill[0].box.max={box}", "--set", f"bodies[0].translation={place}")
bodies = read_table(out / "bodies.csv")
times = bodies["time"]
parts = {part: bodies[f"mean_{part}_force_x"] for part in ("pressure", "viscous")}
drag = [-(p + v) for p, v in zip(parts["pressure"], parts["viscous"])]
late = [f for t, f in zip(times, drag) if t > end/2]
level = mean(late)
variation = math.sqrt(mean([(f - level)**2 for f in late]))/abs(level)
case.figure("drag, variation in the last half (standard deviation / mean)", variation, "<= 0.10", variation <= 0.10)
coefficient = level/(RHO*U*U/2*math.pi*D*D/4)
case.figure("drag coefficient, 1.09 unbounded", coefficient, "within 10 %", abs(coefficient/1.09 - 1) <= 0.10)
viscous = mean([-v for t, v in zip(times, parts["viscous"]) if t > end/2])/level
case.state("viscous share of the drag (0.46 in theory)", viscous)
side = max(abs(mean([f for t, f in zip(times, [p + v for p, v in zip(bodies[f"mean_pressure_force_{a}"],
               bodies[f"mean_viscous_force_{a}"])]) if t > end/2])) for a in "yz")/level
case.figure("mean side force over drag", side, "<= 0.05", abs(side) <= 0.05)
# Five particles across the sphere: a factor of two in the coefficient is what such a sphere allows.
case.hold("the force is a drag: against the motion", level > 0)
case.hold("drag coefficient between 0.5 and 2.2", 0.5 <= coefficient <= 2.2)
# Before the fluid is set in motion there is a peak; afterwards single particles may matter at this size.
case.hold("drag varies by less than a third", variation <= 0.34)
case.plot("Drag", "t, s", "N", [("total", times[1:], drag[1:], False),
                                ("viscous", times[1:], [-v for v in parts["viscous"][1:]], False)])
case.finish()
