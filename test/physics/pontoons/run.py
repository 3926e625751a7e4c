#!/usr/bin/python3
"""Two pontoons on a hinge float on still water, and keep their momentum with it."""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, mean, read_table

METHODS = ("dfsph", "isph", "eisph", "wcsph")
case = Case("pontoons", "Two pontoons on a hinge")

G, RHO = 9.81, 1000
L, H, GAP, DEPTH, WIDTH = 0.4, 0.2, 0.03, 0.4, 1.6
ARM = L/2 + GAP


def submerge(x, y, tilt):
    """Area below y = 0 of a pontoon around (x, y), and its first moment along x."""
    c, s = math.cos(tilt), math.sin(tilt)
    corners = [(x + c*u - s*v, y + s*u + c*v) for u, v in ((-L/2, -H/2), (L/2, -H/2), (L/2, H/2), (-L/2, H/2))]
    below = []
    for p, q in zip(corners, corners[1:] + corners[:1]):
        if p[1] <= 0:
            below.append(p)
        if p[1]*q[1] < 0:
            way = p[1]/(p[1] - q[1])
            below.append((p[0] + way*(q[0] - p[0]), 0))
    area = moment = 0
    for p, q in zip(below, below[1:] + below[:1]):
        cross = p[0]*q[1] - q[0]*p[1]
        area += cross/2
        moment += cross*(p[0] + q[0])/6
    return area, moment


def balance(state, densities):
    """What is left of the lift of both, N/m, and of the moments about the hinge; and the lift of the first."""
    height, rest = state[0], [0, 0, 0]
    lifts = []
    for k, (side, density) in enumerate(zip((-1, 1), densities)):
        x, y = side*ARM*math.cos(state[1 + k]), height + side*ARM*math.sin(state[1 + k])
        area, moment = submerge(x, y, state[1 + k])
        lifts.append(G*(RHO*area - density*L*H))
        rest[0] += lifts[k]
        rest[1 + k] = G*(RHO*moment - density*L*H*x)
    return rest, lifts[0]


def solve(a, b):
    """x of a x = b, by elimination."""
    rows = [line[:] + [value] for line, value in zip(a, b)]
    for i in range(3):
        rows[i:] = sorted(rows[i:], key=lambda row: -abs(row[i]))
        for k in range(3):
            share = rows[k][i]/rows[i][i] if k != i else 0
            rows[k] = [p - share*q for p, q in zip(rows[k], rows[i])]
    return [rows[i][3]/rows[i][i] for i in range(3)]


def find_rest(densities):
    """Height of the hinge over the level, tilts of both, and the force of the hinge on the first."""
    state = [0, 0, 0]
    for _ in range(30):
        rest = balance(state, densities)[0]
        slope = [[(balance([s + 1e-6*(j == k) for k, s in enumerate(state)], densities)[0][i] - rest[i])/1e-6
                  for j in range(3)] for i in range(3)]
        state = [s - d for s, d in zip(state, solve(slope, rest))]
    return state, -balance(state, densities)[1]


def write_scene(label, method, spacing, densities, end, **more):
    (height, *tilts), force = find_rest(densities)
    bodies = []
    for k, (side, density, tilt) in enumerate(zip((-1, 1), densities, tilts)):
        place = [WIDTH/2 + side*ARM*math.cos(tilt), DEPTH + height + side*ARM*math.sin(tilt)]
        bodies.append({"name": "ab"[k], "box": {"min": [-L/2, -H/2], "max": [L/2, H/2]}, "dynamics": "free",
                       "density": density, "rotation": {"angle": math.degrees(tilt)}, "translation": place, **more})
    domain = {"min": [0, 0], "max": [WIDTH, 0.6]}
    if more:
        domain["walls"] = {"x": "periodic"}
    content = {"dimension": 2, "method": method, "domain": domain, "spacing": spacing, "end_time": end, "gravity": [0, -G],
               "fluids": [{"name": "water", "density": RHO, "viscosity": 0,
                           "fill": [{"box": {"min": [0, 0], "max": [WIDTH, DEPTH]}}]}],
               "bodies": bodies,
               "joints": [{"name": "hinge", "body": "a", "to_body": "b", "point": [WIDTH/2, DEPTH + height]}],
               "output": {"interval": 0.02, "surfaces": False, "fields": ["velocity"]}}
    return case.write_scene(label, content), tilts, force


def float_pair(method, spacing, densities):
    label = f"{method}_{densities[0]}_{1000*spacing:.0f}"
    scene, tilts, force = write_scene(label, method, spacing, densities, 2)
    folder = case.run(label, scene=scene)
    joints, bodies = read_table(folder/"joints.csv"), read_table(folder/"bodies.csv")
    late = [k for k, t in enumerate(joints["time"]) if t > 1]
    found = [mean([joints[f"hinge_force_{axis}"][k] for k in late]) for axis in "xy"]
    weight = sum(densities)*L*H*G
    name = f"{method}, {densities[0]} and {densities[1]} kg/m3, {1000*spacing:.0f} mm"
    off = (found[1] - force)/weight
    case.figure(f"{name}: vertical force, deviation over the weight", off, "within 0.003", abs(off) <= 0.003)
    off = found[0]/weight
    case.figure(f"{name}: horizontal force over the weight", off, "within 0.01", abs(off) <= 0.01)
    for body, tilt in zip("ab", tilts):
        turned = [math.degrees(2*math.atan2(z, w)) for t, n, z, w in
                  zip(bodies["time"], bodies["name"], bodies["orientation_z"], bodies["orientation_w"]) if n == body and t > 1]
        off = mean(turned)
        case.figure(f"{name}: turn of {body} from hydrostatics, degrees", off, "within 0.5", abs(off) <= 0.5)
    case.hold(f"{name}: the hinge is closed", max(joints["hinge_gap"]) < 1e-12)
    return name, joints["time"], joints["hinge_force_y"], False


def move_pair(method, spacing, densities):
    label = f"moving_{method}_{densities[0]}_{1000*spacing:.0f}"
    folder = case.run(label, scene=write_scene(label, method, spacing, densities, 0.5, velocity=[0.3, 0])[0])
    history, bodies = read_table(folder/"history.csv"), read_table(folder/"bodies.csv")
    mass, start = dict(zip("ab", (d*L*H for d in densities))), 0.3*sum(densities)*L*H
    total = history["momentum_x"][-1] + sum(mass[n]*u for n, u in list(zip(bodies["name"], bodies["velocity_x"]))[-2:])
    off = total/start - 1
    case.figure(f"{method}, {densities[0]} and {densities[1]} kg/m3, {1000*spacing:.0f} mm, moving: "
                "momentum after 0.5 s, deviation", off, "within 0.001", abs(off) <= 0.001)


curves = []
for method in case.pick(("dfsph", "isph"), METHODS):
    for spacing in case.pick((0.02,), (0.02, 0.01)):
        case_curves = [float_pair(method, spacing, densities) for densities in ((500, 500), (300, 700))]
    curves.append(case_curves[1])
for method in case.pick(("dfsph",), METHODS):
    for spacing in case.pick((0.02,), (0.02, 0.01)):
        for densities in ((500, 500), (300, 700)):
            move_pair(method, spacing, densities)
case.plot("Vertical force of the hinge on the lighter pontoon", "t, s", "N/m", curves)
case.finish()
