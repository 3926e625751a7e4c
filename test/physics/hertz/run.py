#!/usr/bin/python3
"""An elastic ball between two rigid plates."""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, fit_line, read_table

case = Case("hertz", "Hertz contact")

R, E, NU, SPEED, DEEP = 0.1, 1e6, 0.3, 0.1, 0.05
STAR = E/(1 - NU*NU)


def slope_of(points):
    """Slope of F^(2/3) against x between the two depths, over Hertz's."""
    inside = [(x, f**(2/3)) for x, f in points if 0.01*R <= x <= 0.04*R]
    return fit_line(*zip(*inside))[0]/(4/3*STAR*math.sqrt(R))**(2/3)


def tatara():
    """The slope that exact forces between plates would have."""
    points = []
    for k in range(1, 400):
        h = 0.05*R*k/400
        f, a = 4/3*STAR*math.sqrt(R)*h**1.5, math.sqrt(R*h)
        far = a*a + 4*R*R
        points.append((h - f/(math.pi*E)*(2*(1 + NU)*R*R/far**1.5 + (1 - NU*NU)/far**0.5), f))
    return slope_of(points)


def write_octant(path, n=48):
    """An eighth of a ball as OBJ: the corners of n bands of triangles, closed by fans from the centre."""
    number, lines, faces = {}, ["v 0 0 0"], []
    for i in range(n + 1):
        for j in range(i + 1):
            a, b = 0.5*math.pi*i/n, 0.5*math.pi*(j/i if i else 0)
            lines.append(f"v {R*math.sin(a)*math.cos(b)!r} {R*math.sin(a)*math.sin(b)!r} {R*math.cos(a)!r}")
            number[i, j] = len(lines)
    for i in range(n):
        for j in range(i + 1):
            faces.append((number[i, j], number[i + 1, j], number[i + 1, j + 1]))
            if j < i:
                faces.append((number[i, j], number[i + 1, j + 1], number[i, j + 1]))
        faces += [(1, number[i + 1, 0], number[i, 0]), (1, number[i, i], number[i + 1, i + 1]),
                  (1, number[n, i + 1], number[n, i])]
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n".join(lines + ["f %d %d %d" % f for f in faces]) + "\n")
    return path


def press(cells):
    d = R/cells/2
    mesh = write_octant(case.out/"octant.obj")
    out = case.solids(f"ball_{cells}", {
        "domain": {"min": [0, 0, 0], "max": [1.2*R, 1.2*R, 1.5*R]}, "spacing": d, "end_time": DEEP*R/SPEED,
        "solids": [{"name": "ball", "density": 1000, "youngs_modulus": E, "poissons_ratio": NU, "fill": [
            {"mesh": str(mesh.resolve())}]}],
        "bodies": [{"name": "plate", "box": {"min": [0, 0, R], "max": [1.1*R, 1.1*R, 1.3*R]},
                    "friction_coefficient": 0, "motion": {"translation": {"velocity": [0, 0, -SPEED]}}}],
        "output": {"interval": DEEP*R/SPEED/100, "fields": ["velocity"], "surfaces": False}})
    b = read_table(out/"bodies.csv")
    points = [(SPEED*t - 0.5*DEEP*R/100, 4*f) for t, f in zip(b["time"], b["mean_pressure_force_z"]) if f > 0]
    xs = [DEEP*R*k/100 for k in range(101)]
    case.plot(f"{cells} cells in R", "x, m", "F^(2/3)", [
        ("plate", [x for x, _ in points], [f**(2/3) for _, f in points], True),
        ("Hertz", xs, [(4/3*STAR*math.sqrt(R))**(2/3)*x for x in xs], False)])
    return slope_of(points)


exact = tatara()
case.state("slope by Tatara over Hertz's", exact)
for cells in case.pick([12], [20, 40]):
    slope = press(cells)
    case.figure(f"{cells} cells in R: slope of F^(2/3) over Hertz's", slope, "within 5 % of 1", abs(slope - 1) <= 0.05)
    case.figure(f"{cells} cells in R: slope over Tatara's", slope/exact, "within 5 % of 1", abs(slope/exact - 1) <= 0.05)
    # 12 cells, contact of 1.2 to 2.4 cells across, on a stair of half-cells: a quarter.
    case.hold("slope within 25 %", abs(slope - 1) <= 0.25)
case.finish()
