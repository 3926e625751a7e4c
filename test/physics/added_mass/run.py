#!/usr/bin/python3
"""Added mass of a plate and of a square that speed up."""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, mean, read_table

case = Case("added_mass", "Added mass of a plate and of a square",
            methods=("isph",))

RHO, B, STEPS = 1000, 0.16, 10
SIDE = 12*B
SHAPES = {"plate": (math.pi/4, 0), "square": (4.754/4, 1)}     # added mass, volume over b^2


def theory(shape):
    added, volume = SHAPES[shape]
    dipole = (added + volume)*B*B/(2*math.pi)
    return RHO*(2*math.pi*dipole/(1 - 3.438*dipole/SIDE**2) - volume*B*B)


def added_mass(shape, across, *options):
    """Over theory: in the second step, and the mean of the last five."""
    d, step = B/across, 1e-3
    half = [0.025*d if shape == "plate" else B/2, B/2]
    acceleration = 2*0.005*d/(STEPS*step)**2
    label = "_".join([shape, str(across), *(o.split("=")[1].strip('"') for o in options)])
    (case.out / f"{label}.lua").write_text(
        f"function place(t)\n    return {SIDE/2:g} + {acceleration/2:.9g}*t*t, {SIDE/2:g}, 0\nend\n")
    scene = case.write_scene(label, {
        "dimension": 2, "domain": {"min": [0, 0], "max": [SIDE, SIDE], "walls": {"x": "slip", "y": "slip"}},
        "gravity": [0, 0], "spacing": d, "end_time": STEPS*step, "time_step": step,
        "fluids": [{"name": "water", "density": RHO, "viscosity": 0, "fill": [{"box": {"min": [0, 0], "max": [SIDE, SIDE]}}]}],
        "bodies": [{"name": "body", "box": {"min": [-h for h in half], "max": half}, "friction": "slip",
                    "motion": {"script": f"{label}.lua"}}],
        "output": {"interval": step, "fields": ["velocity"], "surfaces": False}})
    out = case.run(f"{label}_out", *(word for option in options for word in ("--set", option)), scene=scene)
    table = read_table(out / "bodies.csv")
    shares = [-f/(acceleration*theory(shape)) for f in table["mean_pressure_force_x"]]
    curves.append((f"{shape}, {across} across", table["time"][1:], shares[1:], True))
    return shares[2], mean(shares[-STEPS//2:])


curves = []
for shape in SHAPES:
    for across, goal in case.pick(((8, 0.1),), ((8, 0.1), (16, 0.05))):
        second, late = added_mass(shape, across)
        case.figure(f"{shape}, {across} across: added mass over theory", late, f"1 within {goal:g}", abs(late - 1) <= goal)
        case.state(f"{shape}, {across} across: the same in the second step", second)
        # A plate of 8 spacings acts up to 2 spacings wider at each edge; one of double width has 4.
        case.hold(f"{shape}, {across} across: between 0.8 and 2 ({late:.2f})", 0.8 <= late <= 2)
        if case.smoke:
            # 1.46 and 1.08 seen.
            late = added_mass(shape, across, 'method="isph"')[1]
            case.hold(f"isph: {shape}, {across} across: between 0.9 and 1.6 ({late:.2f})", 0.9 <= late <= 1.6)
case.plot("Force over that of the added mass", "t, s", "1", curves)
case.finish()
