#!/usr/bin/python3
"""Nests: what a finer box gives, beside the scene around it and a run that is fine everywhere."""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, ROOT, read_table

case = Case("nests", "Nests: a finer box in a coarse tank", methods=("dfsph",))
METHOD = case.args.method or "isph"
G = 9.81


def run_three(name, scene, nest, spacing, *more):
    """Folders of the scene, its nest and a fine run."""
    scene = {"method": METHOD, "dimension": 2, "spacing": spacing, **scene}
    coarse = case.run(f"{name}_nest", *more, scene=case.write_scene(f"{name}_nest", {**scene, "nests": [
        {"name": "near", **nest}]}))
    fine = case.run(f"{name}_fine", *more, scene=case.write_scene(f"{name}_fine", {**scene, "spacing": spacing/2}))
    return coarse, coarse/"nests"/"near", fine


def integrate(table, column, end):
    times, values = table["time"], table[column]
    return sum(v*(t - s) for s, t, v in zip(times, times[1:], values[1:]) if t <= end)


def dam(n):
    d, end = 0.5/n, 1.0
    scene = {"domain": {"min": [0, 0], "max": [1.6, 1]}, "end_time": end, "output": {"interval": 0.1},
             "fluids": [{"name": "water", "viscosity": 1e-3, "fill": [{"box": {"min": [0, 0], "max": [0.5, 0.5]}}]}],
             "probes": [{"name": "wall", "kind": "patch", "position": [1.6, 0.05], "normal": [-1, 0], "length": 0.1},
                        {"name": "all", "kind": "volume", "position": [1.4, 0.5], "length": 0.4, "height": 1}]}
    tables = [read_table(folder/"probes.csv") for folder in
              run_three(f"dam_{n}", scene, {"box": {"min": [1, 0], "max": [1.6, 1]}}, d)]
    pushes = [integrate(t, "wall_force_x", end) for t in tables]
    volumes = [t["all_volume"][-1] for t in tables]
    name = f"dam, {n} over its height"
    share = volumes[1]/volumes[0]
    case.figure(f"{name}: volume in the nest over that in the scene", share, "within 0.02", abs(share - 1) <= 0.02)
    case.figure(f"{name}: impulse in the nest over the fine run", pushes[1]/pushes[2], "within 0.05",
                abs(pushes[1]/pushes[2] - 1) <= 0.05)
    case.state(f"{name}: impulse in the scene over the fine run", pushes[0]/pushes[2])
    return [(f"{word}, {n}", t["time"], [v/1000 for v in t["wall_force_x"]], False)
            for word, t in zip(("scene", "nest", "fine run"), tables)]


def waves(n):
    depth, begin = 0.4, 5
    scene = {"domain": {"min": [0, 0], "max": [8, 0.8]}, "end_time": 8, "output": {"interval": 0.5},
             "fluids": [{"name": "water", "viscosity": 1e-3, "fill": [{"box": {"min": [0.3, 0], "max": [8, depth]}}]}],
             "bodies": [{"name": "piston", "box": {"min": [0.2, 0], "max": [0.3, 0.8]}, "motion": {"piston": {
                 "regular": {"height": 0.08, "period": 1.4}, "ramp": 1, "depth": depth, "direction": [1, 0]}}}],
             "damping_zones": [{"box": {"min": [6, 0], "max": [8, 0.8]}, "direction": [1, 0], "rate": 4}],
             "probes": [{"name": "gauge", "kind": "level", "position": [3.5, depth]}]}
    levels = []
    for folder in run_three(f"waves_{n}", scene, {"box": {"min": [2.5, 0], "max": [4.5, 0.8]}}, depth/n):
        table = read_table(folder/"probes.csv")
        levels.append([z for t, z in zip(table["time"], table["gauge_level"]) if t >= begin])
    heights = [max(z) - min(z) for z in levels]
    means = [sum(z)/len(z) for z in levels]
    name = f"waves, {n} layers"
    case.figure(f"{name}: height in the nest over the fine run", heights[1]/heights[2], "within 0.05",
                abs(heights[1]/heights[2] - 1) <= 0.05)
    case.state(f"{name}: height in the scene over the fine run", heights[0]/heights[2])
    lower = (means[1] - means[2])/depth
    case.figure(f"{name}: mean level in the nest less that of the fine run, over the depth", lower, "within 0.005",
                abs(lower) <= 0.005)


def force_in_phase(folder, frequency):
    """N per m: the part of the force on the plate that goes with its place, over the last period."""
    table = read_table(folder/"bodies.csv")
    rows = [(t, f) for t, f in zip(table["time"], table["mean_pressure_force_x"]) if t > 0.5 + 1e-9]
    step = rows[1][0] - rows[0][0]
    return 2/len(rows)*sum(f*math.sin(2*math.pi*frequency*(t - step/2)) for t, f in rows)


def plate(feedback):
    frequency = 2
    scene = {"domain": {"min": [0, 0], "max": [1, 1]}, "gravity": [0, 0], "end_time": 1, "output": {"interval": 0.01},
             "fluids": [{"name": "water", "viscosity": 1e-3, "fill": [{"box": {"min": [0, 0], "max": [1, 0.9]}}]}],
             "bodies": [{"name": "plate", "box": {"min": [0.495, 0.4], "max": [0.505, 0.5]}, "motion": {"oscillation": {
                 "direction": [1, 0], "amplitude": 0.01, "frequency": frequency, "ramp": 0.5}}}]}
    nest = {"box": {"min": [0.3, 0.25], "max": [0.7, 0.65]}, "follow": "plate", "feedback": feedback}
    forces = [force_in_phase(f, frequency) for f in run_three(f"plate_{feedback}".lower(), scene, nest, 0.1/8)]
    name = f"plate, {'with' if feedback else 'no'} feedback"
    case.figure(f"{name}: force in the nest over the fine run", forces[1]/forces[2], "within 0.1",
                abs(forces[1]/forces[2] - 1) <= 0.1)
    case.state(f"{name}: force in the scene over the fine run", forces[0]/forces[2])


def cylinder(feedback):
    """Drag of a cylinder at Re 100 in a liquid that flows at first like a block, in a full channel: no free surface."""
    speed, width, density = 0.1, 0.1, 1000
    scene = {"domain": {"min": [0, 0], "max": [2, 1.2], "walls": {"x": "periodic"}}, "gravity": [0, 0], "end_time": 8,
             "fluids": [{"name": "water", "viscosity": 0.1, "fill": [{"box": {"min": [0, 0], "max": [2, 1.2]},
                                                                     "velocity": [speed, 0]}]}],
             "bodies": [{"name": "cylinder", "sphere": {"centre": [0.7, 0.6], "radius": width/2}, "friction": "no-slip"}],
             "output": {"interval": 0.25}}
    drags = []
    nest = {"box": {"min": [0.55, 0.42], "max": [1, 0.78]}, "feedback": feedback}
    for folder in run_three(f"cylinder_{feedback}".lower(), scene, nest, width/8):
        table = read_table(folder/"bodies.csv")
        rows = [p + v for t, p, v in zip(table["time"], table["mean_pressure_force_x"], table["mean_viscous_force_x"])
                if t > 2]
        drags.append(sum(rows)/len(rows)/(0.5*density*speed**2*width))
    name = f"cylinder, {'with' if feedback else 'no'} feedback"
    case.figure(f"{name}: drag in the nest over the fine run", drags[1]/drags[2], "within 0.05",
                abs(drags[1]/drags[2] - 1) <= 0.05)
    case.state(f"{name}: drag in the scene over the fine run", drags[0]/drags[2])


def pulled():
    """A plate that a constant force pulls across: its liquid is most of what gains speed."""
    size, until = 1.2, 0.2
    scene = {"domain": {"min": [0, 0], "max": [size, size]}, "gravity": [0, 0], "end_time": until, "output": {"interval": 0.05},
             "fluids": [{"name": "water", "viscosity": 0, "fill": [{"box": {"min": [0, 0], "max": [size, size]}}]}],
             "bodies": [{"name": "plate", "box": {"min": [0.52, 0.598], "max": [0.68, 0.602]}, "dynamics": "free", "mass": 10,
                         "force": [0, 10, 0], "friction": "slip", "locked": "x,turn_z"}]}
    folders = run_three("pulled", scene, {"box": {"min": [0.36, 0.44], "max": [0.84, 0.76]}}, 0.02)
    speeds = [read_table(folder/"bodies.csv")["velocity_y"][-1] for folder in (folders[0], folders[2])]
    alone = case.run("pulled_alone", scene=case.write_scene("pulled_alone", {"method": METHOD, "dimension": 2, "spacing": 0.02, **scene}))
    without = read_table(alone/"bodies.csv")["velocity_y"][-1]
    case.figure("pulled plate: speed in the nest over the fine run", speeds[0]/speeds[1], "within 0.05",
                abs(speeds[0]/speeds[1] - 1) <= 0.05)
    case.state("pulled plate: speed without a nest over the fine run", without/speeds[1])


def eel():
    """The second beat of scenes/eel."""
    nest = '[{"name": "near", "box": {"min": [3.6, 0.6], "max": [4.94, 1.4]}, "follow": "eel"}]'
    speeds = []
    for label, spacing, more in (("eel_nest", 0.02, ["--set", f"nests={nest}"]), ("eel_alone", 0.02, []), ("eel_fine", 0.01, [])):
        table = read_table(case.run(label, "--set", f"method={METHOD}", "--spacing", spacing, "--until", 2, *more,
                                    scene=ROOT/"scenes/eel/scene.json")/"bodies.csv")
        first = min(range(len(table["time"])), key=lambda k: abs(table["time"][k] - 1))
        speeds.append(math.hypot(*(table[f"position_{a}"][-1] - table[f"position_{a}"][first] for a in "xy")))
    case.figure("eel: speed in a nest over the fine run", speeds[0]/speeds[2], "within 0.03", abs(speeds[0]/speeds[2] - 1) <= 0.03)
    case.state("eel: speed without a nest over the fine run", speeds[1]/speeds[2])


def rest():
    d, depth = 0.02, 0.4
    out = case.run("rest", scene=case.write_scene("rest", {
        "method": METHOD, "dimension": 2, "domain": {"min": [0, 0], "max": [1, 0.6]}, "spacing": d, "end_time": 1,
        "fluids": [{"name": "water", "viscosity": 1e-3, "fill": [{"box": {"min": [0, 0], "max": [1, depth]}}]}],
        "probes": [{"name": "middle", "position": [0.5, 0.2]}], "output": {"interval": 0.1},
        "nests": [{"name": "near", "box": {"min": [0.3, 0.12], "max": [0.7, 0.3]}}]}))
    speed = max(read_table(out/"nests"/"near"/"history.csv")["speed_max"])/math.sqrt(G*depth)
    pressure = read_table(out/"nests"/"near"/"probes.csv")["middle_pressure"][-1]/(1000*G*0.2)
    case.figure("rest: fastest particle over sqrt(g H)", speed, "<= 0.01", speed <= 0.01)
    case.figure("rest: pressure in the middle over that of still water", pressure, "within 0.01",
                abs(pressure - 1) <= 0.01)


rest()
curves = []
for size in case.pick((25,), (25, 50)):
    curves += dam(size)
if METHOD == "isph":
    for size in case.pick((), (10, 20)):
        waves(size)
    for fed in case.pick((False,), (False, True)):
        plate(fed)
    for fed in case.pick((), (False, True)):
        cylinder(fed)
    pulled()
    for swim in case.pick((), (eel,)):
        swim()
case.plot("Force on the lowest 0.1 m of the wall", "t, s", "F, kN/m", curves)
case.finish()
