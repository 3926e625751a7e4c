#!/usr/bin/python3
"""Bodies that move by forces in water of dfsph: added mass, draft, a very light one, momentum, restart."""
import json
import math
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, mean, read_table

case = Case("floating", "Floating bodies")

G, RHO, SIDE = 9.81, 1000, 0.1


def body(density, **more):
    return {"name": "body", "density": density, "dynamics": "free", **more}


def write(label, size, depth, bodies, spacing, end, walls=None, **more):
    return case.write_scene(label, {
        "domain": {"min": [0, 0, 0], "max": size, **({"walls": walls} if walls else {})}, "gravity": [0, 0, -G], "spacing": spacing, "end_time": end,
        "fluids": [{"name": "water", "density": RHO, "viscosity": 1e-3, "fill": [{"box": {"min": [0, 0, 0], "max": size[:2] + [depth]}}]}],
        "bodies": bodies, "output": {"interval": 0.005, "fields": ["velocity"], "surfaces": False}, **more})


def free_fall(density):
    return (RHO - density)*G/(density + RHO/2)


# --- a sphere in a full vessel, and one with a free surface above it ------------------------------
mesh = {"mesh": str(case.folder.parents[1] / "meshes" / "sphere.obj"), "scale": SIDE}
curves = []
for density, end in (500, 0.1), (2000, 0.1), (50, 0.04):
    for across in case.pick((10,), (6, 10)):
        label = f"sphere_{density}_{across}"
        scene = write(label, [0.4]*3, 0.4, [body(density, translation=[0.2]*3, **mesh)], SIDE/across, end)
        table = read_table(case.run(label, scene=scene) / "bodies.csv")
        share = table["velocity_z"][-1]/(free_fall(density)*end)
        case.figure(f"full vessel, density ratio {density/RHO}, {across} across: velocity over theory", share,
                    "1 within 0.05", abs(share - 1) <= 0.05)
        # Six across miss this: drag takes a tenth by then.
        case.hold(f"full vessel, density ratio {density/RHO}: within 10 % of theory", abs(share - 1) <= 0.1)
        side = max(abs(table[f"velocity_{a}"][-1]) for a in "xy")/abs(table["velocity_z"][-1])
        # Six spacings across: nothing but the lattice points aside.
        case.hold(f"full vessel, density ratio {density/RHO}: goes straight up or down, {side:.2g} aside", side <= 0.05)
        curves.append((f"ratio {density/RHO}, {across} across", table["time"],
                       [v/free_fall(density) for v in table["velocity_z"]], False))
# --- a cylinder in a full vessel, 2-D, of eight diameters: Ca = 1, by the concentric formula 1.03 -------------
for density in 500, 2000:
    for across in case.pick((10,), (10, 20, 40)):
        label = f"cylinder_{density}_{across}"
        scene = case.write_scene(label, {
            "dimension": 2, "domain": {"min": [0, 0], "max": [0.8, 0.8]}, "gravity": [0, -G], "spacing": SIDE/across, "end_time": 0.1,
            "fluids": [{"name": "water", "density": RHO, "viscosity": 1e-3, "fill": [{"box": {"min": [0, 0], "max": [0.8, 0.8]}}]}],
            "bodies": [body(density, mesh=str(case.folder.parents[1] / "meshes" / "cylinder.obj"), scale=SIDE, translation=[0.4, 0.4, 0])],
            "output": {"interval": 0.005, "fields": ["velocity"], "surfaces": False}})
        table = read_table(case.run(label, scene=scene) / "bodies.csv")
        share = table["velocity_y"][-1]/((RHO - density)*G/(density + RHO)*0.1)
        case.figure(f"cylinder, full vessel, 2-D, density ratio {density/RHO}, {across} across: velocity over theory", share,
                    "1 within 0.05", abs(share - 1) <= 0.05)
        case.hold(f"cylinder, density ratio {density/RHO}: within 10 % of theory", abs(share - 1) <= 0.1)
case.plot("Sphere in a full vessel", "t, s", "velocity over acceleration in theory, s", curves)
for density in case.pick((500,), (500, 2000)):
    for across in case.pick((6,), (8, 12)):
        out = case.run(f"under_surface_{density}_{across}", "--spacing", SIDE/across, "--until", 0.45,
                       "--set", f"bodies[0].density={density}")
        table = read_table(out / "bodies.csv")
        at = {round(t, 3): v for t, v in zip(table["time"], table["velocity_z"])}
        share = (at[0.415] - at[0.405])/0.01/free_fall(density)
        case.figure(f"under a surface, density ratio {density/RHO}, {across} across: acceleration over theory", share,
                    "1 within 0.1", abs(share - 1) <= 0.1)
        # Water at rest under pressure is a lattice that yields late: six spacings across, 0.85 was seen.
        case.hold(f"under a surface, density ratio {density/RHO}: within 20 %", abs(share - 1) <= 0.2)

# Why it is too slow: the same sphere moved by a motion. Drag in theory 0.08 N (coefficient 0.5).
for depth in 0.3, 0.4:
    moved = {"name": "body", "translation": [0.15, 0.15, 0.09], "motion": {"translation": {"velocity": [0, 0, 0.2]}}, **mesh}
    out = case.run(f"moved_{depth}", scene=write(f"moved_{depth}", [0.3, 0.3, 0.4], depth, [moved], SIDE/6, 0.3))
    table = read_table(out / "bodies.csv")
    drag = RHO*G*math.pi/6*SIDE**3 - mean([f for t, f in zip(table["time"], table["mean_pressure_force_z"]) if t > 0.1])
    case.state(f"sphere moved up at 0.2 m/s, 6 across, {'free surface' if depth < 0.4 else 'full vessel'}: drag, N", drag)
    # 2.6 N where the hydrostatic pressure is solved for; 6 spacings across, the fluid's disorder is half a newton still.
    case.hold(f"sphere moved up, depth {depth}: drag {drag:.2f} N", drag <= 0.9)

# --- cubes at the surface ------------------------------------------------------------------------
curves = []
for density in 500, 50:
    for across in case.pick((6,), (6, 8, 12)):
        d, size, end = SIDE/across, 0.3, case.pick(1.5, 4)
        start = 0.2 + SIDE/2 - 0.6*SIDE
        box = {"box": {"min": [0.1, 0.1, start - SIDE/2], "max": [0.2, 0.2, start + SIDE/2]}}
        label = f"cube_{density}_{across}"
        gauges = [{"name": f"corner{k}", "kind": "level", "position": [0.05 + 0.2*(k % 2), 0.05 + 0.2*(k//2), 0.1]} for k in range(4)]
        out = case.run(label, scene=write(label, [size, size, 0.4], 0.2, [body(density, locked="turn", **box)], d, end, probes=gauges))
        table, history = read_table(out / "bodies.csv"), read_table(out / "history.csv")
        water = json.loads((out / "summary.json").read_text())["fluid_particles"]*d**3
        # draft = level - bottom, level = (water + draft side^2)/size^2
        draft = [(water/size**2 - z + SIDE/2)/(1 - SIDE**2/size**2)/SIDE for z in table["position_z"]]
        late = draft[-len(draft)//5:]
        curves.append((f"ratio {density/RHO}, {across} across", table["time"], draft, False))
        off = mean(late) - density/RHO
        case.figure(f"cube, density ratio {density/RHO}, {across} across: draft over height", mean(late),
                    f"{density/RHO} within 0.01", abs(off) <= 0.01)
        mass = density*SIDE**3
        gauges = read_table(out / "probes.csv")
        level = mean([mean(gauges[f"corner{k}_level"][-len(gauges["time"])//5:]) for k in range(4)])
        case.state(f"cube, density ratio {density/RHO}, {across} across: draft below the level that gauges in the corners read, over height",
                   (level - mean(table["position_z"][-len(draft)//5:]))/SIDE + 0.5)
        # The lattice that the water starts as swells in the first three tenths of a second, with a held body as well.
        energy = [(t, k + p + mass*(v*v/2 + G*z)) for t, k, p, v, z in zip(
            table["time"], history["kinetic_energy"], history["potential_energy"], table["velocity_z"], table["position_z"])]
        def gain(start):
            late = [e for t, e in energy if t >= start]
            return (max(late) - late[0])/(mass*G*SIDE)
        grown, early = gain(0.3), gain(0.2)
        case.figure(f"cube, density ratio {density/RHO}, {across} across: energy gained after 0.2 s, over the cube's weight times height",
                    early, "<= 0.02", early <= 0.02)
        case.state(f"cube, density ratio {density/RHO}, {across} across: the same after 0.3 s", grown)
        fastest = max(abs(v) for v in table["velocity_z"])
        if density == 500:
            case.hold(f"cube, density ratio 0.5: draft {mean(late):.3f}, within 5 % of the height", abs(off) <= 0.05)
        else:
            # The surface is known to a spacing, which is 0.17 of the height here.
            case.hold(f"cube, density ratio 0.05: floats on the water, draft {mean(late):.3f}", abs(off) <= 1.2*d/SIDE)
            case.hold(f"cube, density ratio 0.05: never faster than a fall of three heights ({fastest:.2f} m/s)",
                      fastest <= (2*G*3*SIDE)**0.5)
        case.hold(f"cube, density ratio {density/RHO}: no energy out of nothing", grown <= 0.02)
        case.hold(f"cube, density ratio {density/RHO}: comes to rest", max(late) - min(late) <= 0.05)
case.plot("Cube at the surface", "t, s", "draft over height", curves)

# --- momentum ------------------------------------------------------------------------------------
box = {"box": {"min": [0.07]*3, "max": [0.12]*3}, "velocity": [0.3, 0.1, 0], "angular_velocity": [0, 0, 3], "friction": "no-slip"}
scene = write("shot", [0.2]*3, 0.15, [body(300, **box)], 0.0125, 0.1, dict.fromkeys("xyz", "periodic"), gravity=[0, 0, 0])
out = case.run("shot", scene=scene)
table, history = read_table(out / "bodies.csv"), read_table(out / "history.csv")
mass, lost = 300*0.05**3, 0
total = [[m + mass*v for m, v in zip(history[f"momentum_{a}"], table[f"velocity_{a}"])] for a in "xyz"]
lost = max(abs(m - series[0]) for series in total for m in series)/(mass*0.3)
case.figure("momentum of body and water, largest change over that of the shot", lost, "<= 1e-6", lost <= 1e-6)
case.hold("momentum is kept to rounding of single precision", lost <= 1e-6)
given = 1 - table["velocity_x"][-1]/0.3
case.hold(f"the water took its part: {given:.2f} of the body's momentum", given > 0.5)

# --- the same bits -------------------------------------------------------------------------------
box = {"box": {"min": [0.1, 0.1, 0.14], "max": [0.2, 0.2, 0.24]}}
scene = write("bits", [0.3, 0.3, 0.4], 0.2, [body(500, **box)], 0.02, 0.3)


def state_hash(out):
    return json.loads((out / "summary.json").read_text())["state_hash"]


one = state_hash(case.run("bits_1", "--threads", 1, scene=scene))
four = state_hash(case.run("bits_4", "--threads", 4, scene=scene))
case.hold("the same bits with one thread and with four", one == four)
out = case.run("bits_resumed", "--until", 0.15, scene=scene)
subprocess.run([case.program, "resume", str(out), "--until", "0.3", "--quiet"], check=True, timeout=100)
case.hold("the same bits after a restart", one == state_hash(out))
case.finish()
