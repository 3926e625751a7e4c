#!/usr/bin/python3
"""A wedge opens a double cantilever beam: stored energy and energy release against beam theory."""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, mean, read_table, write_prism

case = Case("wedge_split", "A wedge opens a double cantilever beam")

E, NU, HIGH, OPEN, R = 1e6, 0.3, 0.02, 0.004, 1.0
COLUMNS = ["transfer_dissipation", "plastic_work", "step_work", "damping_work", "friction_work", "fracture_work", "side_work"]


def split(cells, ratio, speed):
    a, d, half = ratio*HIGH, HIGH/cells/2, OPEN/2
    neck, ramp, back = half/40, 0.3*a, 0.01
    start, far, way = math.ceil((a + back + 0.01)/d)*d, 3.1*a, 2.2*a
    tall = math.ceil((HIGH + 8*half + 0.01)/d)*d
    mesh = write_prism(case.out/f"wedge_{ratio}.obj", [
        (-a - back, 0), (-a - back, -half), (-a, -half), (-a + ramp, -neck), (0, 0), (-a + ramp, neck), (-a, half),
        (-a - back, half)], -0.5, 0.5)
    out = case.solids(f"beam_{cells}_{ratio}", {
        "domain": {"min": [0, -tall], "max": [start + far, tall], "walls": {"x": ["separate", "no-slip"], "y": "separate"}},
        "spacing": d, "end_time": way/speed,
        "solids": [{"name": "beam", "density": 1000, "youngs_modulus": E, "poissons_ratio": NU, "cut_friction": 0,
                    "fill": [{"box": {"min": [start, -HIGH], "max": [start + far, HIGH]}}]}],
        "bodies": [{"name": "wedge", "mesh": str(mesh), "translation": [start, 0, 0], "blade": True, "edge_resistance": R,
                    "friction_coefficient": 0, "motion": {"translation": {"velocity": [speed, 0, 0]}}}],
        "mlsmpm": {"measure_transfer": True},
        "output": {"interval": way/speed/220, "fields": ["piece"], "surfaces": False}})
    return a, read_table(out/"history.csv"), read_table(out/"bodies.csv")


def judge(cells, ratio, speed, slack):
    """slack: of the statements held at smoke size, for elastic energy and energy release."""
    label = f"{cells} cells in h, a = {ratio} h"
    a, h, b = split(cells, ratio, speed)
    c = a + 0.673*HIGH
    U = E/(1 - NU*NU)*HIGH**3*OPEN**2/16/c**3
    G = 3*U/c
    xs = [speed*t for t in h["time"]]
    inside = [k for k, x in enumerate(xs) if 1.2*a <= x <= 2.2*a*(1 + 1e-9)]
    first, last = inside[0], inside[-1]
    swing = mean([h["kinetic_energy"][k] for k in inside])/U
    stored = mean([h["elastic_energy"][k] for k in inside])/U - swing
    edge = mean([-b["mean_edge_force_x"][k] for k in inside[1:]])
    def rate(column):
        return (h[column][last] - h[column][first])/(xs[last] - xs[first])
    case.figure(f"{label}: elastic energy less kinetic over U", stored, "1 within 15 %", abs(stored - 1) <= 0.15)
    case.figure(f"{label}: force of the edge over R", edge/R, "1 within 2 %", abs(edge/R - 1) <= 0.02)
    spent = rate("energy_lost") - rate("fracture_work")
    case.figure(f"{label}: energy lost per area less R, over G", spent/G, "1 within 15 %", abs(spent/G - 1) <= 0.15)
    case.state(f"{label}: work of the wedge per area less R, over G", (rate("work_bodies") - R)/G)
    case.state(f"{label}: kinetic energy over U", swing)
    closure = sum(h[k][-1] for k in COLUMNS)/h["energy_lost"][-1]
    case.figure(f"{label}: sum of the columns over energy_lost", closure, "within 0.02 of 1", abs(closure - 1) <= 0.02)
    case.hold(f"energy within {slack[0]:.0%}", abs(stored - 1) <= slack[0])
    case.hold(f"release within {slack[1]:.0%}", abs(spent/G - 1) <= slack[1])
    case.hold("edge within 2 %", abs(edge/R - 1) <= 0.02)
    case.hold("the columns add up within 1 %", abs(closure - 1) <= 0.01)
    case.plot(f"{label}", "way, m", "over U", [("elastic energy", xs, [e/U for e in h["elastic_energy"]], False),
                                               ("beam theory", [xs[0], xs[-1]], [1, 1], False)])


# 6 cells, four times as fast as the reference: the arms swing (a tenth of U is kinetic energy), and arms of few cells are
# too soft (0.8 U).
for cells, ratio, speed in case.pick([(6, 4, 0.4)], [(6, 4, 0.1), (10, 4, 0.15)]):
    judge(cells, ratio, speed, (0.3, 0.25))
case.finish()
