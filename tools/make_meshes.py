#!/usr/bin/env python3
"""Makes the project's own meshes as OBJ files: those of the scenes and the test solids.

usage: make_meshes.py [--root DIR]                 writes the committed set below DIR (the repository)
       make_meshes.py SHAPE FILE [key=value]...    writes one shape; the sizes are the keys

shapes and keys (metres):
  fish
  box       x=1 y=1 z=1 edge=0.25                        centred at the origin
  sphere    radius=0.5 level=3                           20 * 4^level triangles
  cylinder  radius=0.5 length=1 sides=48 edge=0.25       axis z, centred
  torus     major=0.35 minor=0.15 sides=48 tube=24       axis z
  wedge     x=1 y=0.5 z=0.5                              right-angled ramp rising to +x, corner at the origin
  apple     radius=0.04 height=0.072 stem=0.0015 sides=36   axis z, stands on z = -0.035; the stem is a tube
                                                         that is open at its upper end
  blade     length=0.24 height=0.1 thickness=0.003 bevel=0.008 x=0   edge along y, cuts towards -z; the
                                                         origin is the middle of its back, or x away from it
  wire      radius=0.0005 length=0.2 sides=16            axis y, centred
  carrot    radius=0.016 tip=0.007 length=0.15 sides=32  axis x, thinner towards +x, centred
  eel       length=1 depth=0.04 pieces=100               for 2-D: a prism along z, nose at the origin, tail at +x
  glass     bottom=0.026 top=0.032 height=0.1 sides=40   axis z, stands on z = 0; the inner surface alone, open

Every mesh but the apple and the glass is one closed surface; triangles counter-clockwise seen from outside.
"""
import math
import os
import sys


class Mesh:
    """Vertices and triangles; a vertex asked for twice is made once."""

    def __init__(self):
        self.vertices, self.triangles, self.known = [], [], {}

    def vertex(self, x, y, z):
        p = (round(x, 9) + 0.0, round(y, 9) + 0.0, round(z, 9) + 0.0)
        if p not in self.known:
            self.known[p] = len(self.vertices)
            self.vertices.append(p)
        return self.known[p]

    def triangle(self, a, b, c):
        if a != b and b != c and c != a:
            self.triangles.append((a, b, c))

    def quad(self, a, b, c, d):
        """Two triangles, cut along the shorter diagonal."""
        v = self.vertices
        if math.dist(v[a], v[c]) <= math.dist(v[b], v[d]):
            self.triangle(a, b, c)
            self.triangle(a, c, d)
        else:
            self.triangle(a, b, d)
            self.triangle(b, c, d)

    def mirrored(self):
        """This half (y >= 0) together with its mirror image; they share the vertices at y = 0."""
        whole = Mesh()
        for side in (1, -1):
            ids = [whole.vertex(x, side * y, z) for x, y, z in self.vertices]
            for a, b, c in self.triangles:
                whole.triangle(*(ids[i] for i in ((a, b, c) if side > 0 else (a, c, b))))
        return whole

    def write(self, path, title):
        os.makedirs(os.path.dirname(os.path.abspath(path)), exist_ok=True)
        with open(path, "w", encoding="ascii") as f:
            f.write(f"# {title}, made by tools/make_meshes.py\n")
            f.writelines("v %.9g %.9g %.9g\n" % p for p in self.vertices)
            f.writelines("f %d %d %d\n" % (a + 1, b + 1, c + 1) for a, b, c in self.triangles)


# --- solids -----------------------------------------------------------------------------------------

def box(x=1.0, y=1.0, z=1.0, edge=0.25):
    mesh, size = Mesh(), (x, y, z)
    n = [max(1, round(s / edge)) for s in size]
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for side in (0, 1):
            def corner(i, j):
                p = [0.0, 0.0, 0.0]
                p[axis] = size[axis] * (side - 0.5)
                p[u], p[v] = size[u] * (i / n[u] - 0.5), size[v] * (j / n[v] - 0.5)
                return mesh.vertex(*p)
            for i in range(n[u]):
                for j in range(n[v]):
                    ring = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)]
                    mesh.quad(*(ring if side else ring[::-1]))
    return mesh


def sphere(radius=0.5, level=3):
    """An icosahedron whose triangles are quartered and pushed out to the sphere."""
    g = (1 + math.sqrt(5)) / 2
    points = [(-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g),
              (0, -1, -g), (0, 1, -g), (g, 0, -1), (g, 0, 1), (-g, 0, -1), (-g, 0, 1)]
    faces = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2),
             (10, 7, 6), (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5),
             (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1)]
    mesh = Mesh()

    def push(p):
        s = radius / math.hypot(*p)
        return tuple(s * c for c in p)

    triangles = [tuple(push(points[i]) for i in f) for f in faces]
    for _ in range(int(level)):
        finer = []
        for a, b, c in triangles:
            ab, bc, ca = (push(tuple(p + q for p, q in zip(*e))) for e in ((a, b), (b, c), (c, a)))
            finer += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        triangles = finer
    for t in triangles:
        mesh.triangle(*(mesh.vertex(*p) for p in t))
    return mesh


def cylinder(radius=0.5, length=1.0, sides=48, edge=0.25):
    mesh, sides = Mesh(), int(sides)
    layers, rings = max(1, round(length / edge)), max(1, round(radius / edge))

    def point(i, r, z):
        angle = 2 * math.pi * (i % sides) / sides
        return mesh.vertex(r * math.cos(angle), r * math.sin(angle), z)

    for i in range(sides):
        for k in range(layers):
            z0, z1 = (length * (m / layers - 0.5) for m in (k, k + 1))
            mesh.quad(point(i, radius, z0), point(i + 1, radius, z0),
                      point(i + 1, radius, z1), point(i, radius, z1))
        for k in range(rings):
            r0, r1 = radius * k / rings, radius * (k + 1) / rings
            for z, turn in ((length / 2, 1), (-length / 2, -1)):
                ring = [point(i, r0, z), point(i, r1, z), point(i + 1, r1, z), point(i + 1, r0, z)]
                mesh.quad(*ring[::turn])
    return mesh


def torus(major=0.35, minor=0.15, sides=48, tube=24):
    mesh, sides, tube = Mesh(), int(sides), int(tube)

    def point(i, j):
        a, b = 2 * math.pi * (i % sides) / sides, 2 * math.pi * (j % tube) / tube
        r = major + minor * math.cos(b)
        return mesh.vertex(r * math.cos(a), r * math.sin(a), minor * math.sin(b))

    for i in range(sides):
        for j in range(tube):
            mesh.quad(point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1))
    return mesh


def wedge(x=1.0, y=0.5, z=0.5):
    mesh = Mesh()
    a, b, c = ((mesh.vertex(px, 0, pz), mesh.vertex(px, y, pz)) for px, pz in ((0, 0), (x, 0), (x, z)))
    mesh.triangle(a[0], b[0], c[0])
    mesh.triangle(a[1], c[1], b[1])
    mesh.quad(a[0], a[1], b[1], b[0])
    mesh.quad(b[0], b[1], c[1], c[0])
    mesh.quad(c[0], c[1], a[1], a[0])
    return mesh


def revolve(rings, sides, mesh):
    """A surface of revolution about z through rings (r, z) from below upwards; r = 0 is a point."""
    def point(i, r, z):
        angle = 2 * math.pi * (i % sides) / sides
        return mesh.vertex(r * math.cos(angle), r * math.sin(angle), z)

    for (r0, z0), (r1, z1) in zip(rings, rings[1:]):
        for i in range(sides):
            mesh.quad(point(i, r0, z0), point(i + 1, r0, z0), point(i + 1, r1, z1), point(i, r1, z1))


def apple(radius=0.04, height=0.072, stem=0.0015, sides=36):
    """Dimples at both ends; where the upper one is as narrow as the stem, a tube goes up from it."""
    mesh, sides, half = Mesh(), int(sides), height / 2
    rings = []
    for k in range(45):
        angle = math.pi * (k / 44 - 0.5)                  # from the bottom up
        top, bottom = math.pi / 2 - angle, math.pi / 2 + angle
        z = half * math.sin(angle) - 0.4 * half * math.exp(-(top / 0.36) ** 2) \
            + 0.22 * half * math.exp(-(bottom / 0.3) ** 2)
        rings.append((radius * math.cos(angle) * (1 + 0.07 * math.sin(angle)) / 1.0024, z))
    rings[0] = (0.0, rings[0][1])
    foot = min(z for _, z in rings) + 0.035
    rings = [(r, z - foot) for r, z in rings if r > 1.3 * stem or z < 0]
    start = rings[-1][1]
    rings += [(stem * (1 + 0.3 * k / 6), start + 0.3 * height * k / 6) for k in range(7)]
    revolve(rings, sides, mesh)
    return mesh


def blade(length=0.24, height=0.1, thickness=0.003, bevel=0.008, x=0.0):
    """A prism along y: a plate that narrows to its edge over the bevel; a wedge if that is all of it."""
    mesh, t = Mesh(), thickness / 2
    section = [(0, -height), (t, bevel - height), (t, 0), (-t, 0), (-t, bevel - height)]
    if bevel >= height:
        section = [(0, -height), (t, 0), (-t, 0)]
    front, back = ([mesh.vertex(px + x, s * length / 2, pz) for px, pz in section] for s in (-1, 1))
    n = len(section)
    for i in range(n):
        mesh.quad(front[i], back[i], back[(i + 1) % n], front[(i + 1) % n])
    for i in range(1, n - 1):
        mesh.triangle(front[0], front[i], front[i + 1])
        mesh.triangle(back[0], back[i + 1], back[i])
    return mesh


def wire(radius=0.0005, length=0.2, sides=16):
    mesh, upright = Mesh(), cylinder(radius, length, sides, length)
    ids = [mesh.vertex(x, -z, y) for x, y, z in upright.vertices]
    for t in upright.triangles:
        mesh.triangle(*(ids[i] for i in t))
    return mesh


def carrot(radius=0.016, tip=0.007, length=0.15, sides=32):
    """Rounded at both ends; its thickness falls evenly in between."""
    upright, mesh, rings = Mesh(), Mesh(), []
    for end, r, angles in ((0, radius, range(-6, 1)), (1, tip, range(0, 7))):
        for k in angles:
            angle = math.pi * k / 12
            rings.append((r * math.cos(angle), length * (end - 0.5) + r * (math.sin(angle) - 2 * end + 1)))
    rings[0], rings[-1] = (0.0, rings[0][1]), (0.0, rings[-1][1])
    revolve(rings, int(sides), upright)
    ids = [mesh.vertex(z, y, -x) for x, y, z in upright.vertices]
    for t in upright.triangles:
        mesh.triangle(*(ids[i] for i in t))
    return mesh


def eel(length=1.0, depth=0.04, pieces=100):
    """Half widths of Kern & Koumoutsakos (2006); linear from the head to the tail."""
    head, tail, thin, mesh, pieces = 0.04, 0.95, 0.01, Mesh(), int(pieces)

    def half_width(s):
        if s < head:
            return math.sqrt(max(2 * head * s - s * s, 0))
        return head - (head - thin) * (s - head) / (tail - head) if s < tail else thin * (1 - s) / (1 - tail)

    stations = [head * (1 - math.cos(0.5 * math.pi * k / 8)) for k in range(8)]
    stations += [head + (1 - head) * k / pieces for k in range(pieces + 1)]
    ring = [[[mesh.vertex(length * s, side * length * half_width(s), z) for z in (-depth / 2, depth / 2)]
             for side in (-1, 1)] for s in stations]
    for (right, left), (right2, left2) in zip(ring, ring[1:]):
        mesh.quad(right[0], right2[0], right2[1], right[1])
        mesh.quad(left[0], left[1], left2[1], left2[0])
        mesh.quad(right[0], left[0], left2[0], right2[0])
        mesh.quad(right[1], right2[1], left2[1], left[1])
    return mesh


# --- the flying fish --------------------------------------------------------------------------------
# Lengths in millimetres here. Rings of points at stations along x make the body and the tail fin; the
# wings grow out of the quads of the body's flat side strip, so that everything is one surface.

# station, back, belly, half width, height of the wing line
BODY = [
    (-99.5, 1.6, -2.0, 1.3, -0.2), (-98.0, 3.7, -4.2, 3.3, -0.1), (-95.0, 6.0, -6.4, 5.3, 0.2),
    (-90.0, 8.5, -8.8, 7.3, 0.8), (-82.0, 11.2, -11.5, 9.0, 1.8), (-72.0, 13.3, -13.7, 9.8, 2.7),
    (-62.0, 14.5, -14.8, 10.0, 3.0), (-50.0, 15.0, -15.0, 10.0, 3.0), (-36.0, 14.8, -14.9, 10.0, 3.0),
    (-18.0, 13.6, -14.0, 10.0, 3.0), (0.0, 11.4, -12.3, 9.0, 2.6), (20.0, 8.6, -9.6, 6.9, 1.8),
    (40.0, 5.8, -6.6, 4.4, 0.8), (54.0, 4.3, -4.7, 2.9, 0.2), (62.0, 4.0, -4.2, 2.3, 0.0),
]
# middle of the station, upper and lower tip of the tail fin at it, half width, how far the tips trail
FIN = [
    (65.0, 5.0, -5.4, 2.1, 0.6), (68.0, 7.4, -8.2, 2.0, 1.4), (71.0, 10.6, -12.0, 2.0, 2.7),
    (74.0, 14.0, -16.2, 2.0, 4.3), (77.0, 17.4, -20.6, 2.0, 6.1), (80.0, 20.4, -24.6, 2.0, 8.0),
    (83.0, 22.9, -28.0, 2.0, 9.7), (85.8, 24.6, -30.3, 2.0, 11.0), (87.6, 25.5, -31.4, 1.9, 11.7),
    (88.6, 26.0, -32.0, 1.2, 11.4),
]
LEAD, CHORD, SPAN, WIDTH = -60.0, 40.0, 100.0, 10.0       # wing: leading edge, chord, half span, root
STRIP = 2.0                                               # half thickness of the wing
LOWER, UPPER = 6, 5                                       # rows of quads below and above the strip


def interpolate(table, x, column):
    """Monotone cubic interpolation (Fritsch & Carlson 1980) of a column of a table."""
    xs, ys = [r[0] for r in table], [r[column] for r in table]
    slopes = [(b - a) / (q - p) for p, q, a, b in zip(xs, xs[1:], ys, ys[1:])]
    tangents = [slopes[0]] + [0 if s * t <= 0 else 2 * s * t / (s + t) for s, t in zip(slopes, slopes[1:])]
    tangents.append(slopes[-1])
    i = max(0, min(len(xs) - 2, next((k for k, p in enumerate(xs) if p > x), len(xs)) - 1))
    h = xs[i + 1] - xs[i]
    t = (x - xs[i]) / h
    return ((1 + 2 * t) * (1 - t) ** 2 * ys[i] + t * (1 - t) ** 2 * h * tangents[i]
            + t * t * (3 - 2 * t) * ys[i + 1] + t * t * (t - 1) * h * tangents[i + 1])


def chord_stations():
    """x and half thickness along the wing root: a blunt round nose, a thinner rounded end."""
    inner = [(LEAD + 3.0 + 2.5 * k, STRIP) for k in range(14)]
    rear = [(LEAD + CHORD - 2.0, 1.75), (LEAD + CHORD - 0.2, 1.0)]
    return [(LEAD + 0.2, 0.9), (LEAD + 1.2, 1.65)] + inner + rear


def body_stations():
    """x and half height of the side strip at every ring of the body."""
    nose = [-99.5, -98.6, -97.2, -95.2, -92.8, -90.1] + [-87.2 + 3.0 * k for k in range(9)]
    rear = [-20.0 + 2.93 * k for k in range(1, 29)]

    def quarter(x):
        return 0.25 * (interpolate(BODY, x, 1) - interpolate(BODY, x, 4))

    result = [(x, min(STRIP, quarter(x))) for x in nose]
    result[-1] = (-63.2, 1.3)
    result += chord_stations()
    for k, x in enumerate(rear):
        result.append((x, min(1.1 + 0.3 * k, STRIP, quarter(x))))
    return result


def side_points(back, belly, half_width, line, strip, power, flat):
    """(y, z) from the belly up to the back: an arc of a superellipse, the flat strip around the wing
    line, another arc. flat = 1 spaces the points evenly in z (tail fin), 0 in angle (body)."""
    def arc(rows, edge, end):
        points = []
        for i in range(rows + 1):
            s = (1 - flat) * math.sin(0.5 * math.pi * i / rows) + flat * i / rows
            points.append((half_width * max(0.0, 1 - s ** power) ** (1 / power), edge + s * (end - edge)))
        points[-1] = (0.0, end)
        return points
    return arc(LOWER, line - strip, belly)[::-1] + [(half_width, line)] + arc(UPPER, line + strip, back)


def fish_rings():
    """Points (x, y, z) of every ring from nose to tail, belly to back on the side y >= 0."""
    rings = []
    for x, strip in body_stations():
        top, bottom, width, line = (interpolate(BODY, x, c) for c in (1, 2, 3, 4))
        even = max(0.0, min(1.0, (-96.0 - x) / 2.0))      # no crowded points on the small rings of the nose
        rings.append([(x, y, z) for y, z in side_points(top, bottom, width, line, strip, 2.2, even)])
    for x in [65.0 + 2.1 * k for k in range(11)] + [87.6, 88.6]:
        top, bottom, width, trail = (interpolate(FIN, x, c) for c in (1, 2, 3, 4))
        grown = (x - 65.0) / 3.0        # from a round section to a flat one
        even = min(1.0, 0.3 + 0.2 * grown)
        points = side_points(top, bottom, width, 0.0, 0.12 * top, 2.5 + 0.5 * grown, even)
        rings.append([(x + trail * abs(z / (top if z > 0 else bottom)) ** 1.4, y, z) for y, z in points])
    return rings


def close_end(half, ring, ids, bulge, outward):
    """Closes the body at its first or last ring by a strip to the middle plane, a little rounded."""
    middle = [half.vertex(min(0.1, x / 1000 + (bulge if 0 < j < len(ring) - 1 else 0)), 0, z / 1000)
              for j, (x, _, z) in enumerate(ring)]
    for j in range(len(ring) - 1):
        quad = [ids[j], ids[j + 1], middle[j + 1], middle[j]]
        half.quad(*(quad if outward > 0 else quad[::-1]))


def wing_outline(s):
    """Leading edge and chord at the share s of the wing's length."""
    chord = CHORD * (1 - 0.72 * s ** 2.6)
    return LEAD + 0.5 * (CHORD - chord), chord


def add_wing(half, rings, first, row):
    """Grows the wing out of the strip rows row .. row + 2 of the rings from first on."""
    stations = chord_stations()
    last = len(stations) - 1
    line = rings[first][row + 1][2]
    spans = [WIDTH + (SPAN - WIDTH) * k / 30 for k in range(30)] + [SPAN - 0.9, SPAN]

    def section(y):
        """Lower points, nose, upper points and rear of the wing at y, in a ring."""
        s = (y - WIDTH) / (SPAN - WIDTH)
        lead, chord = wing_outline(s)
        thin = 1 if y < SPAN - 1 else 0.8 if y < SPAN else 0.45
        def at(k, sign):
            x, t = stations[k]
            x = lead + (x - LEAD) * chord / CHORD
            return half.vertex(x / 1000, y / 1000, (line + sign * t * thin) / 1000)
        nose = half.vertex(lead / 1000, y / 1000, line / 1000)
        rear = half.vertex((lead + chord) / 1000, y / 1000, line / 1000)
        lower, upper = ([at(k, sign) for k in range(last + 1)] for sign in (-1, 1))
        return lower + [rear] + upper[::-1] + [nose]

    loops = [section(y) for y in spans]
    for inner, outer in zip(loops, loops[1:]):
        for i in range(len(inner)):
            j = (i + 1) % len(inner)
            half.quad(inner[i], outer[i], outer[j], inner[j])
    tip, n = loops[-1], len(loops[-1])
    for k in range(last):
        half.quad(tip[k], tip[n - 2 - k], tip[n - 3 - k], tip[k + 1])
    half.triangle(tip[0], tip[n - 1], tip[n - 2])
    half.triangle(tip[last], tip[last + 2], tip[last + 1])


def fish():
    half, rings = Mesh(), fish_rings()
    first = next(i for i, r in enumerate(rings) if r[0][0] == chord_stations()[0][0])
    last = first + len(chord_stations()) - 1
    row = LOWER
    # the ends of the strip's middle row reach out to the very leading and trailing edge
    rings[first][row + 1] = (LEAD, WIDTH, rings[first][row + 1][2])
    rings[last][row + 1] = (LEAD + CHORD, WIDTH, rings[last][row + 1][2])
    ids = [[half.vertex(*(c / 1000 for c in p)) for p in ring] for ring in rings]
    for i in range(len(rings) - 1):
        for j in range(len(rings[i]) - 1):
            if first <= i < last and row <= j < row + 2:
                continue
            half.quad(ids[i][j], ids[i][j + 1], ids[i + 1][j + 1], ids[i + 1][j])
    close_end(half, rings[0], ids[0], -0.0005, -1)
    close_end(half, rings[-1], ids[-1], 0.0004, 1)
    add_wing(half, rings, first, row)
    return half.mirrored()


def glass(bottom=0.026, top=0.032, height=0.1, sides=40, layers=12, rings=5):
    mesh, sides = Mesh(), int(sides)

    def point(i, r, z):
        angle = 2 * math.pi * (i % sides) / sides
        return mesh.vertex(r * math.cos(angle), r * math.sin(angle), z)

    for i in range(sides):
        for k in range(layers):
            z0, z1 = (height * m / layers for m in (k, k + 1))
            r0, r1 = (bottom + (top - bottom) * m / layers for m in (k, k + 1))
            mesh.quad(point(i, r0, z0), point(i + 1, r0, z0), point(i + 1, r1, z1), point(i, r1, z1))
        for k in range(rings):
            r0, r1 = bottom * k / rings, bottom * (k + 1) / rings
            mesh.quad(point(i, r0, 0), point(i + 1, r0, 0), point(i + 1, r1, 0), point(i, r1, 0))
    return mesh


SHAPES = {"fish": fish, "box": box, "sphere": sphere, "cylinder": cylinder, "torus": torus, "wedge": wedge,
          "apple": apple, "blade": blade, "wire": wire, "carrot": carrot,
          "glass": glass, "eel": eel}

# file below scenes: shape, its keys, title
OF_SCENES = {
    "flying_fish/meshes/fish.obj": ("fish", {}, "flying fish, 0.2 m"),
    "apple_cut/meshes/apple.obj": ("apple", {}, "apple, 0.08 m, open at the end of its stem"),
    "apple_cut/meshes/blade.obj": ("blade", {}, "blade, 240 x 100 x 3 mm"),
    "apple_cut_seed/apple.obj": ("apple", {}, "apple, 0.08 m, open at the end of its stem"),
    "apple_cut_seed/knife2.obj": ("blade", {"x": -0.1}, "blade, 240 x 100 x 3 mm, 0.1 m beside its origin"),
    "wedge_split/meshes/wedge.obj": ("blade", {"length": 0.1, "height": 0.1, "thickness": 0.03, "bevel": 0.1},
                                     "wedge, 100 x 100 x 30 mm"),
    "cheese_wire/meshes/wire.obj": ("wire", {}, "wire, 200 mm, 1 mm across"),
    "carrot/meshes/carrot.obj": ("carrot", {}, "carrot, 0.15 m"),
    "eel/meshes/eel.obj": ("eel", {}, "eel for 2-D scenes, 1 m"),
    "hose_glass/meshes/glass.obj": ("glass", {}, "inner surface of a glass, 0.1 m high"),
}


def main(arguments):
    if not arguments or arguments[0] == "--root":
        here = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
        root = arguments[1] if len(arguments) > 1 else here
        for file, (shape, keys, title) in OF_SCENES.items():
            SHAPES[shape](**keys).write(os.path.join(root, "scenes", file), title)
        for name in ("box", "sphere", "cylinder", "torus", "wedge"):
            SHAPES[name]().write(os.path.join(root, "test/meshes", name + ".obj"), name)
        return 0
    if len(arguments) < 2 or arguments[0] not in SHAPES:
        sys.stderr.write(__doc__)
        return 2
    try:
        sizes = {k: float(v) for k, v in (a.split("=") for a in arguments[2:])}
        SHAPES[arguments[0]](**sizes).write(arguments[1], arguments[0])
    except (TypeError, ValueError) as error:
        sys.stderr.write(f"make_meshes.py: {error}\n")
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
