#!/usr/bin/python3
"""Decay of the Taylor-Green vortex in two dimensions."""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, fit_line, read_series, read_table, read_vtu

case = Case("taylor_green", "Taylor-Green vortex", methods=("isph",))

L, U, RHO = 1.0, 1.0, 1000
NU = U*L/100
K = 2*math.pi/L
RATE = 4*NU*K*K


def field(x, y, t):
    fade = U*math.exp(-2*NU*K*K*t)
    return fade*math.sin(K*x)*math.cos(K*y), -fade*math.cos(K*x)*math.sin(K*y)


def compute(n, *options):
    name = f"vortex{n}" + "".join(o.replace("=", "_") for o in options)
    more = ("isph.viscosity_form=full",) if ISPH else ()
    out = case.run(name, "--spacing", L/n, *(w for o in options + more for w in ("--set", o)))
    history = read_table(out / "history.csv")
    data = read_vtu(read_series(out)[len(history["time"])//2][1])
    time = history["time"][len(history["time"])//2]
    total = 0.0
    for x, y, u, v in zip(data["Points"][0::3], data["Points"][1::3], data["velocity"][0::3], data["velocity"][1::3]):
        a, b = field(x, y, time)
        total += (u - a)**2 + (v - b)**2
    count = len(data["Points"])//3
    case.hold(f"{n} across: {count} particles placed", count == n*n)
    return history, math.sqrt(total/count)/(U*math.exp(-2*NU*K*K*time)), time


ISPH = case.args.method == "isph"
SIZES = ((25, ()), (50, ()), (100, ()), (50, ("isph.time_order=1",))) if ISPH \
    else ((24, ()), (40, ()), (64, ()), (40, ("cfl=0.1",)))
rates, spreads, curves = {}, {}, []
for n, options in case.pick(((32, ()),), SIZES):
    history, spread, time = compute(n, *options)
    which = f"{n} across" + "".join(", " + o.replace("=", " ") for o in options)
    times, energy = history["time"], history["kinetic_energy"]
    start = RHO*L*L*U*U/4
    case.figure(f"{which}: kinetic energy at the start against rho U^2 L^2 / 4", energy[0]/start - 1, "within 0.01",
                abs(energy[0]/start - 1) <= 0.01)
    rate = -fit_line(times, [math.log(e) for e in energy])[0]
    rates[which], spreads[which] = abs(rate/RATE - 1), spread
    case.figure(f"{which}: decay rate {rate:.4f} 1/s against {RATE:.4f}, deviation", rate/RATE - 1, "within 0.02",
                abs(rate/RATE - 1) <= 0.02)
    case.figure(f"{which}: velocity error at {time:.2f} s", spread, "<= 0.02", spread <= 0.02)
    curves.append((which, times, [e/start for e in energy], True))
if ISPH and not case.smoke:
    for coarse, fine in (25, 50), (50, 100):
        order = math.log(spreads[f"{coarse} across"]/spreads[f"{fine} across"])/math.log(fine/coarse)
        case.figure(f"order of convergence of the velocity, {coarse} to {fine} across", order, ">= 1.8", order >= 1.8)
    case.figure("100 across: velocity error", spreads["100 across"], "<= 0.005", spreads["100 across"] <= 0.005)
elif not case.smoke:
    for coarse, fine in (24, 40), (40, 64):
        for what, of in ("rate", rates), ("velocity", spreads):
            case.state(f"order of convergence of the {what}, {coarse} to {fine} across",
                       math.log(of[f"{coarse} across"]/of[f"{fine} across"])/math.log(fine/coarse))
# The rate is a goal above, met or missed. What must hold at smoke size, with 0.009 and 0.016 seen (0.044 and 0.038 without eq. (10d),
# 0.2 without (7c), 0.8 with a void taken for a free surface): no energy from nothing, and momentum, zero by symmetry, within 1e-5 of
# sum |m v| (about rho U L^2/2) in float sums.
drift = max(max(map(abs, history[f"momentum_{a}"])) for a in "xy")/(RHO*U*L*L/2)
# The difference form of isph keeps momentum up to the disorder of the particles.
case.hold(f"momentum stays zero ({drift:.1e})", drift <= (1e-3 if ISPH else 1e-5))
case.hold(f"decay rate within 3 % ({rate/RATE - 1:.3f})", abs(rate/RATE - 1) <= 0.03)
case.hold(f"velocity error at most 0.03 ({spread:.3f})", spread <= 0.03)
case.hold("energy never above that of the start", max(history["kinetic_energy"][1:]) <= history["kinetic_energy"][0])
case.plot("Kinetic energy", "t, s", "E / E(0)", [("analytic", times, [math.exp(-RATE*t) for t in times], False)] + curves)
case.finish()
