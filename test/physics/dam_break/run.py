#!/usr/bin/python3
"""The front of a breaking dam against potential flow, Martin & Moyce (1952) and Koshizuka & Oka (1996)."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import potential
from harness import Case, fit_line, interpolate, mean, read_series, read_table, read_vtu

case = Case("dam_break", "Dam break")

G = 9.81
ACROSS = case.pick(16, 40)
# Some values of the publications, for machines without the reference data: (T, Z).
EXPERIMENTS = [
    ("Martin & Moyce n2=1", 0.05715, 1, "dambreak/martin_moyce1952_n2_1_front.csv", "T",
     [(0.97, 1.67), (1.29, 2.11), (1.62, 2.56), (1.76, 2.78)]),
    ("Martin & Moyce n2=2, a = 57 mm", 0.05715, 2, "dambreak/martin_moyce1952_n2_2_a2.25in_front.csv", "T2",
     [(1.997, 2.292), (2.547, 2.995), (3.345, 4.134), (4.034, 4.944), (4.418, 5.881)]),
    ("Martin & Moyce n2=2, a = 29 mm", 0.028575, 2, "dambreak/martin_moyce1952_n2_2_a1.125in_front.csv", "T2",
     [(2.283, 2.689), (2.95, 3.728), (3.598, 4.528), (3.905, 4.999), (4.592, 5.841)]),
    ("Koshizuka & Oka", 0.146, 2, "dambreak/koshizuka_oka1996_exp_front_pysph.csv", "T2",
     [(1.935, 2.241), (2.323, 2.615), (2.719, 3.003), (3.096, 3.624)]),
]
if not case.smoke and not case.reference_file(EXPERIMENTS[0][3]):
    print("dam_break: no reference data found (--reference); using the few values quoted in run.py")


REAL = ["--set", "fluids[0].surface_tension=0.0728", "--set", "dfsph.support=2.5"]
IDEAL = ["--set", "fluids[0].viscosity=0", "--set", 'domain.walls.x="slip"', "--set", 'domain.walls.y="slip"']


def compute_front(name, a, n2, across, water):
    """T and Z of the front, and the history."""
    end = (case.pick(4.6, 5.5) if n2 == 2 else case.pick(2.4, 3.5))/(n2*G/a)**0.5
    out = case.run(name, "--spacing", repr(a/across), "--until", f"{end:.4f}", "--set", f"output.interval={end/50:.6f}",
                   "--set", f"domain.max=[{10.5*a}, {4.4*a}]", "--set", f"fluids[0].fill[0].box.max=[{a}, {n2*a}]", *water)
    times, fronts = [], []
    for time, path in read_series(out):
        times.append(time*(n2*G/a)**0.5)
        fronts.append(max(read_vtu(path)["Points"][0::3])/a + 0.5/across)
    return times, fronts, read_table(out / "history.csv")


def judge(label, times, fronts, points, low, high):
    """Slope and lag against (T, Z) of `points` between low and high."""
    high = min(high, max(fronts), max(z for _, z in points))
    reference = [(t, z) for t, z in points if low <= z <= high]
    expected = fit_line(*zip(*reference))[0]
    slope = fit_line(*zip(*[(t, z) for t, z in zip(times, fronts) if low <= z <= high]))[0]
    deviation = slope/expected - 1
    case.figure(f"{label}: slope dZ/dT over {low:.2f} < Z < {high:.2f}, {slope:.3f} against {expected:.3f}, deviation",
                deviation, "within 0.05", abs(deviation) <= 0.05)
    lag = mean([interpolate(fronts, times, z) - t for t, z in reference])
    case.figure(f"{label}: lag in T", lag, "within 0.15", abs(lag) <= 0.15)
    return deviation, lag


def potential_flow(n2):
    table = read_table(pathlib.Path(__file__).with_name("potential.csv"))
    return [(t, z) for n, t, z in zip(table["n2"], table["T"], table["Z"]) if n == n2]


def compare_with_potential_flow(n2):
    points = potential_flow(n2)
    curves = [("potential flow", *zip(*points), False)]
    for across in case.pick([16], [40, 80]):
        times, fronts, _ = compute_front(f"ideal{n2}_{across}", 0.05715, n2, across, IDEAL)
        deviation, lag = judge(f"potential flow, n2={n2}, a / d = {across}", times, fronts, points, *((2, 6) if n2 == 2 else (1.11, 5)))
        # Seen at 16 across: 8 and 5 %, 0.09 and 0.06.
        case.hold(f"potential flow, n2={n2}: slope within 10 %, lag within 0.15", abs(deviation) <= 0.1 and abs(lag) <= 0.15)
        curves.append((f"tobiuo, a / d = {across}", times, fronts, False))
    case.plot(f"Front, no viscosity, slip, n2={n2}", "T", "Z", curves)


def hold_table():
    """potential.csv is what potential.py computes."""
    points = potential_flow(2)
    *_, (t, z) = potential.front(2, 40, 2.0)
    off = t - interpolate([z for _, z in points], [t for t, _ in points], z)
    # A tenth of the goal for the lag; 40 elements instead of 160 make 0.009.
    case.hold("potential.py with 40 elements: T at Z = 2 within 0.015 of the table", abs(off) <= 0.015)


def state_potential_flow(label, n2, points, low, high):
    """What slope and lag would be for potential flow."""
    exact, reference = potential_flow(n2), [(t, z) for t, z in points if low <= z <= high]
    slope = fit_line(*zip(*[(t, z) for t, z in exact if low <= z <= max(z for _, z in reference)]))[0]
    case.state(f"{label}: slope of potential flow, deviation", slope/fit_line(*zip(*reference))[0] - 1)
    times, fronts = zip(*[(0.0, 1.0), *exact])
    case.state(f"{label}: lag of potential flow in T", mean([interpolate(fronts, times, z) - t for t, z in reference]))


def compare(label, a, n2, file, column, quoted):
    times, fronts, history = compute_front(f"column{n2}_{1000*a:.0f}", a, n2, ACROSS, REAL)
    path = case.reference_file(file)
    points = list(zip(*[read_table(path)[c] for c in (column, "Z")])) if path else quoted
    low, high = (2, 6) if n2 == 2 else (min(z for _, z in points), max(z for _, z in points))
    deviation, lag = judge(label, times, fronts, points, low, high)
    state_potential_flow(label, n2, points, low, high)
    t, z = next((t, z) for t, z in points if z >= 1.1)
    first = interpolate(fronts, times, z) - t
    case.state(f"{label}: lag at the first point, Z = {z}", first)
    case.state(f"{label}: lag since then", lag - first)
    # Experiments scatter by 15 % among themselves (compare the two columns of Martin & Moyce); a front
    # outside 25 % is not a dam break.
    case.hold(f"{label}: slope within 25 %", abs(deviation) <= 0.25)
    total = [k + p for k, p in zip(history["kinetic_energy"], history["potential_energy"])]
    gain = max(total[1:])/total[0] - 1
    case.figure(f"{label}: largest energy against the start", gain, "<= 0.01", gain <= 0.01)
    case.figure(f"{label}: particles lost", int(history["particles_lost"][-1]), "0", history["particles_lost"][-1] == 0)
    # Energy may not appear; 5 % is what a column of 16 particles may gain by rearranging at its free surface.
    case.hold(f"{label}: no energy from nothing (5 %)", gain <= 0.05)
    case.hold(f"{label}: the front only advances", all(b >= a - 0.1 for a, b in zip(fronts, fronts[1:])))
    case.plot(f"Front, {label}", "T", "Z", [(f"tobiuo, a / d = {ACROSS}", times, fronts, False),
                                            ("experiment", *zip(*points), True), ("potential flow", *zip(*potential_flow(n2)), False)])


def strike_walls():
    a, across = 0.05715, case.pick(20, 40)
    out = case.run("walls", "--spacing", repr(a/across), "--until", "1.2", "--set", "output.interval=0.001", "--set",
                   f"domain.max=[{8*a}, {3*a}]", "--set", f"fluids[0].fill[0].box.max=[{a}, {2*a}]")
    history = read_table(out / "history.csv")
    total = [k + p for k, p in zip(history["kinetic_energy"], history["potential_energy"])]
    gained = sum(max(0, later - now) for now, later in zip(total, total[1:]))/total[0]
    case.figure("against a wall: energy gained over the energy at the start", gained, "<= 0.01", gained <= 0.01)
    case.state("against a wall: fastest particle over sqrt(4 g a)", max(history["speed_max"])/(4*G*a)**0.5)
    case.hold("against a wall: no energy from nothing (1 %)", gained <= 0.01)


hold_table()
for ratio in (1, 2):
    compare_with_potential_flow(ratio)
for row in EXPERIMENTS:
    compare(*row)
strike_walls()
case.finish()
