#!/usr/bin/python3
"""Liquids of high viscosity: waves that it damps, flow in a channel, a ball that sinks, a sheet that folds."""
import cmath
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, mean, read_series, read_table, read_vtu

case = Case("viscous_flow", "Thick liquids")

K, DEPTH, AMPLITUDE, BOXES = 2*math.pi, 0.5, 0.02, 20
OMEGA = math.sqrt(9.81*K*math.tanh(K*DEPTH))
NAMES = {"false": "explicit", "true": "implicit"}


def damping_of_theory(nu):
    """Rate of the amplitude, 1/s: of the root s of (s + 2 nu k^2)^2 + omega^2 = 4 nu^2 k^3 (k^2 + s/nu)^(1/2), by Newton."""
    s = complex(-2*nu*K*K, OMEGA)
    for _ in range(50):
        root = cmath.sqrt(K*K + s/nu)
        s -= ((s + 2*nu*K*K)**2 + OMEGA**2 - 4*nu**2*K**3*root)/(2*(s + 2*nu*K*K) - 2*nu*K**3/root)
    return -s.real


def wave_box(column, row):
    e = 1/BOXES
    x, y = (column + 0.5)*e, (row + 0.5)*e
    u = AMPLITUDE*OMEGA/math.sinh(K*DEPTH)
    return {"box": {"min": [column*e, row*e], "max": [(column + 1)*e, (row + 1)*e]},
            "velocity": [u*math.sin(K*x)*math.cosh(K*y), -u*math.cos(K*x)*math.sinh(K*y)]}


def decay_rate(method, across, viscosity, implicit):
    """Of the energy, 1/s."""
    label = f"wave_{method}_{across}_{viscosity:g}_{NAMES[implicit]}"
    scene = case.write_scene(label, {
        "dimension": 2, "domain": {"min": [0, 0], "max": [1, 0.8]}, "spacing": 1/across, "end_time": 2.5, "method": method,
        "implicit_viscosity": implicit == "true",
        "fluids": [{"name": "liquid", "viscosity": viscosity,
                    "fill": [wave_box(k % BOXES, k//BOXES) for k in range(BOXES*BOXES//2)]}],
        "output": {"interval": 0.01, "fields": ["velocity"]}})
    table = read_table(case.run(f"{label}_out", scene=scene)/"history.csv")
    t, energy = table["time"], table["kinetic_energy"]
    peaks = []
    for i in range(1, len(t) - 1):
        if energy[i - 1] < energy[i] >= energy[i + 1] and energy[i] > 0.05*max(energy):
            if peaks and t[i] - peaks[-1][0] < 0.2:
                if energy[i] > peaks[-1][1]:
                    peaks[-1] = (t[i], energy[i])
            else:
                peaks.append((t[i], energy[i]))
    peaks = peaks[:6]
    curves.append((f"{method}, 1/{across} m, {viscosity:g} Pa s, {NAMES[implicit]}", [p[0] for p in peaks],
                   [p[1]/peaks[0][1] for p in peaks], True))
    middle, log_middle = mean([p[0] for p in peaks]), mean([math.log(p[1]) for p in peaks])
    return -sum((p[0] - middle)*(math.log(p[1]) - log_middle) for p in peaks)/sum((p[0] - middle)**2 for p in peaks)


curves = []
for method in ("dfsph", "isph"):
    for across in case.pick((40,), (20, 40, 80)):
        for implicit in ("false", "true"):
            alone = decay_rate(method, across, 1e-3, implicit)
            ratio = (decay_rate(method, across, 5, implicit) - alone)/(2*damping_of_theory(0.005))
            name = f"{method}, {NAMES[implicit]}: wave of {across} d"
            if implicit == "true":
                case.figure(f"{name}: rate of damping over theory", ratio, "1 within 0.1", abs(ratio - 1) <= 0.1)
                # 0.81 to 1.17 seen; the Laplacian has 0.43 to 0.61.
                case.hold(f"{name}: between 0.79 and 1.24 ({ratio:.3f})", 0.79 <= ratio <= 1.24)
            else:
                case.state(f"{name}: rate of damping over theory", ratio)

HEIGHT, NU, FORCE = 0.2, 0.02, 0.4
for method in ("dfsph", "isph"):
    for across in case.pick((20,), (10, 20, 40)):
        for implicit in ("false", "true"):
            label = f"channel_{method}_{across}_{NAMES[implicit]}"
            end = 5*HEIGHT**2/(math.pi**2*NU)
            scene = case.write_scene(label, {
                "dimension": 2, "domain": {"min": [0, 0], "max": [0.2, HEIGHT], "walls": {"x": "periodic", "y": "no-slip"}},
                "gravity": [FORCE, 0], "spacing": HEIGHT/across, "end_time": end, "method": method,
                "implicit_viscosity": implicit == "true",
                "fluids": [{"name": "oil", "viscosity": 1000*NU, "fill": [{"box": {"min": [0, 0], "max": [0.2, HEIGHT]}}]}],
                "output": {"interval": end, "fields": ["velocity"]}})
            out = case.run(f"{label}_out", scene=scene)
            speed = mean(read_vtu(read_series(out)[-1][1])["velocity"][0::3])/(FORCE*HEIGHT**2/(12*NU))
            name = f"{method}, {NAMES[implicit]}: channel of {across} d"
            case.figure(f"{name}: mean velocity over theory", speed, "1 within 0.02", abs(speed - 1) <= 0.02)
            case.state(f"{name}: steps", read_table(out/"history.csv")["step"][-1])
            case.hold(f"{name}: within 7 % ({speed:.3f})", abs(speed - 1) <= 0.07)

RADIUS, TUBE, DEEP = 0.02, 0.08, 0.2
STOKES = 2/9*(7800 - 1400)*9.81*RADIUS**2/100
BOHLIN = sum(c*(RADIUS/TUBE)**n for n, c in {0: 1, 1: -2.10444, 3: 2.08877, 5: -0.94813, 6: -1.372, 8: 3.87, 10: -4.19}.items())
for method in case.pick(("dfsph",), ("dfsph", "isph")):
    for across in case.pick((5,), (5, 8)):
        d = 2*RADIUS/across
        edge = TUBE + 3*d
        scene = case.write_scene(f"ball_{method}_{across}", {
            "domain": {"min": [-edge, -edge, -3*d], "max": [edge, edge, DEEP + 0.08]}, "spacing": d, "end_time": 0.15,
            "method": method, "implicit_viscosity": True,
            "fluids": [{"name": "oil", "density": 1400, "viscosity": 100, "fill": [{"vessel": "tube", "level": DEEP}]}],
            "bodies": [{"name": "tube", "vessel": True, "friction": "no-slip",
                        "cylinder": {"start": [0, 0, 0], "end": [0, 0, DEEP + 0.06], "radius": TUBE}},
                       {"name": "ball", "sphere": {"radius": RADIUS}, "translation": [0, 0, 0.62*DEEP], "density": 7800,
                        "dynamics": "free", "friction": "no-slip"}],
            "output": {"interval": 0.05, "fields": ["velocity"]}})
        out = case.run(f"ball_{method}_{across}_out", scene=scene)
        bodies = read_table(out/"bodies.csv")
        sinks = -[v for name, v in zip(bodies["name"], bodies["velocity_z"]) if name == "ball"][-1]/(STOKES*BOHLIN)
        name = f"{method}, implicit: ball, {across} across"
        case.figure(f"{name}: velocity over theory", sinks, "1 within 0.05", abs(sinks - 1) <= 0.05)
        case.state(f"{name}: steps", read_table(out/"history.csv")["step"][-1])
        case.hold(f"{name}: within 25 % ({sinks:.3f})", abs(sinks - 1) <= 0.25)

if not case.smoke:
    for method in ("dfsph", "isph"):
        scene = case.write_scene(f"sheet_{method}", {
            "dimension": 2, "domain": {"min": [-0.15, 0], "max": [0.15, 0.27], "walls": {"y": ["no-slip", "slip"]}},
            "spacing": 0.002, "end_time": 2.5, "method": method, "implicit_viscosity": True,
            "fluids": [{"name": "honey", "density": 1400, "viscosity": 30}],
            "inlets": [{"name": "slit", "centre": [0, 0.25], "normal": [0, -1], "width": 0.02, "speed": 0.3}],
            "output": {"interval": 0.02, "fields": ["velocity"]}})
        out = case.run(f"sheet_{method}_out", scene=scene, may_fail=True)
        case.figure(f"{method}: the sheet runs to its end", int(bool(out)), "1", bool(out))
        if not out:
            continue
        # the middle of the sheet a tenth of the height above the heap swings to both sides
        place = []
        for _, path in read_series(out):
            points = read_vtu(path)["Points"]
            x, y = points[0::3], points[1::3]
            heap = [b for a, b in zip(x, y) if abs(a) > 0.02]
            if heap:
                level = max(heap) + 0.01
                near = [a for a, b in zip(x, y) if abs(b - level) < 0.005]
                if near:
                    place.append(mean(near))
        swing = (max(place) - min(place))/0.02 if place else 0
        case.figure(f"{method}: the foot of the sheet swings, over its width at the slit", swing, ">= 0.3", swing >= 0.3)

case.plot("Kinetic energy over that of the first peak", "t, s", "1", curves)
case.finish()
