#!/usr/bin/python3
"""Two elastic discs collide and part."""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, read_table

case = Case("discs", "Two elastic discs")

R, SPEED, END = 0.2, 0.1, 3.2


def collide(cells, transfer):
    """Energy kept, momentum over that of one disc; the largest contact energy shows that they met."""
    d = 0.5/cells
    discs = [{"name": name, "density": 1000, "youngs_modulus": 1000, "poissons_ratio": 0.3, "fill": [
        {"sphere": {"centre": [at, at], "radius": R}, "velocity": [speed, speed]}]}
        for name, at, speed in (("low", 0.2, SPEED), ("high", 0.8, -SPEED))]
    out = case.solids(f"{transfer}_{cells}", {
        "domain": {"min": [-0.2, -0.2], "max": [1.2, 1.2]}, "spacing": d, "end_time": END, "solids": discs,
        "mlsmpm": {"transfer": transfer, **({"flip": 1} if transfer == "flip" else {})},
        "output": {"interval": 0.05}})
    h = read_table(out/"history.csv")
    total = [k + e for k, e in zip(h["kinetic_energy"], h["elastic_energy"])]
    momentum = max(abs(p) for axis in "xy" for p in h[f"momentum_{axis}"])
    if cells in (20, 80):
        case.plot(f"{transfer}, {cells} cells", "t, s", "J/m", [
            ("kinetic", h["time"], h["kinetic_energy"], False), ("elastic", h["time"], h["elastic_energy"], False),
            ("sum", h["time"], total, False)])
    lost = h["energy_lost"][-1]/total[0]
    return total[-1]/total[0], momentum/(h["kinetic_energy"][0]/SPEED/2), max(h["elastic_energy"])/total[0], lost


for transfer in ("apic", "flip"):
    losses = {}
    for cells in case.pick((20, 40, 80), (20, 40, 80, 160)):
        kept, drift, squeezed, measured = collide(cells, transfer)
        losses[cells] = 1 - kept
        seen = {"apic": {20: 74, 40: 86, 80: 94, 160: 97}, "flip": {20: 91, 40: 95, 80: 98, 160: 99}}[transfer][cells]
        text = f"{transfer}, {cells} cells"
        if transfer == "flip" and cells == 80:
            case.figure(f"{text}: energy kept", kept, ">= 0.97", kept >= 0.97)
        else:
            case.state(f"{text}: energy kept ({seen} % seen elsewhere)", kept)
        case.state(f"{text}: energy_lost of history.csv over the energy at the start", measured)
        case.figure(f"{text}: momentum over that of a disc", drift, "<= 1e-5: round-off of float", drift <= 1e-5)
        case.hold(f"{text}: they met: a fifth of the energy was elastic", squeezed > 0.2)
        # Float: 2000 steps of 6e-8, were they all of one sign, are 1.2e-4; they are not.
        case.hold(f"{text}: momentum within 1e-5", drift <= 1e-5)
        case.hold(f"{text}: no energy is made", kept <= 1.001)
        # Half of what has been seen lost elsewhere again: another code, another way of seeding.
        case.hold(f"{text}: loses at most 1.5 times what was seen elsewhere", 1 - kept <= 1.5*(1 - seen/100))
    cells = sorted(losses)
    for a, b in zip(cells, cells[1:]):
        ratio = losses[a]/losses[b]
        case.figure(f"{transfer}: loss on {a} over that on {b} cells", ratio, ">= 1.7", ratio >= 1.7)
case.finish()
