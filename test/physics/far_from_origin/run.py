#!/usr/bin/python3
"""The same water at the origin and 10 km from it."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, read_series, read_table, read_vtu

case = Case("far_from_origin", "Far from the origin")

FAR = 10240.0
D = case.pick(1/128, 1/256)


def compare(label, size, fill, end):
    """Largest distance between twins at the end, in spacings, and the number of steps."""
    found = []
    for where, shift in (("here", 0.0), ("far", FAR)):
        def vector(v):
            return "[" + ", ".join(repr(x + shift) for x in v) + "]"
        out = case.run(f"{label}_{where}", "--spacing", repr(D), "--until", end,
                       "--set", "domain.min=" + vector((0, 0, 0)), "--set", "domain.max=" + vector(size),
                       "--set", "fluids[0].fill[0].box.min=" + vector((0, 0, 0)),
                       "--set", "fluids[0].fill[0].box.max=" + vector(fill))
        points = read_vtu(read_series(out)[-1][1])["Points"]
        found.append(([x - shift for x in points], read_table(out / "history.csv")))
    (a, history), (b, far) = found
    case.hold(f"{label}: as many particles at both places", len(a) == len(b))
    largest = max(sum((a[i + k] - b[i + k])**2 for k in range(3))**0.5 for i in range(0, len(a), 3))
    steps = int(history["step"][-1])
    case.plot(f"Kinetic energy, {label}", "t, s", "J", [("here", history["time"], history["kinetic_energy"], False),
                                                       ("far", far["time"], far["kinetic_energy"], True)])
    case.hold(f"{label}: as many steps at both places ({steps})", steps == int(far["step"][-1]))
    return largest/D, steps


for label, fill, end in (("tank", (0.1875, 0.125, 0.09375), case.pick(0.2, 0.5)),
                         ("dam", (0.0625, 0.125, 0.125), case.pick(0.04, 0.05))):
    distance, steps = compare(label, (0.1875, 0.125, 0.25), fill, end)
    case.figure(f"{label}: largest distance to the twin after {steps} steps, in spacings", distance,
                "<= 1e-5", distance <= 1e-5)
    # No tolerance of its own: rounding of double positions, 2e-10 d a step, leaves room for growth by 1e3.
    case.hold(f"{label}: same result within 1e-5 d", distance <= 1e-5)
case.finish()
