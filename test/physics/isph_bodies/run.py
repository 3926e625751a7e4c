#!/usr/bin/python3
"""Bodies that move by forces in water of isph and eisph: added mass, draft, very light ones, a stone on the floor, restart."""
import json
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, mean, read_table

case = Case("isph_bodies", "Floating bodies in water of isph")

G, RHO, SIDE = 9.81, 1000, 0.1
MESHES = case.folder.parents[1] / "meshes"


def body(density, **more):
    return {"name": "body", "density": density, "dynamics": "free", **more}


def run(label, size, depth, bodies, across, end, *options, method="isph"):
    dimension = len(size)
    scene = case.write_scene(label, {
        "method": method, "dimension": dimension, "domain": {"min": [0]*dimension, "max": size},
        "gravity": [0]*(dimension - 1) + [-G], "spacing": SIDE/across, "end_time": end,
        "fluids": [{"name": "water", "density": RHO, "viscosity": 1e-3,
                    "fill": [{"box": {"min": [0]*dimension, "max": size[:-1] + [depth]}}]}],
        "bodies": bodies, "output": {"interval": 0.005, "fields": ["velocity"], "surfaces": False}})
    return case.run(label, *options, scene=scene)


def let_go(shape, added, size, density, across, end, method="isph"):
    """Velocity over theory of a body that is let go in a full vessel; (shape, added mass over its volume)."""
    at = [s/2 for s in size] + [0]*(3 - len(size))
    one = body(density, mesh=str(MESHES / f"{shape}.obj"), scale=SIDE, translation=at)
    by = "" if method == "isph" else f"{method}, "
    out = run(f"{shape}_{density}_{across}_{method}", size, size[-1], [one], across, end, method=method)
    table = read_table(out / "bodies.csv")
    theory, up = (RHO - density)*G/(density + added*RHO), "velocity_" + "xyz"[len(size) - 1]
    share, name = table[up][-1]/(theory*end), f"{by}{shape}, full vessel, density ratio {density/RHO}, {across} across"
    case.figure(f"{name}: velocity over theory", share, "1 within 0.05", abs(share - 1) <= 0.05)
    case.hold(f"{name}: within 15 % of theory", abs(share - 1) <= 0.15)
    return f"{name}", table["time"], [v/theory for v in table[up]], False


curves = [let_go("cylinder", 1, [0.8, 0.8], density, across, end)
          for density, end in ((500, 0.1), (2000, 0.1), (50, 0.04)) for across in case.pick((8,), (10, 20))]
curves += [let_go("cylinder", 1, [0.8, 0.8], density, across, 0.1, "eisph")
           for density in (500, 2000) for across in case.pick((8,), (10,))]
curves += [let_go("sphere", 0.5, [0.4]*3, density, 10, 0.1) for density in case.pick((), (500, 2000))]
case.plot("Let go in a full vessel", "t, s", "velocity over acceleration in theory, s", curves)

hold = case.out / "hold.lua"
hold.write_text("function control(t, body)\n    if t < 0.199 then return { hold = 'shift,turn' } end\n    return {}\nend\n")
for density in case.pick((500,), (500, 2000, 50)):
    for across in case.pick((8,), (10, 20)):
        held = body(density, mesh=str(MESHES / "cylinder.obj"), scale=SIDE, translation=[0.4, 0.3, 0],
                    **{"dynamics": "controlled", "control": {"script": str(hold)}})
        table = read_table(run(f"under_surface_{density}_{across}", [0.8, 0.8], 0.6, [held], across, 0.25) / "bodies.csv")
        at, theory = {round(t, 3): v for t, v in zip(table["time"], table["velocity_y"])}, (RHO - density)*G/(RHO + density)
        share, name = (at[0.23] - at[0.21])/0.02/theory, f"under a surface, density ratio {density/RHO}, {across} across"
        case.figure(f"{name}: acceleration over theory", share, "1 within 0.1", abs(share - 1) <= 0.1)
        case.hold(f"{name}: acceleration within 20 % of theory", abs(share - 1) <= 0.2)
        force = mean([f for t, f in zip(table["time"], table["mean_pressure_force_y"]) if 0.1 < t < 0.2])/(RHO*G*3.1416/4*SIDE**2)
        case.figure(f"{name}: buoyancy while it is held, over rho g V", force, "1 within 0.02", abs(force - 1) <= 0.02)
        case.hold(f"{name}: buoyancy within 5 %", abs(force - 1) <= 0.05)

curves = []
for density in 500, 50:
    for across in case.pick((8,), (8, 16)):
        start, end = 0.3 + SIDE/2 - (0.6 if density == 500 else 0.2)*SIDE, case.pick(1 if density == 500 else 0.4, 4)
        box = {"box": {"min": [0.25, start - SIDE/2], "max": [0.35, start + SIDE/2]}}
        out = run(f"square_{density}_{across}", [0.6, 0.6], 0.3, [body(density, locked="turn", **box)], across, end)
        table = read_table(out / "bodies.csv")
        water = json.loads((out / "summary.json").read_text())["fluid_particles"]*(SIDE/across)**2
        draft = [(water/0.6 - y + SIDE/2)/(1 - SIDE/0.6)/SIDE for y in table["position_y"]]
        late, name = draft[-len(draft)//5:], f"square, density ratio {density/RHO}, {across} across"
        off = mean(late) - density/RHO
        case.figure(f"{name}: draft over height", mean(late), f"{density/RHO} within 0.02", abs(off) <= 0.02)
        case.hold(f"{name}: draft {mean(late):.3f}, within a spacing and not out of the water",
                  -0.5/across < mean(late) and abs(off) <= 1/across)
        fastest = max(abs(v) for v in table["velocity_y"])
        case.hold(f"{name}: never faster than a fall of three heights ({fastest:.2f} m/s)", fastest <= (6*G*SIDE)**0.5)
        case.state(f"{name}: draft moves by, over height", max(late) - min(late))
        curves.append((f"ratio {density/RHO}, {across} across", table["time"], draft, False))
case.plot("Square at the surface", "t, s", "draft over height", curves)

across = 8
box = {"box": {"min": [0.25, 0.1], "max": [0.35, 0.2]}}
table = read_table(run("stone", [0.6, 0.5], 0.3, [body(2500, **box)], across, 1) / "bodies.csv")
deep = (SIDE/2 - min(table["position_y"][-20:]))*across/SIDE
case.figure("stone on the floor: how far it goes into the floor, spacings", deep, "<= 0.05", deep <= 0.05)
case.hold(f"a stone stays on the floor: {deep:.3f} spacings deep", abs(deep) <= 0.2)

pair = [body(density, box={"min": [x, 0.26], "max": [x + 0.1, 0.36]}) | {"name": f"b{density}"}
        for x, density in ((0.1, 500), (0.25, 50))]


def state_hash(out):
    return json.loads((out / "summary.json").read_text())["state_hash"]


hashes = [state_hash(run(f"bits_{n}", [0.5, 0.5], 0.25, pair, 10, 0.1, "--threads", n)) for n in (1, 2, 4)]
case.hold("the same bits with one, two and four threads", len(set(hashes)) == 1)
out = run("bits_resumed", [0.5, 0.5], 0.25, pair, 10, 0.1, "--until", 0.05)
subprocess.run([case.program, "resume", str(out), "--until", "0.1", "--quiet"], check=True, timeout=100)
case.hold("the same bits after a restart", hashes[0] == state_hash(out))
case.finish()
