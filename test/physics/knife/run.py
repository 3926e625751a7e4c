#!/usr/bin/python3
"""A blade is driven through a ball: force on its edge, total force at several spacings, balance of energy."""
import json
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, mean, read_table, write_blade

case = Case("knife", "A blade through a ball")

R, RADIUS, SPEED, START, THICK, OUTPUT = 250, 0.039, 0.5, 0.08, 3e-3, 1e-3
DEEP = 2*RADIUS
COLUMNS = ["transfer_dissipation", "plastic_work", "step_work", "damping_work", "friction_work", "fracture_work", "side_work"]


def force(y):
    return 2*R*math.sqrt(max(0, RADIUS**2 - (RADIUS - y)**2))


def cut(spacing):
    mesh = write_blade(case.out/"blade.obj", THICK, 8e-3, 0.1, -0.06, 0.06, "y")
    return case.solids(f"ball_{spacing*1e3:g}mm", {
        "domain": {"min": [-0.075, -0.075, 0], "max": [0.075, 0.075, 0.2], "walls": {a: "separate" for a in "xyz"},
                   "friction": 0.5},
        "spacing": spacing, "end_time": (START - 5e-4)/SPEED,
        "solids": [{"name": "ball", "density": 787, "youngs_modulus": 3e6, "poissons_ratio": 0.17, "cut_friction": 0.3,
                    "fill": [{"sphere": {"centre": [0, 0, RADIUS], "radius": RADIUS}}]}],
        "bodies": [{"name": "knife", "mesh": str(mesh), "translation": [4e-4, 0, START], "blade": True,
                    "edge_resistance": R, "friction_coefficient": 0.3,
                    "motion": {"translation": {"velocity": [0, 0, -SPEED]}}}],
        "mlsmpm": {"measure_transfer": True},
        "output": {"interval": OUTPUT, "fields": ["piece"], "surfaces": False}})


def judge(spacing):
    """Figures of one spacing; returns mean force of the edge and of all, N, over 10 to 90 % of the depth."""
    mm = f"{spacing*1e3:.4g} mm"
    out = cut(spacing)
    b, h = read_table(out/"bodies.csv"), read_table(out/"history.csv")
    summary = json.loads((out/"summary.json").read_text())
    ys = [DEEP - START + SPEED*(t - OUTPUT/2) for t in b["time"]]
    edges = b["mean_edge_force_z"]
    totals = [p + v for p, v in zip(b["mean_pressure_force_z"], b["mean_viscous_force_z"])]
    inside = [k for k, y in enumerate(ys) if 0.1*DEEP <= y <= 0.9*DEEP]
    away = [edges[k]/force(ys[k]) - 1 for k in inside]
    edge, total = (mean([f[k] for k in inside]) for f in (edges, totals))
    rub = mean([b["mean_viscous_force_z"][k] for k in inside])
    case.figure(f"{mm}: edge against F(y), mean", mean(away), "within 0.2", abs(mean(away)) <= 0.2)
    case.figure(f"{mm}: edge against F(y), largest", max(away, key=abs), "within 0.2", abs(max(away, key=abs)) <= 0.2)
    case.state(f"{mm}: mean force on the edge, N", edge)
    case.state(f"{mm}: mean force normal to the faces, N", total - rub - edge)
    case.state(f"{mm}: mean friction, N", rub)
    work = h["fracture_work"][-1]/(R*math.pi*RADIUS**2)
    case.figure(f"{mm}: fracture_work over R pi r^2", work, "within 0.1 of 1", abs(work - 1) <= 0.1)
    closure = sum(h[c][-1] for c in COLUMNS)/h["energy_lost"][-1]
    case.figure(f"{mm}: sum of the columns over energy_lost", closure, "within 0.02 of 1", abs(closure - 1) <= 0.02)
    for c in ("work_bodies", "friction_work", "transfer_dissipation", "step_work"):
        case.state(f"{mm}: {c}, J", h[c][-1])
    whole = 787*4/3*math.pi*RADIUS**3
    pieces = [p["mass"] for p in summary["piece_list"]] + [summary["piece_rest"]["mass"], summary["fragments"]["mass"]]
    case.figure(f"{mm}: pieces", summary["pieces"], "2, no fragments",
                summary["pieces"] == 2 and summary["fragments"]["count"] == 0)
    case.figure(f"{mm}: mass of the pieces over that of the ball, less 1", sum(pieces)/whole - 1, "within 1e-6",
                abs(sum(pieces)/whole - 1) <= 1e-6)
    # 5 mm: a ball of 4 cells in its radius, and a chord that ends half a cell early at either end.
    case.hold("edge within 20 % in the mean", abs(mean(away)) <= 0.2)
    case.hold("two pieces", summary["pieces"] == 2)
    case.hold("fracture_work within 20 %", abs(work - 1) <= 0.2)
    case.hold("the columns add up within 1 %", abs(closure - 1) <= 0.01)
    return edge, total, ys, edges, totals


spacings = case.pick([0.005], [0.6/192, 0.6/256, 0.6/384])
results = [judge(d) for d in spacings]
for (d, first), (e, second) in zip(list(zip(spacings, results))[:-1], list(zip(spacings, results))[1:]):
    for name, n in (("edge", 0), ("all forces", 1)):
        change = second[n]/first[n] - 1
        case.figure(f"{name}: mean at {e*1e3:.4g} mm over that at {d*1e3:.4g} mm, less 1", change, "within 0.1",
                    abs(change) <= 0.1)
depth = [DEEP*k/100 for k in range(101)]
for title, n in (("edge", 3), ("all forces", 4)):
    curves = [(f"{d*1e3:.4g} mm", r[2], r[n], False) for d, r in zip(spacings, results)]
    case.plot(f"Force, {title}", "depth, m", "F, N", curves + ([("F(y)", depth, [force(y) for y in depth], False)] if n == 3 else []))
case.finish()
