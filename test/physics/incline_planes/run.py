#!/usr/bin/python3
"""A block, a box and a ball on a plane of the scene that leans."""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, fit_line, mean, read_series, read_table, read_vtu

case = Case("incline_planes", "Solids and bodies on a plane that leans")

G, ANGLE, END = 9.81, math.radians(30), 0.6
DOWN, OUT = (-math.cos(ANGLE), -math.sin(ANGLE)), (-math.sin(ANGLE), math.cos(ANGLE))
LENGTH, HEIGHT, FOOT = 0.4, 0.2, (2, 1.4)      # m; a point of the plane, under the middle of the block


def above(height, along=0):
    return [FOOT[a] + height*OUT[a] + along*DOWN[a] for a in (0, 1)]


def plane(dim, **more):
    return [{"point": [*FOOT, 0.5][:dim], "normal": [*(3*c for c in OUT), 0][:dim], **more}]


def write_box(sides):
    """The mesh of a box around the origin."""
    corners = [[sides[a]/2*(1 if k >> (2 - a) & 1 else -1) for a in range(3)] for k in range(8)]
    faces = [(1, 2, 4, 3), (5, 7, 8, 6), (1, 5, 6, 2), (3, 4, 8, 7), (1, 3, 7, 5), (2, 6, 8, 4)]
    path = pathlib.Path(case.out)/"block.obj"
    path.write_text("".join("v %g %g %g\n" % tuple(c) for c in corners) +
                    "".join("f %d %d %d %d\n" % f for f in faces))
    return str(path.resolve())


def slide(dim, d, friction):
    """Acceleration of the block over g (sin - mu cos), and how far it left its height, in spacings."""
    out = case.solids(f"block_{dim}d_{d:g}_mu{friction:g}", {
        "dimension": dim, "domain": {"min": [0, 0, 0][:dim], "max": [3, 3, 1][:dim]}, "spacing": d, "end_time": END,
        "gravity": [0, -G, 0][:dim], "planes": plane(dim, friction=friction),
        "solids": [{"name": "block", "density": 1000, "youngs_modulus": 1e6, "fill": [
            {"mesh": write_box((LENGTH, HEIGHT, 0.2 if dim == 3 else 2)), "rotation": {"axis": [0, 0, 1], "angle": 30},
             "translation": [*above(HEIGHT/2), 0.5 if dim == 3 else 0]}]}],
        "output": {"interval": END/30, "surfaces": False}})
    times, ways, heights = [], [], []
    for t, path in read_series(out):
        x = read_vtu(path)["Points"]
        middle = [mean(x[a::3]) - FOOT[a] for a in (0, 1)]
        times.append(t)
        ways.append(sum(m*c for m, c in zip(middle, DOWN)))
        heights.append(sum(m*c for m, c in zip(middle, OUT)))
    exact = G*(math.sin(ANGLE) - friction*math.cos(ANGLE))
    case.plot(f"Block, {dim}-D, spacing {d:g} m, friction {friction:g}", "t, s", "way, m", [
        ("centre of mass", times, [w - ways[0] for w in ways], True), ("exact", times, [0.5*exact*t*t for t in times], False)])
    return 2*fit_line([t*t for t in times], ways)[0]/exact, max(abs(h - heights[0]) for h in heights)/d


for dim, d, friction in case.pick([(2, 0.025, 0.2), (2, 0.025, 0)], [
        (2, 0.025, 0.2), (2, 0.025, 0), (2, 0.0125, 0.2), (2, 0.0125, 0), (3, 0.025, 0.2), (3, 0.025, 0)]):
    found, rose = slide(dim, d, friction)
    text = f"block, {dim}-D, spacing {d:g} m, friction {friction:g}"
    case.figure(f"{text}: acceleration over the exact one", found, "within 2 % of 1", abs(found - 1) <= 0.02)
    case.hold(f"{text}: within 2 %", abs(found - 1) <= 0.02)
    # its own weight compresses it by 1.6e-4 of its height; the rest is where the nodes lie
    case.hold(f"{text}: stays at its height to half a spacing", rose <= 0.5)

body = {"dynamics": "free", "rotation": {"axis": [0, 0, 1], "angle": 30}}
box = {"min": [-0.1, -0.05, -0.05], "max": [0.1, 0.05, 0.05]}
exact = {"ball": 5/7*G*math.sin(ANGLE), "sliding": G*(math.sin(ANGLE) - 0.2*math.cos(ANGLE)), "sticking": 0}
ways = {}
for friction, names in ((0.2, ("sliding",)), (0.8, ("sticking", "ball"))):
    bodies = [{"name": name, **body, "friction_coefficient": friction,
               **({"mesh": str((pathlib.Path(__file__).parents[2]/"meshes/sphere.obj").resolve()), "scale": 0.1}
                  if name == "ball" else {"box": box}),
               "translation": [*above(0.05), 0.3 + 0.4*k]} for k, name in enumerate(names)]
    table = read_table(case.solids(f"bodies_mu{friction:g}", {
        "domain": {"min": [0, 0, 0], "max": [3, 3, 1]}, "spacing": 0.1, "end_time": END, "gravity": [0, -G, 0],
        "time_step": case.pick(1e-3, 1e-4), "planes": plane(3, friction=friction), "bodies": bodies,
        "output": {"interval": END/30, "surfaces": False}})/"bodies.csv")
    for name in names:
        rows = [k for k, n in enumerate(table["name"]) if n == name]
        x, y = (table[f"position_{a}"] for a in "xy")
        ways[name] = (x[rows[-1]] - x[rows[0]])*DOWN[0] + (y[rows[-1]] - y[rows[0]])*DOWN[1]
        case.state(f"{name}: height of the middle above the plane at the end, m",
                   (x[rows[-1]] - FOOT[0])*OUT[0] + (y[rows[-1]] - FOOT[1])*OUT[1])
for name in ("ball", "sliding"):
    error = ways[name]/(0.5*exact[name]*END**2) - 1
    case.figure(f"{name}: way after {END:g} s over the formula, minus 1", error, "within 0.02", abs(error) <= 0.02)
    case.hold(f"{name}: within 1 %", abs(error) <= 0.01)
case.figure("sticking: way of the box that must stay, m", ways["sticking"], "below 1e-6", abs(ways["sticking"]) <= 1e-6)
case.hold("it stays", abs(ways["sticking"]) <= 1e-6)
case.finish()
