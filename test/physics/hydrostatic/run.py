#!/usr/bin/python3
"""A tank at rest: the walls carry the weight, the level stays, the water comes to rest."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, mean, read_series, read_table, read_vtu

case = Case("hydrostatic", "Hydrostatic tank")

G, RHO = 9.81, 1000
D = case.pick(0.008, 0.006)
SIDE = case.pick((0.16, 0.08), (0.584, 0.284))
DEPTH = case.pick(0.08, 0.182)
END = case.pick(0.8, 5.0)
options = ["--spacing", D] if not case.smoke else [
    "--spacing", D, "--until", END, "--set", f"domain.max=[{SIDE[0]}, {SIDE[1]}, {2*DEPTH}]",
    "--set", f"fluids[0].fill[0].box.max=[{SIDE[0]}, {SIDE[1]}, {DEPTH}]"]
out = case.run("tank", *options)
history = read_table(out / "history.csv")
times, ratio = history["time"], history["wall_force_ratio"]
count, mass = history["fluid_particles"][0], history["weight"][0]/G
depth = mass/(RHO*SIDE[0]*SIDE[1])      # of the particles placed: whole layers only


def find_level(points):
    """Mean over columns of the top particle's upper side."""
    top = {}
    for x, y, z in zip(points[0::3], points[1::3], points[2::3]):
        column = int(x/(2*D)), int(y/(2*D))
        top[column] = max(top.get(column, 0), z)
    return mean(list(top.values())) + D/2


late = [abs(r - 1) for t, r in zip(times, ratio) if t > 0.1]
case.figure("wall force against weight, largest deviation after 0.1 s", max(late), "<= 0.01", max(late) <= 0.01)
case.figure("same, mean over the run", mean(late), "<= 0.01", mean(late) <= 0.01)
last = [f for t, f in zip(times, history["wall_force_z"]) if t > END - 0.5]
pressure = abs(mean(last))/(SIDE[0]*SIDE[1])
deviation = abs(pressure/(RHO*G*depth) - 1)
case.figure(f"bottom pressure against rho g H = {RHO*G*depth:.1f} Pa", deviation, "<= 0.01", deviation <= 0.01)
points = read_vtu(read_series(out)[-1][1])["Points"]
shift = (2*mean(points[2::3]) - depth)/D
case.figure("level from the centre of mass, error in spacings", shift, "within 0.5", abs(shift) <= 0.5)
shift = (find_level(points) - depth)/D
case.figure("level from the top particles, error in spacings", shift, "within 0.5", abs(shift) <= 0.5)
energy = history["kinetic_energy"][-1]/history["potential_energy"][-1]
case.figure(f"kinetic over potential energy after {END:g} s", energy, "< 1e-5", energy < 1e-5)

# The goal of 1 % at every output is asked of the reference; ten layers of water carry single particles
# whose impacts are 0.5 % of the weight, so a smoke run may show 3 %. The mean has no such excuse.
case.hold("walls carry the weight within 3 % at every output after 0.1 s", max(late) <= 0.03)
case.hold("walls carry the weight within 1 % on average", mean(late) <= 0.01)
case.hold("bottom pressure within 1 %", deviation <= 0.01)
case.hold("no particle lost", history["particles_lost"][-1] == 0)
# Ten layers: one spacing is 10 % of the depth, the most that settling may change.
case.hold("level within one spacing", abs(shift) <= 1)
case.hold("kinetic energy below 0.03 % of potential", energy < 3e-4)
case.plot("Wall force / weight", "t, s", "1", [("tobiuo", times[1:], ratio[1:], False)])
case.plot("Kinetic / potential energy", "t, s", "1", [("tobiuo", times, [
    k/p for k, p in zip(history["kinetic_energy"], history["potential_energy"])], False)])
case.finish()
