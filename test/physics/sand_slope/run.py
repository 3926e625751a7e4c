#!/usr/bin/python3
"""A layer of sand slides, flows and stands."""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, fit_line, mean, read_series, read_vtu

case = Case("sand_slope", "A layer of sand")

H, G, ANGLE = 0.05, 9.81, math.radians(31)


def layer(dim, cells, degrees, friction, speed=0.0, end=0.1, long=12):
    """Mean acceleration of the middle along the floor, m/s2; and its speed at the end, m/s."""
    d, length, slope, times, speeds = H/cells/2, long*H, math.radians(degrees), [], []
    low, high, width = [0, 0, 0][:dim], [2.2*length, 2*H, 8*d][:dim], [8*d]*(dim - 2)
    out = case.solids(f"{dim}d_{cells}_{degrees}deg_mu{friction}", {
        "domain": {"min": low, "max": high, "walls": {"x": "slip", "y": ["separate", "slip"], "z": "slip"}, "friction": friction},
        "gravity": [G*math.sin(slope), -G*math.cos(slope), 0][:dim], "spacing": d, "end_time": end,
        "solids": [{"name": "sand", "model": "sand", "density": 1600, "youngs_modulus": 1e6, "friction_angle": 31,
                    "fill": [{"box": {"min": [0.05*length, 0, 0][:dim], "max": [1.05*length, H, *width]},
                              "velocity": [speed, 0, 0][:dim]}]}],
        "output": {"interval": end/30}})
    middle = None
    for t, path in read_series(out):
        data = read_vtu(path)
        x, v = data["Points"][::3], dict(zip(data["particle_id"], data["velocity"][::3]))
        if middle is None:
            middle = [i for i, q in zip(data["particle_id"], x) if 0.4*length < q < 0.7*length]
        times.append(t)
        speeds.append(mean([v[i] for i in middle]))
    case.plot(f"{dim}-D, {cells} cells in H, {degrees} degrees, friction {friction}", "t, s", "speed, m/s", [
        ("middle", times, speeds, True),
        ("exact", times, [speed + t*exact(degrees, friction) for t in times], False)])
    late = [k for k, t in enumerate(times) if t >= 0.5*end]
    return fit_line([times[k] for k in late], [speeds[k] for k in late])[0], speeds[-1]


def exact(degrees, friction):
    """Acceleration of a layer that slides or flows."""
    slope, least = math.radians(degrees), min(friction, math.tan(ANGLE))
    rest = math.sin(slope) - least*math.cos(slope)
    return G*(rest if degrees == 0 or rest > 0 else 0)


for dim, cells in case.pick([(2, 4)], [(2, 4), (2, 8), (2, 16), (3, 8)]):
    slope = math.radians(40)
    found = (math.tan(slope) - layer(dim, cells, 40, 0.4, end=0.15)[0]/G/math.cos(slope))/0.4
    text = f"{dim}-D, {cells} cells in H"
    case.figure(f"{text}, smooth: friction over that of the floor", found, "within 2 % of 1", abs(found - 1) <= 0.02)
    case.hold(f"{text}: slides with the floor's friction within 2 %", abs(found - 1) <= 0.02)
    found = -layer(dim, cells, 0, 1.0, 0.7, 0.06)[0]/G/math.tan(ANGLE)
    case.figure(f"{text}, thrown: friction over tan 31", found, "within 5 % of 1", abs(found - 1) <= 0.05)
    # The band that shears is a cell or two, a third of four cells: momentum diffuses through it beside friction.
    case.hold(f"{text}: flows with the tangent of its angle within 10 %", abs(found - 1) <= 0.1)
for degrees in case.pick([29], [25, 29, 33]):
    slope = math.radians(degrees)
    acceleration, speed = layer(2, 8, degrees, 1.0, end=0.2, long=24)
    text = f"2-D, 8 cells in H, rough, {degrees} degrees: acceleration over g sin"
    value = acceleration/G/math.sin(slope)
    if degrees < 31:
        case.figure(text, value, "below 1 %", abs(value) < 0.01)
        case.hold(f"{degrees} degrees: stands", abs(value) < 0.01)
    else:
        case.state(f"{text} ({exact(degrees, 1)/G/math.sin(slope):.3f} once all of it is at its limit)", value)
case.finish()
