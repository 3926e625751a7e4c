#!/usr/bin/python3
"""The front of a breaking dam by potential flow: no viscosity, no walls that rub, no surface tension, no particles.

    potential.py > potential.csv

Writes T = t sqrt(n2 g / a) and Z = x / a of the foremost point of the surface of a column of width a and height n2 a, n2 = 1 and 2.
Units: a = g = 1. Only the free surface is cut into elements; the floor and the wall behind the column are planes of symmetry, so that
four images of the surface close it. Green's identity with values linear along each element gives the velocity normal to the surface
from the potential on it; points of the surface move with the water, their potential by Bernoulli, p = 0 (Longuet-Higgins & Cokelet,
Proc. R. Soc. A 350 (1976) 1, whose five-point filter is used too). The upper corner is rounded by a tenth of a.
"""
import sys

import numpy as np

ROUND = 0.1             # radius of the upper corner
FINER = 0.7             # elements are 1 + FINER times the mean at the top, 1 - FINER at the toe
EVEN, ODD = 1, -1       # symmetry of a quantity about an end of the surface


class Spline:
    """Cubic spline of f over s, even or odd about each end."""
    def __init__(self, s, f, left, right):
        h, rise = np.diff(s), np.diff(f)/np.diff(s)
        a = np.zeros((len(s), len(s)))
        b = np.zeros(len(s))
        for i in range(1, len(s) - 1):
            a[i, i - 1:i + 2] = h[i], 2*(h[i - 1] + h[i]), h[i - 1]
            b[i] = 3*(h[i]*rise[i - 1] + h[i - 1]*rise[i])
        a[0, :2], b[0] = ((1, 0), 0) if left == EVEN else ((2, 1), 3*rise[0])
        a[-1, -2:], b[-1] = ((0, 1), 0) if right == EVEN else ((1, 2), 3*rise[-1])
        self.s, self.f, self.slope = s, f, np.linalg.solve(a, b)

    def __call__(self, at):
        i = np.clip(np.searchsorted(self.s, at) - 1, 0, len(self.s) - 2)
        h = self.s[i + 1] - self.s[i]
        t = (at - self.s[i])/h
        return (self.f[i]*(1 + 2*t)*(1 - t)**2 + self.slope[i]*h*t*(1 - t)**2
                + self.f[i + 1]*t*t*(3 - 2*t) + self.slope[i + 1]*h*t*t*(t - 1))


def influence(x, y):
    """Integrals of -ln r / 2 pi and of its normal derivative over the elements and their images, seen from each point."""
    single, double = np.zeros((2, len(x), len(x)))
    for mirror in ((1, 1), (-1, 1), (1, -1), (-1, -1)):
        px, py = mirror[0]*x, mirror[1]*y
        length = np.hypot(np.diff(px), np.diff(py))
        tx, ty = np.diff(px)/length, np.diff(py)/length
        outward = mirror[0]*mirror[1]
        nx, ny = -ty*outward, tx*outward
        from_x, from_y = x[:, None] - px[:-1], y[:, None] - py[:-1]
        along, off = from_x*tx + from_y*ty, from_x*nx + from_y*ny
        a, b = -along, length - along                       # ends of the element, seen from the foot of the point
        log_a, log_b = (0.5*np.log(np.maximum(e*e + off*off, 1e-300)) for e in (a, b))
        on = np.abs(off) < 1e-13
        safe = np.where(on, 1, off)
        angle = np.where(on, 0, np.arctan(b/safe) - np.arctan(a/safe))
        s0 = b*log_b - a*log_a - (b - a) + off*angle         # integral of ln r, then of t ln r, t from the foot on
        s1 = 0.5*((b*b + off*off)*log_b - (a*a + off*off)*log_a) - 0.25*(b*b - a*a)
        d0, d1 = -angle, -off*(log_b - log_a)
        for matrix, i0, i1 in ((single, s0, s1), (double, d0, d1)):
            end = (i1 + along*i0)/length
            matrix[:, :-1] -= (i0 - end)/(2*np.pi)
            matrix[:, 1:] -= end/(2*np.pi)
    np.fill_diagonal(double, 0)
    np.fill_diagonal(double, -double.sum(1))                 # a constant potential moves nothing
    return single, double


def arc(x, y):
    return np.concatenate([[0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])


def splines(x, y, phi):
    """Of position and potential; the first point lies on the wall behind, the last on the floor."""
    s = arc(x, y)
    return s, Spline(s, x, ODD, EVEN), Spline(s, y, EVEN, ODD), Spline(s, phi, EVEN, EVEN)


def rates(x, y, phi):
    _, cx, cy, cp = splines(x, y, phi)
    stretch = np.hypot(cx.slope, cy.slope)
    tx, ty, along = cx.slope/stretch, cy.slope/stretch, cp.slope/stretch
    single, double = influence(x, y)
    outward = np.linalg.solve(single, double @ phi)
    u, v = along*tx - outward*ty, along*ty + outward*tx
    u[0] = v[-1] = 0
    return np.array([u, v, 0.5*(u*u + v*v) - y])


def column(n2, elements):
    """Points of the surface of the column at rest, from the wall behind over the rounded corner to the toe."""
    top, turn = 1 - ROUND, 0.5*np.pi*ROUND
    points = []
    for s in (top + turn + n2 - ROUND)*spread(elements):
        angle = min(max(s - top, 0), turn)/ROUND
        points.append((min(s, top) + ROUND*np.sin(angle), n2 - ROUND*(1 - np.cos(angle)) - max(s - top - turn, 0), 0))
    return np.array(points).T


def spread(elements):
    xi = np.linspace(0, 1, elements + 1)
    return xi + FINER*np.sin(np.pi*xi)/np.pi


def even_out(state):
    """Points back to their shares of the arc."""
    s, *curves = splines(*state)
    state = np.array([c(s[-1]*spread(len(s) - 1)) for c in curves])
    state[0, 0] = state[1, -1] = 0
    return state


def filtered(f, left, right):
    g = np.concatenate([left*f[2:0:-1], f, right*f[-2:-4:-1]])
    return (-g[:-4] + 4*g[1:-3] + 10*g[2:-2] + 4*g[3:-1] - g[4:])/16


def front(n2, elements, end):
    """Yields T and Z until Z reaches `end`."""
    state, time, step = column(n2, elements), 0.0, 0
    while state[0].max() < end:
        k1 = rates(*state)
        size = arc(*state[:2])[1:] - arc(*state[:2])[:-1]
        dt = min(0.01, 0.25*size.min()/max(np.hypot(*k1[:2]).max(), 1e-3), 0.15*size.min()**0.5)
        k2 = rates(*(state + dt/2*k1))
        k3 = rates(*(state + dt/2*k2))
        k4 = rates(*(state + dt*k3))
        state = even_out(state + dt/6*(k1 + 2*k2 + 2*k3 + k4))
        time, step = time + dt, step + 1
        if step % 5 == 0:
            state = np.array([filtered(f, *ends) for f, ends in zip(state, ((ODD, EVEN), (EVEN, ODD), (EVEN, EVEN)))])
        yield time*n2**0.5, state[0].max()


if __name__ == "__main__":
    elements = int(sys.argv[1]) if len(sys.argv) > 1 else 160
    print(f"# Written by potential.py {elements}; see there.")
    print("n2,T,Z")
    for n2, end in ((1, 5.2), (2, 6.2)):
        shown = 1.0
        for t, z in front(n2, elements, end):
            if z >= shown + 0.1:
                shown = z
                print(f"{n2},{t:.4f},{z:.4f}", flush=True)
