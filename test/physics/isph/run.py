#!/usr/bin/python3
"""ISPH beside DFSPH and EISPH: columns at rest, a dam break, a rotating patch, a standing wave, a vortex, a held box."""
import math
import pathlib
import sys

PHYSICS = pathlib.Path(__file__).resolve().parents[1]
sys.path[:0] = [str(PHYSICS), str(PHYSICS / "standing_wave")]
import period
from harness import Case, fit_line, interpolate, mean, read_series, read_table, read_vtu

case = Case("isph", "Incompressible SPH")

G, RHO = 9.81, 1000


def scene(label, method, spacing, end, domain, fill, interval, **more):
    content = {"method": method, "dimension": 2, "spacing": spacing, "end_time": end,
               "domain": {"min": [0, 0], "max": domain, **more.pop("sides", {})},
               "fluids": [{"name": "water", "density": RHO, "viscosity": 0, "fill": [fill]}],
               "output": {"interval": interval, "checkpoint_interval": 1000}, **more}
    out = case.run(label, scene=case.write_scene(label, content))
    return out, read_table(out / "history.csv")


def late(table, name):
    values = table[name]
    return values[len(values)//2:]


def count_iterations(deep, label, **parameters):
    """Of the first step, from no pressure: later solves start from what is nearly the answer."""
    d = 1/deep
    _, first = scene(f"first{deep}_{label}", "isph", d, 0.1*d, [30*d, 1.5], {"box": {"min": [0, 0], "max": [30*d, 0.9]}}, 0.1*d,
                     isph={"tolerance": 1e-6, "iterations_max": 5000, **parameters})
    return first["divergence_iterations"][-1]


iterations, plain, solvers = {}, {}, ("cg", "bicgstab", "gmres")
PROBES = [{"name": "floor", "position": [0.1, 0]}, {"name": "side", "position": [0, 0.3]}]
for deep in case.pick((10, 30), (10, 30, 100, 300)):
    d, end = 1/deep, case.pick(1, 5 if deep < 300 else 1)
    out, table = scene(f"column{deep}", "isph", d, end, [30*d, 1.5], {"box": {"min": [0, 0], "max": [30*d, 1]}}, end/10, probes=PROBES)
    probes = read_table(out / "probes.csv")
    for name, depth in ("floor", 1), ("side", 0.7):
        wall = mean(late(probes, f"{name}_pressure"))/(RHO*G*depth) - 1
        case.figure(f"column, {deep} deep: probe at the {name}, deviation", wall, "within 0.01", abs(wall) <= 0.01)
    floor = mean(late(table, "wall_force_ratio")) - 1
    level = deep*(mean(late(table, "potential_energy"))/(RHO*G*0.5*30*d) - 1)
    energy = table["kinetic_energy"][-1]/table["potential_energy"][-1]
    iterations[deep] = count_iterations(deep, "cg")
    plain[deep] = count_iterations(deep, "jacobi", preconditioner="jacobi")
    case.figure(f"column, {deep} deep: force on the floor over the weight, deviation", floor, "within 0.005", abs(floor) <= 0.005)
    case.figure(f"column, {deep} deep: level, in spacings", level, f"within {0.1*max(deep/30, 1):.2g}", abs(level) <= 0.1*max(deep/30, 1))
    case.figure(f"column, {deep} deep: kinetic over potential energy at the end", energy, "<= 1e-5", energy <= 1e-5)
    case.state(f"column, {deep} deep: the same at a tenth of the time", table["kinetic_energy"][1]/table["potential_energy"][1])
    case.hold(f"column, {deep} deep: every solve converges", sum(table["unconverged_steps"]) == 0)
    # 1.0 % seen at 10 layers, 0.3 % at 30: level and surface row are off by a twentieth of a spacing.
    case.hold(f"column, {deep} deep: floor within 1.2 % ({floor:.4f})", abs(floor) <= 0.012)
    case.hold(f"column, {deep} deep: kinetic energy below 1e-4 of potential ({energy:.1e})", energy <= 1e-4)
spread = max(iterations.values())/min(iterations.values()) - 1
shown = ", ".join(f"{deep}: {count:.0f}" for deep, count in iterations.items())
case.figure(f"column: iterations ({shown}), spread", spread, "<= 0.3", spread <= 0.3)
case.hold("column: at most 15 iterations", max(iterations.values()) <= 15)
case.state("column: iterations of cg with Jacobi's preconditioner, the deepest", plain[max(plain)])
case.plot("Iterations against depth", "layers", "iterations from no pressure to 1e-6",
          [("multigrid", list(iterations), list(iterations.values()), True),
           ("jacobi", list(plain), list(plain.values()), True)])
SHAKE = str((case.folder/"shake.lua").resolve())


def shake(method, deep, speed, **more):
    """A column whose particles start with random velocities: what remains. Energies are over the potential one."""
    d = 1/deep
    flow = {"script": SHAKE, "params": {"speed": speed, "spacing": d}}
    _, table = scene(f"shaken{deep}_{method}_{speed}{len(more)}", method, d, case.pick(1, 5), [30*d, 1.5],
                     {"box": {"min": [0, 0], "max": [30*d, 1]}, "flow": flow}, 0.1, **more)
    energy = [k/table["potential_energy"][0] for k in table["kinetic_energy"]]
    floor = mean(late(table, "wall_force_ratio")) - 1
    level = deep*(mean(late(table, "potential_energy"))/(RHO*G*0.5*30*d) - 1)
    return floor, level, energy


for deep, speed in case.pick(((10, 0.1),), ((10, 0.1), (30, 0.1), (100, 0.1), (30, 1.0))):
    for kind, more in ("", {}), (", filter off", {"isph": {"filter": "off"}}):
        floor, level, energy = shake("isph", deep, speed, **more)
        name, most = f"shaken by {speed:g} m/s, {deep} deep{kind}", 0.1*max(deep/30, 1)
        growth = max(b - a for a, b in zip(energy, energy[1:]))/energy[0]
        case.figure(f"{name}: force on the floor over the weight, deviation", floor, "within 0.005", abs(floor) <= 0.005)
        case.figure(f"{name}: level, in spacings", level, f"within {most:.2g}", abs(level) <= most)
        case.figure(f"{name}: largest growth of the kinetic energy in 0.1 s over the start's", growth, "<= 0.01", growth <= 0.01)
        case.state(f"{name}: kinetic energy at the end over the start's", energy[-1]/energy[0])
        if not kind:
            case.hold(f"{name}: kinetic energy never above the start's ({max(energy)/energy[0]:.3f})", max(energy) <= energy[0])
    if not case.smoke:
        floor, level, energy = shake("dfsph", deep, speed)
        case.state(f"dfsph, shaken by {speed:g} m/s, {deep} deep: force on the floor over the weight, deviation", floor)
        case.state(f"dfsph, shaken by {speed:g} m/s, {deep} deep: level, in spacings", level)
        case.state(f"dfsph, shaken by {speed:g} m/s, {deep} deep: kinetic energy at the end over the start's", energy[-1]/energy[0])
others = {name: count_iterations(30, name, solver=name) for name in solvers}
shown = ", ".join(f"{name}: {count:.0f}" for name, count in others.items())
case.hold(f"column, 30 deep: every solver converges ({shown})", max(others.values()) <= 20)


def break_dam(method, across, label="", **more):
    end = 6/G**0.5
    out, table = scene(f"dam{across}_{method}{label}", method, 1/across, end, [4, 3], {"box": {"min": [0, 0], "max": [1, 1]}}, end/100,
                       **more)
    times = [t*G**0.5 for t in table["time"]]
    energy = [(k + p)/(table["kinetic_energy"][0] + table["potential_energy"][0])
              for k, p in zip(table["kinetic_energy"], table["potential_energy"])]
    fronts = [max(read_vtu(path)["Points"][0::3]) + 0.5/across for _, path in read_series(out)]
    flow = read_table(PHYSICS / "dam_break" / "potential.csv")
    points = [(t, z) for n, t, z in zip(flow["n2"], flow["T"], flow["Z"]) if n == 1 and 1.2 <= z <= 3.8]
    lag = mean([interpolate(fronts[:60], times[:60], z) - t for t, z in points])
    case.plot(f"Dam break, {across} across, {method}{label}: energy over that of the start", "T", "", [(method, times, energy, False)])
    return lag, interpolate(times, energy, 2.0), interpolate(times, energy, 4.0), table


for across in case.pick((20,), (40, 80)):
    lag, at2, at4, table = break_dam("isph", across)
    case.figure(f"dam break, {across} across: lag of the front in T", lag, "within 0.02", abs(lag) <= 0.02)
    case.figure(f"dam break, {across} across: energy at T = 2", at2, "1 within 0.01", abs(at2 - 1) <= 0.01)
    case.figure(f"dam break, {across} across: energy at T = 4", at4, ">= 0.96", at4 >= 0.96)
    case.hold(f"dam break, {across} across: every solve converges", sum(table["unconverged_steps"]) == 0)
    case.hold(f"dam break, {across} across: no particle slowed", max(table["capped"]) == 0)
    if not case.smoke:
        lag, at2, at4, table = break_dam("dfsph", across)
        for text, value in ("lag of the front in T", lag), ("energy at T = 2", at2), ("energy at T = 4", at4):
            case.state(f"dfsph, {across} across: {text}", value)

# eisph: the literature's single sweep, and sweeps in pseudo-time as many as the step needs. What it promises is 1 % of
# compression, and no gain of energy: 0.3 % is what isph itself gains in passing.
KINDS = {"one sweep": {"iteration": "jacobi", "sweeps": 1}, "pseudo-time": {"iteration": "pseudo-time", "sweeps": 0}}
for number, (kind, values) in enumerate(KINDS.items()):
    across, deep = case.pick(20, 40), case.pick(10, 30)
    lag, at2, at4, table = break_dam("eisph", across, str(number), eisph=values)
    gain = max((k + p)/(table["kinetic_energy"][0] + table["potential_energy"][0])
               for k, p in zip(table["kinetic_energy"], table["potential_energy"])) - 1
    case.figure(f"eisph, {kind}, dam break, {across} across: lag of the front in T", lag, "within 0.02", abs(lag) <= 0.02)
    case.figure(f"eisph, {kind}, dam break, {across} across: energy at T = 4", at4, ">= 0.96", at4 >= 0.96)
    case.figure(f"eisph, {kind}, dam break, {across} across: energy gained", gain, "<= 0.005", gain <= 0.005)
    case.state(f"eisph, {kind}, dam break, {across} across: steps", table["step"][-1])
    case.state(f"eisph, {kind}, dam break, {across} across: sweeps per step", mean(table["divergence_iterations"]))
    case.hold(f"eisph, {kind}, dam break: no energy gained ({gain:.4f})", gain <= 0.01)
    d, end = 1/deep, case.pick(1, 5)
    out, table = scene(f"column{deep}_eisph{number}", "eisph", d, end, [30*d, 1.5], {"box": {"min": [0, 0], "max": [30*d, 1]}}, end/10,
                       probes=PROBES, eisph=values)
    wall = mean(late(read_table(out / "probes.csv"), "floor_pressure"))/(RHO*G) - 1
    energy = table["kinetic_energy"][-1]/table["potential_energy"][-1]
    case.figure(f"eisph, {kind}, column, {deep} deep: probe at the floor, deviation", wall, "within 0.02", abs(wall) <= 0.02)
    case.state(f"eisph, {kind}, column, {deep} deep: force on the floor over the weight, deviation", mean(late(table, "wall_force_ratio")) - 1)
    case.figure(f"eisph, {kind}, column, {deep} deep: kinetic over potential energy at the end", energy, "<= 1e-4", energy <= 1e-4)
    case.hold(f"eisph, {kind}, column: floor within 2 % ({wall:.4f})", abs(wall) <= 0.02)


def main_body(points, reach):
    """Share of the largest set of particles linked within `reach`."""
    cells, seen, most = {}, set(), 0
    for k, (x, y) in enumerate(points):
        cells.setdefault((int(x//reach), int(y//reach)), []).append(k)
    for start in range(len(points)):
        stack, size = [start], 0
        while stack:
            k = stack.pop()
            if k in seen:
                continue
            seen.add(k)
            size += 1
            x, y = points[k]
            cx, cy = int(x//reach), int(y//reach)
            stack += [j for a in (-1, 0, 1) for b in (-1, 0, 1) for j in cells.get((cx + a, cy + b), ())
                      if j not in seen and (points[j][0] - x)**2 + (points[j][1] - y)**2 < reach*reach]
        most = max(most, size)
    return most/len(points)


def turn(method, across):
    d, end = 1/across, case.pick(2, 4)
    out, table = scene(f"patch{across}_{method}", method, d, end, [6, 6],
                       {"box": {"min": [2.5, 2.5], "max": [3.5, 3.5]}, "spin": [0, 0, 1]}, end/8, gravity=[0, 0])
    data = read_vtu(read_series(out)[-1][1])["Points"]
    share = main_body(list(zip(data[0::3], data[1::3])), 1.8*d)
    # The area: each particle has the volume of the start, less where they crowd.
    return share, table["kinetic_energy"][-1]/table["kinetic_energy"][0], table["density_error_mean"][-1]


for across in case.pick((30,), (40, 80)):
    share, kept, error = turn("isph", across)
    case.figure(f"patch, {across} across: main body, share of the particles", share, ">= 0.97", share >= 0.97)
    case.figure(f"patch, {across} across: kinetic energy over that of the start", kept, "1 within 0.02", abs(kept - 1) <= 0.02)
    case.figure(f"patch, {across} across: mean error of volume", error, "<= 0.01", error <= 0.01)
    if not case.smoke:
        share, kept, error = turn("dfsph", across)
        case.state(f"dfsph patch, {across} across: main body", share)
        case.state(f"dfsph patch, {across} across: kinetic energy", kept)


for n in case.pick((40,), (40, 80, 160)):
    long = n == 80
    out = case.run(f"wave{n}", "--spacing", 1/n, "--set", "method=isph", "--set", f"end_time={8.4 if long else 3}",
                   scene=PHYSICS / "standing_wave" / "scene.json")
    table = read_table(out / "history.csv")
    early = sum(t < 3.001 for t in table["time"])
    times, energy = table["time"][:early], table["kinetic_energy"][:early]
    deviation = period.OMEGA/period.find_omega(times, energy)/period.period(energy) - 1
    case.figure(f"wave, L/{n}: period, deviation", deviation, "within 0.003", abs(deviation) <= 0.003)
    kept = max(energy[-40:])/max(energy[:10])
    case.state(f"wave, L/{n}: kinetic energy kept in four periods", kept)
    if long:
        kept = math.sqrt(max(table["kinetic_energy"][-40:])/max(energy[:10]))
        case.figure(f"wave, L/{n}: amplitude kept in ten periods", kept, "1 within 0.03", abs(kept - 1) <= 0.03)
    case.hold(f"wave, L/{n}: period within 2 % ({deviation:.4f})", abs(deviation) <= 0.02)

errors = {}
K, NU = 2*math.pi, 0.01
for n in case.pick((32,), (50, 100)):
    for method in case.pick(("isph",), ("isph", "dfsph")):
        out = case.run(f"vortex{n}_{method}", "--spacing", 1/n, "--until", 0.73, "--set", f"method={method}", "--set", f"{method}.support=3",
                       "--set", "output.interval=0.73", scene=PHYSICS / "taylor_green" / "scene.json")
        time, path = read_series(out)[-1]
        data, fade, total = read_vtu(path), math.exp(-2*NU*K*K*time), 0
        for x, y, u, v in zip(data["Points"][0::3], data["Points"][1::3], data["velocity"][0::3], data["velocity"][1::3]):
            total += (u/fade - math.sin(K*x)*math.cos(K*y))**2 + (v/fade + math.cos(K*x)*math.sin(K*y))**2
        error = math.sqrt(3*total/len(data["Points"]))
        errors[method, n] = error
        if method == "isph":
            case.figure(f"vortex, {n} across: error of the velocity", error, "<= 0.01", error <= 0.01)
        else:
            case.state(f"dfsph vortex, {n} across: error of the velocity", error)
if not case.smoke:
    order = math.log(errors["isph", 50]/errors["isph", 100])/math.log(2)
    case.figure("vortex: order, 50 to 100 across", order, ">= 1.8", order >= 1.8)

d, end = 0.02, case.pick(0.6, 3)
out, table = scene("box", "isph", d, end, [1, 1], {"box": {"min": [0, 0], "max": [1, 0.8]}}, end/20,
                   bodies=[{"name": "box", "box": {"min": [0.4, 0.3], "max": [0.56, 0.46]}}])
lift = mean(late(read_table(out / "bodies.csv"), "mean_pressure_force_y"))/(RHO*G*0.16**2) - 1
case.figure("box: buoyancy, deviation", lift, "within 0.01", abs(lift) <= 0.01)
case.hold("box: every solve converges", sum(table["unconverged_steps"]) == 0)
case.finish()
