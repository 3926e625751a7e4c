#!/usr/bin/python3
"""Levels and wall pressures of a dam break against Lobovsky et al. (2014)."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, interpolate, read_table

case = Case("lobovsky", "Dam break with sensors (Lobovsky)", methods=("isph",))

H, G = 0.3, 9.81
TO_T = (G/H)**0.5
# Read off the published signals with the definitions above.
ARRIVAL = {"H2": 1.115, "H3": 1.744, "H4": 2.278}
LEVELS = {"H1": [(2, 0.782), (3, 0.630), (4, 0.500), (5, 0.402), (6, 0.324)],
          "H2": [(2, 0.214), (3, 0.262), (4, 0.291), (5, 0.294), (6, 0.270)],
          "H3": [(2, 0.150), (3, 0.173), (4, 0.225), (5, 0.241), (6, 0.237)],
          "H4": [(3, 0.135), (4, 0.157), (5, 0.213)]}
IMPULSE = {"P1": 2.333, "P2": 2.146, "P3": 1.916, "P4": 1.135}
GAUGE = {"H1": 0.3, "H2": 0.865, "H3": 1.114, "H4": 1.3625}       # x, m
HEIGHT = {"P1": 0.003, "P2": 0.015, "P3": 0.03, "P4": 0.08}        # z, m
IMPACT = 2.46       # T at which P2 first passes 0.2


def integral(ts, ps, begin, end):
    return sum((ps[k] + ps[k + 1])/2*(ts[k + 1] - ts[k]) for k in range(len(ts) - 1) if begin <= ts[k] < end)


spacing = case.pick(0.03, 0.0075)
out = case.run("tank", "--spacing", spacing)
table = read_table(out / "probes.csv")
T = [t*TO_T for t in table["time"]]
for name, expected in ARRIVAL.items():
    arrival = next((t for t, h in zip(T, table[f"{name}_level"]) if h > max(0.02, 1.2*spacing)), 99)
    case.figure(f"{name}: arrival, T = {arrival:.3f} against {expected:.3f}, deviation", arrival/expected - 1,
                "within 0.05", abs(arrival/expected - 1) <= 0.05)
    case.hold(f"{name}: the wave arrives within 25 % of the time", abs(arrival/expected - 1) <= 0.25)
for name, points in LEVELS.items():
    ours = [interpolate(T, table[f"{name}_level"], t)/H for t, _ in points]
    error = sum(abs(a - b) for a, (_, b) in zip(ours, points))/len(points)
    case.figure(f"{name}: mean deviation of the level over H", error, "<= 0.05", error <= 0.05)
    case.plot(f"Level {name}", "T", "h / H", [("tobiuo", T, [h/H for h in table[f"{name}_level"]], False),
                                             ("Lobovsky et al. 2014", *map(list, zip(*points)), True)])
impact = next((t for t, p in zip(T, table["P2_pressure"]) if p > 0.2*1000*G*H), 99)
case.figure(f"impact, T = {impact:.3f} against {IMPACT:.3f}, deviation", impact/IMPACT - 1, "within 0.05",
            abs(impact/IMPACT - 1) <= 0.05)
for name, expected in IMPULSE.items():
    signal = [p/(1000*G*H) for p in table[f"{name}_pressure"]]
    value = integral(T, signal, impact + 2.3 - IMPACT, impact + 5 - IMPACT)
    text = f"{name}: impulse {value:.3f} against {expected:.3f}, deviation"
    if name == "P1":
        case.state(text, value/expected - 1)
    else:
        case.figure(text, value/expected - 1, "within 0.15", abs(value/expected - 1) <= 0.15)
    case.plot(f"Pressure {name}", "T", "p / rho g H", [("tobiuo", T, signal, False)] +
              case.measured("Lobovsky et al. 2014", "dambreak/lobovsky2014_H300_pressure.csv", "T", name))
    # The water's momentum is turned at this wall: half or double its impulse would be another physics.
    case.hold(f"{name}: impulse between half and double", 0.5 < value/expected < 2)
# --- in 2-D: the side of the tank, y up ----------------------------------------------------------------------


def run_flat(label, spacing, gate=0):
    """T, levels at the gauges and pressures over rho g H; gate: speed at which it is lifted, m/s."""
    scene = {
        "dimension": 2, "domain": {"min": [0, 0], "max": [1.61, 0.6 + gate], "walls": {"x": "no-slip", "y": "no-slip"}}, "gravity": [0, -G],
        "spacing": spacing, "end_time": 0.95,
        "fluids": [{"name": "water", "density": 1000, "viscosity": 1e-3, "fill": [{"box": {"min": [0, 0], "max": [0.6, H]}}]}],
        "probes": [{"name": name, "position": [1.61, z, 0]} for name, z in HEIGHT.items()] +
                  [{"name": name, "kind": "level", "position": [x, 0, 0]} for name, x in GAUGE.items()],
        "output": {"interval": 0.05, "fields": ["velocity"]}}
    if gate:
        scene["bodies"] = [{"name": "gate", "box": {"min": [0.6, 0, -0.1], "max": [0.61, 0.35, 0.1]},
                            "motion": {"translation": {"velocity": [0, gate, 0]}}}]
    table = read_table(case.run(label, scene=case.write_scene(label, scene)) / "probes.csv")
    return ([t*TO_T for t in table["time"]], {name: table[f"{name}_level"] for name in GAUGE},
            {name: [p/(1000*G*H) for p in table[f"{name}_pressure"]] for name in HEIGHT})


def impulse_of(T, signals, name):
    impact = next((t for t, p in zip(T, signals["P2"]) if p > 0.2), 99)
    return impact, integral(T, signals[name], impact + 2.3 - IMPACT, impact + 5 - IMPACT)


T, levels, signals = run_flat("flat", case.pick(0.01, 0.005))
impact = impulse_of(T, signals, "P2")[0]
case.figure(f"2-D: impact, T = {impact:.3f} against {IMPACT:.3f}, deviation", impact/IMPACT - 1, "within 0.05", abs(impact/IMPACT - 1) <= 0.05)
for name in ("P1", "P2"):
    value = impulse_of(T, signals, name)[1]
    case.figure(f"2-D, {name}: impulse {value:.3f} against {IMPULSE[name]:.3f}, deviation", value/IMPULSE[name] - 1, "within 0.15",
                abs(value/IMPULSE[name] - 1) <= 0.15)
    case.hold(f"2-D, {name}: impulse between half and double", 0.5 < value/IMPULSE[name] < 2)
    case.plot(f"Pressure {name}, 2-D", "T", "p / rho g H", [("tobiuo", T, signals[name], False)] +
              case.measured("Lobovsky et al. 2014", "dambreak/lobovsky2014_H300_pressure.csv", "T", name))
for gate in case.pick((), (0, 3)):
    T, levels, signals = run_flat(f"flat_fine_{gate}", 0.0025, gate)
    text = f"2-D, 2.5 mm, {f'gate lifted at {gate} m/s' if gate else 'no gate'}"
    for name, expected in ARRIVAL.items():
        arrival = next((t for t, h in zip(T, levels[name]) if h > 0.02), 99)
        case.state(f"{text}, {name}: arrival, T = {arrival:.3f} against {expected:.3f}, deviation", arrival/expected - 1)
    for name, expected in IMPULSE.items():
        impact, value = impulse_of(T, signals, name)
        case.state(f"{text}, {name}: impulse {value:.3f} against {expected:.3f}, deviation", value/expected - 1)
    case.state(f"{text}: impact, T = {impact:.3f} against {IMPACT:.3f}, deviation", impact/IMPACT - 1)
case.finish()
