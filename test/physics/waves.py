"""Regular waves at gauges: their number by linear theory, amplitudes, and what goes and what comes back."""
import cmath
import math

G = 9.81


def wave_number(h, period):
    """1/m, of waves on water of depth h, m."""
    k = (2*math.pi/period)**2/G
    for _ in range(300):
        k = 0.5*k + 0.5*(2*math.pi/period)**2/G/math.tanh(k*h)
    return k


def solve(rows, right):
    """Least squares with few unknowns: normal equations by elimination."""
    n = len(rows[0])
    a = [[sum(r[i].conjugate()*r[j] for r in rows) for j in range(n)] + [sum(r[i].conjugate()*y for r, y in zip(rows, right))]
         for i in range(n)]
    for p in range(n):
        for q in range(n):
            if q != p:
                f = a[q][p]/a[p][p]
                a[q] = [x - f*y for x, y in zip(a[q], a[p])]
    return [a[p][n]/a[p][p] for p in range(n)]


def amplitude(times, level, omega):
    """Complex amplitude of the first harmonic: the mean and two harmonics are fitted."""
    rows = [[1 + 0j] + [cmath.exp(1j*s*n*omega*t) for n in (1, 2) for s in (1, -1)] for t in times]
    return 2*solve(rows, [complex(y) for y in level])[1]


def split(xs, amplitudes, k):
    """Waves that go and that come back, by the wave number near that of theory that fits best."""
    best = None
    for part in range(-40, 41):
        kk = k*(1 + 0.0025*part)
        rows = [[cmath.exp(-1j*kk*x), cmath.exp(1j*kk*x)] for x in xs]
        c = solve(rows, amplitudes)
        error = sum(abs(r[0]*c[0] + r[1]*c[1] - a)**2 for r, a in zip(rows, amplitudes))
        if best is None or error < best[0]:
            best = (error, abs(c[0]), abs(c[1]))
    return best[1:]
