#!/usr/bin/python3
"""Momentum changes by the external impulse and by nothing else."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, read_table

case = Case("momentum", "Momentum balance")

END = case.pick(0.05, 0.5)
out = case.run("box", "--until", END, *([] if case.smoke else ["--spacing", 0.004]))
history = read_table(out / "history.csv")
time, weight = history["time"], history["weight"]
steps = int(history["step"][-1])
case.hold(f"every one of the {steps} steps is an output", steps == len(time) - 1)
scale, steps_of, floor = 0.0, [b - a for a, b in zip(time, time[1:])], 0.0
for i, dt in enumerate(steps_of, 1):
    scale += max(history["force_sum"][i], weight[i])*dt
    floor += abs(history["wall_force_z"][i])*dt
case.figure("force_sum is reported: sum over particles of the force, N, last", history["force_sum"][-1],
            "more than half the weight", history["force_sum"][-1] >= 0.5*weight[-1])
errors = []
for axis in "xyz":
    p = history[f"momentum_{axis}"]
    impulse, error = 0.0, 0.0
    for i, dt in enumerate(steps_of, 1):
        impulse += (-history[f"wall_force_{axis}"][i] - (weight[i] if axis == "z" else 0))*dt
        error = max(error, abs(p[i] - p[0] - impulse))
    errors.append(error/scale)
    text = "change of momentum" if axis in "xy" else "change minus impulse of weight and walls"
    case.figure(f"{axis}: {text} over the sum of abs(F) dt", errors[-1], "<= 1e-6", errors[-1] <= 1e-6)
# history.csv carries 9 digits and the pair sums are float: 100 steps of 6e-8 each may add up to 6e-6.
case.hold("along the periodic axes, within 1e-5", max(errors[:2]) <= 1e-5)
# The walls are planes that push each particle with its own pressure: round-off as well.
case.hold("along z, within 1e-5", errors[2] <= 1e-5)
case.plot("Momentum", "t, s", "kg m/s", [(axis, time, history[f"momentum_{axis}"], False) for axis in "xyz"])
case.finish()
