"""Period of a standing wave from its kinetic energy, and that of theory (run.py says which)."""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import mean

L, H, G, RHO, A = 1.0, 0.5, 9.81, 1000, 0.03
K = 2*math.pi/L
OMEGA = math.sqrt(G*K*math.tanh(K*H))


def leftover(times, energy, omega):
    """Mean square that the fit leaves, by Gram-Schmidt."""
    wave = [math.cos(2*omega*t) for t in times]
    basis = [[1.0]*len(times), times, [t*t for t in times], wave, [t*c for t, c in zip(times, wave)],
             [math.sin(2*omega*t) for t in times]]
    rest, done = energy, []
    for own in basis:
        for other in done:
            share = sum(a*b for a, b in zip(own, other))
            own = [a - share*b for a, b in zip(own, other)]
        size = math.sqrt(sum(a*a for a in own))
        done.append([a/size for a in own])
        share = sum(a*b for a, b in zip(rest, done[-1]))
        rest = [r - share*a for r, a in zip(rest, done[-1])]
    return mean([r*r for r in rest])


def find_omega(times, energy):
    """The best of 0.9 to 1.1 of theory, then thirds of what lies beside it."""
    step = 0.0025*OMEGA
    best = min((0.9*OMEGA + step*k for k in range(81)), key=lambda w: leftover(times, energy, w))
    low, high = best - step, best + step
    while high - low > 1e-6*OMEGA:
        a, b = low + (high - low)/3, high - (high - low)/3
        low, high = (low, b) if leftover(times, energy, a) < leftover(times, energy, b) else (a, high)
    return (low + high)/2


def period(energy):
    """T/T0 of theory."""
    a2, s4 = 8*mean(energy)/(RHO*G*L), math.tanh(K*H)**2
    return 1/(1 + K*K*a2/64*(9/s4**2 - 12/s4 - 3 - 2*s4))
