#!/usr/bin/python3
"""A drop swings in a central force field: an exact flow with a free surface, for long times."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, crossings, mean, read_series, read_vtu

case = Case("central_drop", "A drop in a central force field", methods=("dfsph", "eisph", "wcsph"))

RADIUS, OMEGA = 0.5, 4.0


def solve(step=1e-4, end=8.0/OMEGA*1.9):
    """Rows (t, a, b, A)."""
    def rate(y):
        a, b, strain = y
        return strain*a, -strain*b, (strain*strain + OMEGA*OMEGA)*(b*b - a*a)/(a*a + b*b)

    def add(y, k, h):
        return tuple(p + h*q for p, q in zip(y, k))
    y, rows = (RADIUS, RADIUS, OMEGA), []
    for n in range(int(end/step) + 1):
        rows.append((n*step, *y))
        k1 = rate(y)
        k2 = rate(add(y, k1, step/2))
        k3 = rate(add(y, k2, step/2))
        k4 = rate(add(y, k3, step))
        y = tuple(v + step/6*(p + 2*q + 2*r + s) for v, p, q, r, s in zip(y, k1, k2, k3, k4))
    return rows


def measure(path):
    """Half axes, m, and energy, J/kg."""
    data = read_vtu(path)
    xs, ys = data["Points"][0::3], data["Points"][1::3]
    us, vs = data["velocity"][0::3], data["velocity"][1::3]
    squares = mean([x*x for x in xs]), mean([y*y for y in ys])
    kinetic = mean([0.5*(u*u + v*v) for u, v in zip(us, vs)])
    return 2*squares[0]**0.5, 2*squares[1]**0.5, kinetic + 0.5*OMEGA*OMEGA*sum(squares)


exact = solve()
exact_round = crossings([r[0] for r in exact], [r[1] - r[2] for r in exact])
EXACT_PERIOD, LONGEST = exact_round[-1] - exact_round[-3], max(r[1] for r in exact)
curves = [("exact", [r[0] for r in exact[::100]], [r[1] for r in exact[::100]], True)]
METHOD = case.args.method or "isph"
WIDE = ((50, "support=3"),) if METHOD in ("dfsph", "wcsph") else ()
for across, option in case.pick(((20, None),), ((25, None), (50, None), (100, None)) + WIDE):
    more = ("--set", f"{METHOD}.{option}") if option else ()
    out = case.run(f"drop_{across}" + ("_wide" if option else ""), "--spacing", 2*RADIUS/across, *more)
    times, axes = zip(*((t, measure(path)) for t, path in read_series(out)))
    length, width, energy = zip(*axes)
    name = f"{across} across" + (", support 3" if option else "")
    round_at = crossings(times, [a - b for a, b in zip(length, width)])
    case.hold(f"{name}: the drop is round again at {', '.join(f'{t:.3f}' for t in round_at)} s", len(round_at) >= 5)
    period = (round_at[-1] - round_at[-5])/2
    case.figure(f"{name}: period over the exact {EXACT_PERIOD:.4f} s", period/EXACT_PERIOD, "within 0.01",
                abs(period/EXACT_PERIOD - 1) <= 0.01)
    last = max(a for t, a in zip(times, length) if t > times[-1] - EXACT_PERIOD)
    case.figure(f"{name}: longest half axis of the last period over the exact {LONGEST:.4f} m", last/LONGEST, "within 0.03",
                abs(last/LONGEST - 1) <= 0.03)
    area = [a*b/(length[0]*width[0]) for a, b in zip(length, width)]
    swell = max(abs(a - 1) for a in area)
    case.figure(f"{name}: a b over that of the start, largest deviation", swell, "<= 0.01", swell <= 0.01)
    case.figure(f"{name}: energy over that of the start", energy[-1]/energy[0], "0.95 to 1", 0.95 <= energy[-1]/energy[0] <= 1)
    case.hold(f"{name}: period {period:.3f} s, within 3 % of {EXACT_PERIOD:.3f} s", case.args.method or abs(period/EXACT_PERIOD - 1) <= 0.03)
    curves.append((name, times, length, False))
case.plot("Half axis of the drop along x", "t, s", "a, m", curves)
case.finish()
