#!/usr/bin/python3
"""Bodies that move by forces in water of wcsph: added mass, draft, light ones, collision, control, momentum, restart."""
import json
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, mean, read_table

case = Case("wcsph_bodies", "Floating bodies in weakly compressible water")

G, RHO, SIDE = 9.81, 1000, 0.1
MESHES = case.folder.parents[1] / "meshes"


def body(density, **more):
    return {"name": "body", "density": density, "dynamics": "free", **more}


def cylinder(density, at, **more):
    return body(density, mesh=str(MESHES / "cylinder.obj"), scale=SIDE, translation=at, **more)


def run(label, size, depth, bodies, across, end, *options, **more):
    dimension = len(size)
    scene = case.write_scene(label, {
        "method": "wcsph", "dimension": dimension, "domain": {"min": [0]*dimension, "max": size},
        "gravity": [0]*(dimension - 1) + [-G], "spacing": SIDE/across, "end_time": end,
        "fluids": [{"name": "water", "density": RHO, "viscosity": 1e-3, "fill": [{"box": {"min": [0]*dimension, "max": size[:-1] + [depth]}}]}],
        "bodies": bodies, "output": {"interval": 0.005, "fields": ["velocity"], "surfaces": False}, **more})
    return case.run(label, *options, scene=scene)


def tables(out):
    return read_table(out / "bodies.csv"), read_table(out / "history.csv")


# --- let go in a full vessel ----------------------------------------------------------------------
curves = []
for density, end in (500, 0.1), (2000, 0.1), (50, 0.04):
    for across in case.pick((8,), (10, 20)):
        table, history = tables(run(f"cylinder_{density}_{across}", [0.8, 0.8], 0.8, [cylinder(density, [0.4, 0.4, 0])], across, end))
        theory = (RHO - density)*G/(RHO + density)
        share, name = table["velocity_y"][-1]/(theory*end), f"cylinder, full vessel, density ratio {density/RHO}, {across} across"
        case.figure(f"{name}: velocity over theory", share, "1 within 0.05", abs(share - 1) <= 0.05)
        # Drag takes some per cent by then, as with dfsph.
        case.hold(f"{name}: within 15 % of theory", abs(share - 1) <= 0.15)
        aside = max(abs(v) for v in table["velocity_x"])/abs(table["velocity_y"][-1])
        case.hold(f"{name}: goes straight up or down, {aside:.2g} aside", aside <= 0.05)
        case.state(f"{name}: mean step times speed of sound over spacing", end/history["step"][-1]*(7*50000/RHO)**0.5/(SIDE/across))
        curves.append((f"ratio {density/RHO}, {across} across", table["time"], [v/theory for v in table["velocity_y"]], False))
if not case.smoke:
    for density, across in (500, 10), (2000, 10):
        ball = body(density, mesh=str(MESHES / "sphere.obj"), scale=SIDE, translation=[0.2]*3)
        table, _ = tables(run(f"sphere_{density}_{across}", [0.4]*3, 0.4, [ball], across, 0.1))
        share = table["velocity_z"][-1]/((RHO - density)*G/(density + RHO/2)*0.1)
        case.figure(f"sphere, full vessel, density ratio {density/RHO}, {across} across: velocity over theory", share,
                    "1 within 0.05", abs(share - 1) <= 0.05)
case.plot("Cylinder in a full vessel", "t, s", "velocity over acceleration in theory, s", curves)

# --- let go under a free surface ------------------------------------------------------------------
hold = case.out / "hold.lua"
hold.write_text("function control(t, body)\n    if t < 0.199 then return { hold = 'shift,turn' } end\n    return {}\nend\n")
for density in case.pick((500,), (500, 2000, 50)):
    for across in case.pick((8,), (10, 20)):
        held = cylinder(density, [0.4, 0.3, 0], dynamics="controlled", control={"script": str(hold)})
        table, _ = tables(run(f"under_surface_{density}_{across}", [0.8, 0.8], 0.6, [held], across, 0.25))
        at, theory = {round(t, 3): v for t, v in zip(table["time"], table["velocity_y"])}, (RHO - density)*G/(RHO + density)
        share, name = (at[0.23] - at[0.21])/0.02/theory, f"under a surface, density ratio {density/RHO}, {across} across"
        case.figure(f"{name}: acceleration over theory", share, "1 within 0.1", abs(share - 1) <= 0.1)
        # The water is a lattice that yields late, as with dfsph.
        case.hold(f"{name}: acceleration within 20 % of theory", abs(share - 1) <= 0.2)
        force = mean([f for t, f in zip(table["time"], table["mean_pressure_force_y"]) if 0.1 < t < 0.2])/(RHO*G*3.1416/4*SIDE**2)
        case.figure(f"{name}: buoyancy while it is held, over rho g V", force, "1 within 0.02", abs(force - 1) <= 0.02)
        case.hold(f"{name}: buoyancy within 5 %", abs(force - 1) <= 0.05)

# --- squares at the surface -----------------------------------------------------------------------
curves = []
for density in 500, 50:
    for across in case.pick((8,), (8, 16)):
        start, end = 0.3 + SIDE/2 - (0.6 if density == 500 else 0.2)*SIDE, case.pick(1 if density == 500 else 0.4, 4)
        box = {"box": {"min": [0.25, start - SIDE/2], "max": [0.35, start + SIDE/2]}}
        out = run(f"square_{density}_{across}", [0.6, 0.6], 0.3, [body(density, locked="turn", **box)], across, end)
        table, history = tables(out)
        water = json.loads((out / "summary.json").read_text())["fluid_particles"]*(SIDE/across)**2
        draft = [(water/0.6 - y + SIDE/2)/(1 - SIDE/0.6)/SIDE for y in table["position_y"]]
        late, name = draft[-len(draft)//5:], f"square, density ratio {density/RHO}, {across} across"
        off = mean(late) - density/RHO
        case.figure(f"{name}: draft over height", mean(late), f"{density/RHO} within 0.02", abs(off) <= 0.02)
        # The surface is known to half a spacing, a light body rides on it by up to one.
        case.hold(f"{name}: draft {mean(late):.3f}, within a spacing and not out of the water",
                  -0.5/across < mean(late) and abs(off) <= 1/across)
        case.hold(f"{name}: comes to rest, draft within {max(late) - min(late):.3f}", max(late) - min(late) <= 0.1)
        fastest = max(abs(v) for v in table["velocity_y"])
        case.hold(f"{name}: never faster than a fall of three heights ({fastest:.2f} m/s)", fastest <= (6*G*SIDE)**0.5)
        curves.append((f"ratio {density/RHO}, {across} across", table["time"], draft, False))
case.plot("Square at the surface", "t, s", "draft over height", curves)

# --- two cylinders that meet ----------------------------------------------------------------------
pair = [cylinder(4000, [x, 0.2, 0], velocity=[v, 0, 0], restitution=1) | {"name": f"at_{x}"} for x, v in ((0.15, 1), (0.35, -1))]
out = run("collision", [0.5, 0.4], 0.4, pair, 10, 0.12, gravity=[0, 0])
rows = list(zip(*[read_table(out / "bodies.csv")[k] for k in ("time", "position_x", "velocity_x", "contact_force_x", "mean_contact_force_x")]))
left, right = rows[0::2], rows[1::2]
gap = min(b[1] - a[1] for a, b in zip(left, right))/SIDE
case.figure("collision: least distance of the centres over the diameter", gap, ">= 0.99", gap >= 0.99)
case.hold("collision: the cylinders do not overlap by more than 1 %", gap >= 0.99)
push = sum(a[4] for a in left)*0.005, sum(b[4] for b in right)*0.005
case.hold(f"collision: contact pushed them apart, {push[0]:.3g} and {push[1]:.3g} N s per metre",
          push[0] < -0.1 and abs(sum(push)) <= 1e-6*abs(push[0]))
case.hold("collision: they part again", left[-1][2] < 0 < right[-1][2])

# --- a body that is told what the water does to it ------------------------------------------------
cancel = case.out / "cancel.lua"
cancel.write_text(f"function control(t, body)\n    local f = body.contact_force\n"
                  f"    return {{ force = {{ -f[1], {G}*body.mass - f[2], 0 }}, hold = 'turn' }}\nend\n")
ways = {}
for name, density, more in ("controlled", 500, {"dynamics": "controlled", "control": {"script": str(cancel)}}), ("free", 500, {}):
    table, _ = tables(run(name, [0.4, 0.4], 0.4, [cylinder(density, [0.2, 0.2, 0], **more)], 10, 0.1))
    ways[name] = abs(table["position_y"][-1] - 0.2)
case.figure("control: way of the body that cancels the forces it is told, over that of a free one", ways["controlled"]/ways["free"],
            "<= 0.05", ways["controlled"] <= 0.05*ways["free"])
# The force is told a step late, and answered another step later: some 3 g dt t, a twentieth of the free way.
case.hold("control: it moves at most a tenth as far", ways["controlled"] <= 0.1*ways["free"])

# --- momentum ------------------------------------------------------------------------------------
for density in 300, 30:
    box = {"box": {"min": [0.07]*3, "max": [0.12]*3}, "velocity": [0.3, 0.1, 0], "angular_velocity": [0, 0, 3], "friction": "no-slip"}
    out = run(f"shot_{density}", [0.2]*3, 0.15, [body(density, **box)], 8, 0.02, gravity=[0, 0, 0],
              domain={"min": [0]*3, "max": [0.2]*3, "walls": dict.fromkeys("xyz", "periodic")})
    table, history = tables(out)
    mass = density*0.05**3
    total = [[m + mass*v for m, v in zip(history[f"momentum_{a}"], table[f"velocity_{a}"])] for a in "xyz"]
    change = max(abs(m - series[0]) for series in total for m in series)
    lost = change/(0.005*sum(history["force_sum"]))
    case.figure(f"shot, density ratio {density/RHO}: change of the momentum of body and water over the sum of abs(F) dt",
                lost, "<= 1e-6", lost <= 1e-6)
    case.state(f"shot, density ratio {density/RHO}: the same over the momentum of the shot", change/(mass*0.3))
    case.hold(f"shot, density ratio {density/RHO}: momentum is kept to rounding of single precision", lost <= 1e-6)
    given = 1 - table["velocity_x"][-1]/0.3
    case.hold(f"shot, density ratio {density/RHO}: the water took its part, {given:.2f} of the body's momentum", given > 0.3)

# --- the same bits -------------------------------------------------------------------------------
box = [body(density, box={"min": [x, 0.26], "max": [x + 0.1, 0.36]}) | {"name": f"b{density}"}
       for x, density in ((0.1, 500), (0.25, 50))]


def state_hash(out):
    return json.loads((out / "summary.json").read_text())["state_hash"]


hashes = [state_hash(run(f"bits_{n}", [0.5, 0.5], 0.25, box, 10, 0.1, "--threads", n)) for n in (1, 2, 4)]
case.hold("the same bits with one, two and four threads", len(set(hashes)) == 1)
out = run("bits_resumed", [0.5, 0.5], 0.25, box, 10, 0.1, "--until", 0.05)
subprocess.run([case.program, "resume", str(out), "--until", "0.1", "--quiet"], check=True, timeout=100)
case.hold("the same bits after a restart", hashes[0] == state_hash(out))
case.finish()
