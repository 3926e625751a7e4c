#!/usr/bin/python3
"""Bodies in water under oil, by isph and eisph: buoyancy, added mass, drafts, balance of forces."""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, mean, read_series, read_table, read_vtu

case = Case("bodies_in_layers", "Bodies in water under oil")

G, RHO, SIDE = 9.81, 1000, 0.1
MESH = str(case.folder.parents[1] / "meshes" / "cylinder.obj")
AREA = 24*math.sin(math.pi/24)*(SIDE/2)**2                     # of 48 corners


def run(label, size, level, light, body, across, end, interval, method="isph", fields=("velocity",), top=None):
    n, top = len(size), top or size[-1]
    fluids = [{"name": name, "density": density, "viscosity": 1e-3,
               "fill": [{"box": {"min": [0]*(n - 1) + [low], "max": size[:-1] + [high]}}]}
              for name, density, low, high in (("water", RHO, 0, level), ("oil", light, level, top))]
    return case.run(label, scene=case.write_scene(label, {
        "method": method, "dimension": n, "domain": {"min": [0]*n, "max": size}, "gravity": [0]*(n - 1) + [-G],
        "spacing": SIDE/across, "end_time": end, "fluids": fluids, "bodies": [{"name": "body", **body}],
        "output": {"interval": interval, "fields": list(fields), "surfaces": False}}))


def cylinder(size):
    return {"mesh": MESH, "scale": SIDE, "translation": [size/2, size/2, 0]}


def at_rest(light, shape, across, method="isph"):
    body = {"box": {"min": [0.15, 0.15], "max": [0.25, 0.25]}} if shape == "square" else cylinder(0.4)
    out = run(f"rest_{light}_{shape}_{across}_{method}", [0.4, 0.4], 0.2, light, body, across, 0.5, 0.05, method)
    volume = SIDE**2 if shape == "square" else AREA
    force = read_table(out/"bodies.csv")["mean_pressure_force_y"][-1]/(G*volume*(RHO + light)/2)
    name = f"{method}, {shape} in 1000 on {light} kg/m3, {across} across"
    goal = (0.001 if shape == "square" else 0.005) if method == "isph" else 0.02
    case.figure(f"{name}: force over buoyancy", force, f"1 within {goal}", abs(force - 1) <= goal)
    case.hold(f"{name}: within 5 % of buoyancy", abs(force - 1) <= 0.05)
    if method != "isph":                                       # pressures of single steps have sound
        return
    history = read_table(out/"history.csv")
    weight = history["weight"][-1]
    carried = -(history["wall_force_y"][-1] + read_table(out/"bodies.csv")["pressure_force_y"][-1])/weight
    case.figure(f"{name}: what walls and body carry of the weight", carried, "1 within 0.005", abs(carried - 1) <= 0.005)


def let_go(light, density, across, method="isph"):
    end = 0.04
    out = run(f"go_{light}_{density}_{across}_{method}", [0.8, 0.8], 0.4, light,
              {**cylinder(0.8), "dynamics": "free", "density": density}, across, end, 0.005, method)
    table, m = read_table(out/"bodies.csv"), (RHO + light)/2
    theory = G*(m - density)/(m + density)
    share = table["velocity_y"][-1]/(theory*end)
    name = f"{method}, cylinder of {density} kg/m3 in 1000 on {light} kg/m3, {across} across"
    case.figure(f"{name}: velocity over theory", share, "1 within 0.1", abs(share - 1) <= 0.1)
    case.hold(f"{name}: velocity within 20 % of theory", abs(share - 1) <= 0.2)
    return name, table["time"], [v/theory for v in table["velocity_y"]], False


def driven(light, across):
    amplitude, period, interval, end = 0.002, 0.1, 0.0025, 0.4
    w = 2*math.pi/period
    motion = {"oscillation": {"direction": [0, 1, 0], "amplitude": amplitude, "frequency": 1/period}}
    out = run(f"driven_{light}_{across}", [0.8, 0.8], 0.4, light, {**cylinder(0.8), "motion": motion}, across, end, interval)
    table = read_table(out/"bodies.csv")
    late = [(t - interval/2, f) for t, f in zip(table["time"], table["mean_pressure_force_y"]) if t > end - 2*period + 1e-9]
    found = 2*mean([f*math.sin(w*t) for t, f in late])
    share = found/(((RHO + light)/2*AREA*w*w - (RHO - light)*G*SIDE)*amplitude)
    name = f"driven cylinder in 1000 on {light} kg/m3, {across} across"
    case.figure(f"{name}: force over theory", share, "1 within 0.1", abs(share - 1) <= 0.1)
    case.hold(f"{name}: force within 20 % of theory", abs(share - 1) <= 0.2)


def buoy(light, density, across, end, dimension=2, method="isph"):
    size = [0.6, 0.6] if dimension == 2 else [0.2, 0.2, 0.4]
    top = size[-1] - 0.1
    level, ground = top/2, math.prod(size[:-1])
    right = (density - light)/(RHO - light)
    low = [s/2 - SIDE/2 for s in size[:-1]] + [level - (right + 0.2)*SIDE]
    body = {"box": {"min": low, "max": [x + SIDE for x in low]}, "dynamics": "free", "density": density, "locked": "turn"}
    out = run(f"buoy_{dimension}d_{light}_{density}_{across}_{method}", size, level, light, body, across, end, 0.05, method,
              ("velocity", "material"), top)
    table, up = read_table(out/"bodies.csv"), "position_" + "xyz"[dimension - 1]
    water = read_vtu(read_series(out)[-1][1])["material"].count(0)*(SIDE/across)**dimension
    share = SIDE**(dimension - 1)/ground                       # of the ground, that the body covers
    draft = [(water/ground - y + SIDE/2)/(1 - share)/SIDE for y in table[up]]
    found = mean(draft[-2*len(draft)//5:])
    name = f"{method}, buoy of {density} kg/m3 in 1000 on {light} kg/m3, {dimension}-D, {across} across"
    case.figure(f"{name}: draft over height", found, f"{right:.3f} within 0.03", abs(found - right) <= 0.03)
    case.hold(f"{name}: draft {found:.3f}, within a spacing", abs(found - right) <= 1/across)
    return f"{density} kg/m3 in 1000 on {light}, {dimension}-D, {across} across", table["time"], draft, False


across = case.pick(8, 10)
for light in 800, 1:
    for shape in "square", "cylinder":
        at_rest(light, shape, across)
at_rest(800, "square", across, "eisph")
curves = [let_go(light, density, n) for light, density in case.pick(((800, 600),), ((800, 600), (800, 1800), (100, 1100), (1, 250)))
          for n in case.pick((8,), (10, 20))]
curves += [let_go(800, 600, across, "eisph")]
case.plot("Let go in the interface", "t, s", "velocity over acceleration in theory, s", curves)
for light in case.pick((800,), (800, 100, 1)):
    driven(light, across)
curves = [buoy(light, density, n, case.pick(3, 4)) for light, density in case.pick(((500, 750),), ((800, 900), (500, 750), (1, 500)))
          for n in case.pick((8,), (8, 16))]
if not case.smoke:
    curves += [buoy(800, 900, 8, 4, 3), buoy(500, 750, 8, 4, method="eisph")]
case.plot("Buoys between two liquids", "t, s", "draft over height", curves)
case.finish()
