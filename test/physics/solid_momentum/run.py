#!/usr/bin/python3
"""Momentum of solids changes by the external impulse; what they lose to a body, the body gets."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, read_table

case = Case("solid_momentum", "Momentum balance of solids")


STEP = 2.5e-4      # s, below every limit, so that each step is an output


def thrown(dim, transfer):
    """Largest error of the balance over the sum of |F| dt."""
    d = 0.0125 if dim == 2 else 0.02
    out = case.solids(f"sides_{dim}_{transfer}", {
        "domain": {"min": [0]*dim, "max": [0.5]*dim, "friction": 0.3,
                   "walls": {axis: ["separate", "slip"] for axis in "xyz"[:dim]}},
        "gravity": [0]*(dim - 1) + [-9.81], "spacing": d, "end_time": case.pick(0.08, 0.4),
        "solids": [{"name": "block", "youngs_modulus": 1e5, "fill": [
            {"box": {"min": [0.1]*dim, "max": [0.3]*dim}, "velocity": [-1.5, 0.7, -2][-dim:]}]}],
        "mlsmpm": {"transfer": transfer}, "time_step": STEP, "output": {"interval": STEP, "fields": ["velocity"]}})
    h = read_table(out/"history.csv")
    time, weight = h["time"], h["weight"]
    case.hold(f"sides {dim}-D {transfer}: every step is an output, none at the same time",
              int(h["step"][-1]) == len(time) - 1)
    scale, error, impulse, errors = 0.0, 0.0, [0.0]*dim, [0.0]
    for i in range(1, len(time)):
        dt = h["dt"][i]
        force = [-h[f"wall_force_{a}"][i] - (weight[i] if k == dim - 1 else 0) for k, a in enumerate("xyz"[:dim])]
        scale += dt*(weight[i] + sum(h[f"wall_force_{a}"][i]**2 for a in "xyz")**0.5)
        for k, a in enumerate("xyz"[:dim]):
            impulse[k] += force[k]*dt
            error = max(error, abs(h[f"momentum_{a}"][i] - h[f"momentum_{a}"][0] - impulse[k]))
        errors.append(error)
    case.hold(f"sides {dim}-D {transfer}: it met them", any(abs(f) > 1 for f in h["wall_force_x"]))
    curves.append((f"{dim}-D, {transfer}", time, [e/scale for e in errors], False))
    return error/scale


def against_body(dim):
    """Largest |solid + body - start| over the momentum exchanged, of linear momentum."""
    d = 0.0125 if dim == 2 else 0.02
    mass = 500*0.2**dim
    out = case.solids(f"body_{dim}", {
        "domain": {"min": [0] + [-0.4]*(dim - 1), "max": [1.2] + [0.8]*(dim - 1)}, "spacing": d, "end_time": case.pick(0.05, 0.2),
        "solids": [{"name": "block", "youngs_modulus": 1e5, "fill": [
            {"box": {"min": [0.1]*dim, "max": [0.3]*dim}, "velocity": [2, 0, 0][:dim]}]}],
        "bodies": [{"name": "target", "dynamics": "free", "mass": mass, "box": {
            "min": [0.35, 0.2, 0.15], "max": [0.5, 0.4, 0.35]}}],
        "time_step": STEP, "output": {"interval": STEP, "fields": ["velocity"], "surfaces": False}})
    h, b = read_table(out/"history.csv"), read_table(out/"bodies.csv")
    error, moved = 0.0, 0.0
    for a in "xyz"[:dim]:
        start = h[f"momentum_{a}"][0]
        case.hold(f"body {dim}-D: no side met along {a}", not any(h[f"wall_force_{a}"]))
        for p, v in zip(h[f"momentum_{a}"], b[f"velocity_{a}"]):
            error = max(error, abs(p + mass*v - start))
            moved = max(moved, abs(mass*v))
    return error, moved


found, curves = [], []
for dim, transfer in case.pick([(2, "apic"), (2, "flip")], [(2, "apic"), (2, "flip"), (2, "xpic"), (3, "apic"), (3, "flip")]):
    error = thrown(dim, transfer)
    found.append(error)
    case.figure(f"sides, {dim}-D, {transfer}: error of the balance over the sum of |F| dt", error, "<= 1e-6", error <= 1e-6)
for dim in (2, 3):
    error, moved = against_body(dim)
    found.append(error/moved)
    case.hold(f"body, {dim}-D: they met", moved > 0.1*1000*0.2**dim*2)
    case.figure(f"body, {dim}-D: solid and body together, change over what went over", error/moved, "<= 1e-6", error/moved <= 1e-6)
case.plot("Largest error of the balance up to a time, over the sum of |F| dt", "t, s", "1", curves)
# Float sums over some thousand particles, hundreds of steps of 6e-8 each, which cancel.
case.hold("all within 1e-6", max(found) <= 1e-6)
case.finish()
