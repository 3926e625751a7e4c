#!/usr/bin/python3
"""A sheet of water that meets a wall, and a step, against the theory of free streamlines."""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, interpolate, mean, read_table

case = Case("jet", "A sheet against a wall")

U, RHO, STEP, LENGTH = 2.0, 1000, 1.6, 16
HEAD = RHO*U*U/2
UP = [(k + 0.5)/4 for k in range(16)]               # sensors on the wall over h
ON_STEP = [0.131, 0.381, 0.631, 0.881]              # on the step over its height


def profile(angle, steps=4000):
    """Heights over h at speeds q = 0 .. 1 - 1/steps (midpoint rule), and the pressures there over HEAD."""
    s2, heights, pressures, y = math.sin(angle)**2, [0], [1], 0
    for k in range(steps - 1):
        q2 = ((k + 0.5)/steps)**2
        y += 4/math.pi/steps*(1/(1 + q2) - (1 + q2 - 2*s2)/((1 + q2)**2 - 4*s2*q2))
        heights.append(y)
        pressures.append(1 - ((k + 1)/steps)**2)
    return heights, pressures


def angle_of_step(height):
    low, high = 0.1, math.pi/2 - 1e-3
    for _ in range(40):
        middle = (low + high)/2
        low, high = (middle, high) if profile(middle)[0][-1] < height else (low, middle)
    return low


def run(kind, layers):
    """Force over rho U^2 h, from the momentum that the water loses, and pressures at the sensors over HEAD."""
    h = 0.1
    wall = (LENGTH + 1)*h
    heights = [y*h for y in UP] if kind == "wall" else [z*STEP*h for z in ON_STEP]
    scene = {
        "dimension": 2, "domain": {"min": [0, 0], "max": [wall + (0 if kind == "wall" else 9*h), 20*h],
                                   "walls": {"x": "slip", "y": "slip"}},
        "gravity": [0, 0], "spacing": h/layers, "end_time": 11*h/U,
        "fluids": [{"name": "water", "density": RHO, "viscosity": 1e-3,
                    "fill": [{"box": {"min": [h, 0], "max": [wall, h]}, "velocity": [U, 0]}]}],
        "probes": [{"name": f"S{k}", "position": [wall, y, 0]} for k, y in enumerate(heights)],
        "output": {"interval": h/U/4, "fields": ["velocity", "pressure"]}}
    if kind == "step":
        scene["bodies"] = [{"name": "step", "box": {"min": [wall, 0, -1], "max": [wall + h, STEP*h, 1]}}]
    out = case.run(f"{kind}{layers}", scene=case.write_scene(f"{kind}{layers}", scene))
    table = read_table(out / "probes.csv")
    steady = [k for k, t in enumerate(table["time"]) if t*U/h > 5]
    pressures = [mean([table[f"S{k}_pressure"][i] for i in steady])/HEAD for k in range(len(heights))]
    history = read_table(out / "history.csv")       # nothing else pushes along x
    start, end = (interpolate(history["time"], history["momentum_x"], t*h/U) for t in (5, 10.99))
    return (start - end)/(5.99*h/U)/(RHO*U*U*h), pressures


step_angle = angle_of_step(STEP)
theory = {"wall": profile(math.pi/2), "step": profile(step_angle)}
curves = {kind: [("theory", *theory[kind], False)] for kind in theory}
for layers in case.pick((4, 8), (4, 8, 16)):
    force, pressures = run("wall", layers)
    case.figure(f"{layers} spacings thick, wall: force over rho U^2 h, deviation", force - 1, "within 0.03", abs(force - 1) <= 0.03)
    summed = sum(pressures)/4/2
    case.figure(f"{layers} spacings thick, wall: integral of the sensors over it, deviation", summed - 1, "within 0.05",
                abs(summed - 1) <= 0.05)
    error = mean([abs(p - interpolate(*theory["wall"], y)) for y, p in zip(UP, pressures)])
    case.figure(f"{layers} spacings thick, wall: mean deviation of the pressure over rho U^2 / 2", error, "<= 0.05", error <= 0.05)
    # A solver that loses a tenth of the force, or spreads it twice as wide, fails this.
    case.hold(f"{layers} spacings thick: force within 6 %, pressures within 0.08", abs(force - 1) <= 0.06 and error <= 0.08)
    curves["wall"].append((f"{layers} spacings", UP, pressures, True))
    force, pressures = run("step", layers)
    exact = 1 - math.cos(step_angle)
    case.figure(f"{layers} spacings thick, step: force over rho U^2 h, {force:.3f} against {exact:.3f}, deviation", force/exact - 1,
                "within 0.05", abs(force/exact - 1) <= 0.05)
    for z, p in zip(ON_STEP, pressures):
        right = interpolate(*theory["step"], z*STEP)
        case.figure(f"{layers} spacings thick, step: pressure at {z} of its height, {p:.3f} against {right:.3f}, deviation", p - right,
                    "within 0.08", abs(p - right) <= 0.08)
    case.hold(f"{layers} spacings thick: force on the step within 12 %", abs(force/exact - 1) <= 0.12)
    curves["step"].append((f"{layers} spacings", [z*STEP for z in ON_STEP], pressures, True))
for kind in curves:
    case.plot(f"Pressure on the {kind}", "y / h", "p / (rho U^2 / 2)", curves[kind])
case.finish()
