#!/usr/bin/python3
"""A cylinder in a channel with an inlet and an outlet: the benchmark of Schaefer and Turek, by isph."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, mean, read_table

case = Case("channel_cylinder", "A cylinder in a channel")

RHO, MU, D, HEIGHT, LENGTH = 1000, 1.0, 0.1, 0.41, 2.2


def run(label, speed, across, end):
    scene = case.write_scene(label, {
        "method": "isph", "dimension": 2, "gravity": [0, 0], "spacing": D/across, "end_time": end,
        "domain": {"min": [-D, 0], "max": [LENGTH + D, HEIGHT], "walls": {"y": "no-slip"}},
        "fluids": [{"name": "liquid", "density": RHO, "viscosity": MU,
                    "fill": [{"box": {"min": [-D, 0], "max": [LENGTH + D, HEIGHT]}}]}],
        "bodies": [{"name": "cylinder", "sphere": {"centre": [0.2, 0.2], "radius": D/2}, "friction": "no-slip"}],
        "inlets": [{"name": "in", "centre": [0, HEIGHT/2], "normal": [1, 0], "width": HEIGHT, "speed": speed,
                    "profile": "parabolic", "ramp": 0.5}],
        "outlets": [{"name": "out", "centre": [LENGTH, HEIGHT/2], "normal": [1, 0], "width": HEIGHT}],
        "output": {"interval": 0.02, "surfaces": False, "fields": ["velocity"]}})
    out = case.run(label, scene=scene)
    bodies, history = read_table(out / "bodies.csv"), read_table(out / "history.csv")
    scale = 2/(RHO*speed*speed*D)
    drag, lift = ([scale*(p + v) for p, v in zip(bodies[f"mean_pressure_force_{a}"], bodies[f"mean_viscous_force_{a}"])]
                  for a in "xy")
    held = history["mass_held"]
    change = max(abs(m - held[-1]) for m in held[len(held)//2:])/held[-1]
    return bodies["time"], drag, lift, change


def count_frequency(times, lift):
    """Zero crossings upwards, over the time from the first to the last."""
    middle = mean(lift)
    ups = [t for t, a, b in zip(times[1:], lift, lift[1:]) if a < middle <= b]
    return (len(ups) - 1)/(ups[-1] - ups[0]) if len(ups) > 2 else 0


steady, shed = [], []
for across, end in case.pick([(6, 1.5)], [(10, 4), (14, 4), (20, 4)]):
    name = f"Re 20, {across} across"
    times, drag, lift, change = run(f"steady_{across}", 0.2, across, end)
    last = -len(drag)//4
    found = mean(drag[last:])
    case.figure(f"{name}: drag coefficient over 5.5795", found/5.5795, "1 within 0.03", abs(found/5.5795 - 1) <= 0.03)
    case.state(f"{name}: lift coefficient (0.0106)", mean(lift[last:]))
    case.figure(f"{name}: change of what the channel holds", change, "<= 0.005", change <= 0.005)
    # 5.9 seen at 10 across
    case.hold(f"{name}: drag coefficient {found:.2f}, within 30 % of 5.58", abs(found/5.5795 - 1) < 0.3)
    steady.append((name, times, drag, False))

if not case.smoke:
    name = "Re 100, 10 across"
    times, drag, lift, change = run("shed_10", 1, 10, 9)
    late = [k for k, t in enumerate(times) if t > 6]
    most, rise = max(drag[k] for k in late), max(lift[k] for k in late)
    number = count_frequency([times[k] for k in late], [lift[k] for k in late])*D/1
    case.figure(f"{name}: largest drag coefficient over 3.23", most/3.23, "1 within 0.05", abs(most/3.23 - 1) <= 0.05)
    case.figure(f"{name}: largest lift coefficient over 1.00", rise, "1 within 0.1", abs(rise - 1) <= 0.1)
    case.figure(f"{name}: Strouhal number over 0.3", number/0.3, "1 within 0.03", abs(number/0.3 - 1) <= 0.03)
    case.figure(f"{name}: change of what the channel holds", change, "<= 0.005", change <= 0.005)
    shed.append((f"{name}: drag", times, drag, False))
    shed.append((f"{name}: lift", times, lift, False))
case.plot("Drag and lift coefficients", "t, s", "1", steady + shed)
case.finish()
