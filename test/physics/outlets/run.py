#!/usr/bin/python3
"""Outlets whose pressure is given: a pool at rest, a pool that falls to the level beyond, pipes."""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, fit_line, mean, read_series, read_table, read_vtu

METHODS = ("isph", "eisph", "dfsph", "wcsph")
case = Case("outlets", "Outlets with a level or a pressure")

RHO, G, LONG, DEEP, LOWER = 1000, 9.81, 0.8, 0.2, 0.15
WIDE, U, MU, GIVEN = 0.2, 0.5, 10, 2000
LONG_PIPE, SPEED, MU_BETWEEN = 0.8, 0.1, 1
# s: no multiple of the time in which a layer of particles goes by, which pressures of wcsph swing with.
PIPE_OUTPUT = 0.0137


def run_pool(method, layers, level, viscosity, end):
    """Deviations of the mean sensor pressure and of the mean level over the last half; the level in time."""
    content = {"dimension": 2, "method": method, "domain": {"min": [0, 0], "max": [LONG + 0.2, 0.3]}, "spacing": DEEP/layers,
               "end_time": end, "gravity": [0, -G],
               "fluids": [{"name": "water", "viscosity": viscosity,
                           "fill": [{"box": {"min": [0, 0], "max": [LONG + 0.2, DEEP]}}]}],
               "outlets": [{"name": "out", "centre": [LONG, 0.15], "normal": [1, 0], "width": 0.3, "level": level}],
               "probes": [{"name": "floor", "position": [LONG - 0.04, 0.02]}],
               "output": {"interval": end/40, "probe_interval": 0.01, "fields": ["velocity"], "surfaces": False}}
    label = f"pool_{method}_{layers}_{level}"
    out = case.run(label, scene=case.write_scene(label, content), may_fail=True)
    if out is None:
        return None
    probes = read_table(out/"probes.csv")
    read = mean([p for t, p in zip(probes["time"], probes["floor_pressure"]) if t >= end/2])
    times, levels = [], []
    for time, path in read_series(out):
        xs = read_vtu(path)["Points"][0::3]
        times.append(time)
        levels.append(sum(1 for x in xs if x < LONG)*(DEEP/layers)**2/LONG)
    late = mean([h for t, h in zip(times, levels) if t >= end/2])
    return read/(RHO*G*(level - 0.02)) - 1, late/level - 1, times, levels


def try_pool(label, *pool):
    """What run_pool finds; None, and a figure that says so, if it ends early."""
    found = run_pool(*pool)
    case.figure(f"{label}: runs to its end", int(found is not None), "1", found is not None)
    return found


def rest(method, layers, end):
    label = f"rest, {method}, {layers} layers"
    found = try_pool(label, method, layers, DEEP, 0.001, end)
    if found is None:
        return
    case.figure(f"{label}: pressure of the sensor, deviation", found[0], "within 0.02", abs(found[0]) <= 0.02)
    case.figure(f"{label}: water in the pool, deviation", found[1], "within 0.02", abs(found[1]) <= 0.02)


def fall(method, layers, end):
    label = f"lower level, {method}, {layers} layers"
    found = try_pool(label, method, layers, LOWER, 1, end)
    if found is None:
        return
    case.figure(f"{label}: mean level, deviation", found[1], "within 0.05", abs(found[1]) <= 0.05)
    curves.append((f"{method}, {layers} layers", found[2], found[3], False))


def pipe(method, across):
    label = f"pipe, {method}, {across} across"
    content = {"dimension": 2, "method": method, "domain": {"min": [0, 0], "max": [1.1, WIDE], "walls": {"y": "no-slip"}},
               "gravity": [0, 0], "spacing": WIDE/across, "end_time": 1,
               "fluids": [{"name": "oil", "viscosity": MU,
                           "fill": [{"box": {"min": [0.1, 0], "max": [1.1, WIDE]}, "velocity": [U, 0]}]}],
               "inlets": [{"name": "in", "centre": [0.1, WIDE/2], "normal": [1, 0], "width": WIDE, "speed": U,
                           "profile": "parabolic"}],
               "outlets": [{"name": "out", "centre": [0.9, WIDE/2], "normal": [1, 0], "width": WIDE, "pressure": GIVEN}],
               "output": {"interval": PIPE_OUTPUT, "fields": ["velocity", "pressure"], "surfaces": False}}
    if method == "wcsph":
        content["wcsph"] = {"stiffness": 14000}
    name = f"pipe_{method}_{across}"
    out = case.run(name, scene=case.write_scene(name, content), may_fail=True)
    case.figure(f"{label}: runs to its end", int(out is not None), "1", out is not None)
    if out is None:
        return
    lines = []
    for time, path in read_series(out):
        if time < 0.49:
            continue
        data = read_vtu(path)
        xs, ps = data["Points"][0::3], data["pressure"]
        middle = [i for i, x in enumerate(xs) if 0.3 < x < 0.7]
        lines.append(fit_line([xs[i] for i in middle], [ps[i] for i in middle]))
    slope = -mean([a for a, _ in lines])/(12*MU*U/WIDE**2)
    off = mean([a*0.9 + b for a, b in lines])/GIVEN - 1
    case.figure(f"{label}: pressure at the outlet, deviation", off, "within 0.02", abs(off) <= 0.02)
    case.figure(f"{label}: pressure gradient over Poiseuille's", slope, "0.9 to 1.1", 0.9 <= slope <= 1.1)


def between(label, method, across, speed, viscosity, pressures, end):
    """Mean speeds in time, and the fullness, of a pipe between two outlets with pressures; None if it ends early."""
    d, room = WIDE/across, 8*WIDE/across
    whole = LONG_PIPE + 2*room
    content = {"dimension": 2, "method": method, "gravity": [0, 0], "spacing": d, "end_time": end,
               "domain": {"min": [0, 0], "max": [whole, WIDE], "walls": {"y": "no-slip" if viscosity else "slip"}},
               "fluids": [{"name": "oil", "viscosity": viscosity,
                           "fill": [{"box": {"min": [0, 0], "max": [whole, WIDE]}, "velocity": [speed, 0]}]}],
               "outlets": [{"name": "from", "centre": [room, WIDE/2], "normal": [-1, 0], "width": WIDE,
                            "pressure": pressures[0]},
                           {"name": "to", "centre": [room + LONG_PIPE, WIDE/2], "normal": [1, 0], "width": WIDE,
                            "pressure": pressures[1]}],
               "output": {"interval": end/40, "fields": ["velocity"], "surfaces": False}}
    name = label.replace(", ", "_").replace(" ", "_")
    out = case.run(name, scene=case.write_scene(name, content), may_fail=True)
    case.figure(f"{label}: runs to its end", int(out is not None), "1", out is not None)
    if out is None:
        return None
    rows = []
    for time, path in read_series(out):
        data = read_vtu(path)
        inside = [u for x, u in zip(data["Points"][0::3], data["velocity"][0::3]) if room < x < room + LONG_PIPE]
        rows.append((time, sum(inside)*d*d/(WIDE*LONG_PIPE), len(inside)*d*d/(WIDE*LONG_PIPE)))
    return rows


def steady(method, across, end):
    label = f"between pressures, {method}, {across} across"
    fall = 12*MU_BETWEEN*SPEED/WIDE**2*LONG_PIPE + RHO*SPEED**2/2
    rows = between(label, method, across, SPEED, MU_BETWEEN, (fall, 0), end)
    if rows is None:
        return
    speed = mean([u for t, u, _ in rows if t > end/2])/SPEED - 1
    full = mean([share for t, _, share in rows if t > end/2]) - 1
    case.figure(f"{label}: flow, deviation", speed, "within 0.03", abs(speed) <= 0.03)
    case.figure(f"{label}: liquid in the pipe, deviation", full, "within 0.01", abs(full) <= 0.01)


def start_and_turn(method, across):
    """From a flow against the pressure, without viscosity: the time at which it turns, and the speed later."""
    label = f"turns, {method}, {across} across"
    fall, end = 48.0, 4.0
    rows = between(label, method, across, -SPEED, 0, (100 + fall, 100), end)
    if rows is None:
        return
    # what comes in takes half of rho u^2 from the pressure there, either way; top: at that speed, all of it
    gain, top = fall/RHO/LONG_PIPE, math.sqrt(2*fall/RHO)
    turn = top/gain*math.atan(SPEED/top)
    after = rows[-1][1]/(top*math.tanh((end - turn)*gain/top)) - 1
    last = [(t, u) for t, u, _ in rows if abs(u) < SPEED/2]
    slope, offset = fit_line([t for t, _ in last], [u for _, u in last])
    case.figure(f"{label}: time of rest, deviation", -offset/slope/turn - 1, "within 0.03", abs(-offset/slope/turn - 1) <= 0.03)
    case.figure(f"{label}: speed at the end, deviation", after, "within 0.03", abs(after) <= 0.03)


curves = []
for name in case.pick(("isph", "eisph"), METHODS):
    for number in case.pick((10,), (20, 40) if name == "isph" else (20,)):
        rest(name, number, case.pick(1, 4))
        if not (case.smoke and name == "eisph"):
            fall(name, number, case.pick(6, 8))
    for number in case.pick((10,), (10, 20)):
        pipe(name, number)
for name, number in case.pick((("isph", 10),), (("isph", 16), ("isph", 32), ("eisph", 16), ("dfsph", 16))):
    steady(name, number, case.pick(16, 80))
    start_and_turn(name, number)
case.plot("Mean depth of the pool, level 0.15 m beyond", "t, s", "m", curves)
case.finish()
