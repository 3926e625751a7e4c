#!/usr/bin/python3
"""An elastic plate that is the floor of a tank: its deflection under 2 m of water."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, mean, read_series, read_vtu

case = Case("plate_under_water", "A plate under water")

LENGTH, THICK, DEPTH, G, YOUNG, NU, WET, DRY = 1, 0.05, 2, 9.81, 3.375e9, 0.34, 1000, 2700
STIFFNESS = YOUNG*THICK**3/12/(1 - NU**2)
LOAD = G*(WET*DEPTH + DRY*THICK)
THIN = LOAD*LENGTH**4/(384*STIFFNESS)
SHEAR = LOAD*LENGTH**2/(8*5/6*YOUNG/(2*(1 + NU))*THICK)


def scene(label, through, end):
    return case.write_scene(label, {
        "method": "dfsph", "dimension": 2, "domain": {"min": [0, -0.1], "max": [LENGTH, 2.2], "walls": {"x": "no-slip"}}, "spacing": 0.05,
        "gravity": [0, -G], "end_time": end,
        "fluids": [{"name": "water", "density": WET, "viscosity": 1e-3, "fill": [{"box": {"min": [0, 0], "max": [LENGTH, DEPTH]}}]}],
        "solids": [{"name": "plate", "density": DRY, "youngs_modulus": YOUNG, "poissons_ratio": NU, "damping": 400,
                    "fill": [{"box": {"min": [0, -THICK], "max": [LENGTH, 0]}}]}],
        "mlsmpm": {"spacing": THICK/through}, "output": {"interval": 0.01, "surfaces": False, "fields": ["material"]}})


def find_middle(path):
    """Height of the plate's middle, and of the lowest water."""
    data = read_vtu(path)
    points = list(zip(data["Points"][0::3], data["Points"][1::3], data["material"]))
    return mean([y for x, y, m in points if m == 1 and abs(x - LENGTH/2) < 0.02]), min(y for x, y, m in points if m == 0)


curves = []
for through in case.pick((4,), (4, 8)):
    out = case.run(f"plate_{through}", scene=scene(f"plate_{through}", through, case.pick(0.5, 0.6)))
    times, middle = zip(*((t, find_middle(path)) for t, path in read_series(out)))
    sunk = [(middle[0][0] - y)/(THIN + SHEAR) for y, low in middle]
    found = mean(sunk[-len(sunk)//3:])
    case.figure(f"{through} particles through the plate: deflection over that with shear", found, "within 0.03", abs(found - 1) <= 0.03)
    case.hold(f"{through} through: deflection {found:.3f}, within 15 %", abs(found - 1) <= 0.15)
    case.hold(f"{through} through: no water below the plate, lowest at {middle[-1][1]:.4f} m", middle[-1][1] > 0)
    curves.append((f"{through} through the plate", times, sunk, False))
case.plot("Deflection over that with shear", "t, s", "1", curves)
case.finish()
