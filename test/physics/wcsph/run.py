#!/usr/bin/python3
"""The weakly compressible method: speed of sound, a tank at rest, momentum."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import ROOT, Case, mean, read_table

case = Case("wcsph", "Weakly compressible SPH")

G, RHO, B, GAMMA = 9.81, 1000, 50000, 7
SOUND = (GAMMA*B/RHO)**0.5

d, depth = case.pick(0.008, 0.002), 0.16
out = case.run("column", "--spacing", d, "--until", 2.6*4*depth/SOUND)
table = read_table(out/"history.csv")
time, ratio = table["time"], table["wall_force_ratio"]
crossings = [a + (b - a)*(1 - x)/(y - x) for a, b, x, y in zip(time, time[1:], ratio, ratio[1:]) if (x - 1)*(y - 1) < 0]
period = (crossings[4] - crossings[0])/2
error = period*SOUND/(4*depth) - 1
case.figure("column: period of the floor's force against 4 H/c, error", error, "within 0.03", abs(error) <= 0.03)
case.plot("Column, floor force / weight", "t, s", "1", [("wcsph", time, ratio, False)])

tank = ROOT/"test/physics/hydrostatic/scene.json"
size = ["--spacing", 0.008, "--until", 0.6, "--set", "domain.max=[0.16, 0.08, 0.16]",
        "--set", "fluids[0].fill[0].box.max=[0.16, 0.08, 0.08]"]
if not case.smoke:
    size = ["--spacing", 0.008, "--until", 2]
out = case.run("tank", *size, "--set", "method=wcsph", scene=tank)
table = read_table(out/"history.csv")
start = case.pick(0.2, 1)
late = [r for t, r in zip(table["time"], table["wall_force_ratio"]) if t > start]
deviation, average = max(abs(r - 1) for r in late), mean(late) - 1
case.figure(f"tank: wall force against weight, largest deviation after {start} s", deviation, "<= 0.03", deviation <= 0.03)
case.figure("same, mean", average, "within 0.02", abs(average) <= 0.02)
energy = table["kinetic_energy"][-1]/table["potential_energy"][-1]
case.figure("tank: kinetic over potential energy at the end", energy, "< 1e-3", energy < 1e-3)
rise = table["potential_energy"][-1]/table["potential_energy"][0] - 1
case.figure("tank: rise of the centre of mass over its height", rise, "within 0.08", abs(rise) <= 0.08)

out = case.run("box", "--until", 0.02, "--set", "method=wcsph", "--set", "output.interval=0.00002",
               scene=ROOT/"test/physics/momentum/scene.json")
table = read_table(out/"history.csv")
time, weight = table["time"], table["weight"]
steps = [b - a for a, b in zip(time, time[1:])]
scale = sum(max(f, w)*dt for f, w, dt in zip(table["force_sum"][1:], weight[1:], steps))
worst = 0
for axis in "xyz":
    p, impulse = table[f"momentum_{axis}"], 0.0
    for i, dt in enumerate(steps, 1):
        impulse += (-table[f"wall_force_{axis}"][i] - (weight[i] if axis == "z" else 0))*dt
        worst = max(worst, abs(p[i] - p[0] - impulse)/scale)
case.hold("every step of the box is an output", int(table["step"][-1]) == len(time) - 1)
case.figure("box: change of momentum minus impulse over the sum of abs(F) dt", worst, "<= 1e-6", worst <= 1e-6)

# 20 layers: the surface of the column lies within half a spacing, 2.5 %.
case.hold("period of sound within 5 %", abs(error) <= 0.05)
# With still water nothing rings (without it the weight was 5 % off, the energy 3e-5).
case.hold("walls carry the weight within 1 %", deviation <= 0.01)
case.hold("and within 0.5 % on average", abs(average) <= 0.005)
case.hold("kinetic energy below 1e-5 of potential", energy < 1e-5)
case.hold("centre of mass within 3 % of its height", abs(rise) <= 0.03)
case.hold("momentum within 1e-5 (history.csv carries 9 digits, pair sums are float)", worst <= 1e-5)
case.finish()
