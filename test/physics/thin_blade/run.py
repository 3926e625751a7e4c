#!/usr/bin/python3
"""A blade thinner than a cell parts a block at every place in the grid."""
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case

DENSITY, WIDTH, SPEED, TIME, SPACING = 800, 30.5e-3, 0.2, 2e-3, 0.6/256

case = Case("thin_blade", "A thin blade at every place in the grid")

LINE = (r"blade (\d) mm, ([\d.]+) cells into the grid: (\d+) pieces, (\d+) fragments, (\d+) on the wrong side, "
        r"([-+\de.]+) of the speed lost in pulling, overlap ([\d.]+) mm")
found = re.findall(LINE, case.unit("test_cut", "3d", *case.pick(["2"], [])))
case.hold("every blade was driven", len(found) == case.pick(4, 16))
for thickness, place, pieces, fragments, wrong, lost, overlap in found:
    text = f"{thickness} mm, {place} cells into the grid"
    stress = DENSITY*WIDTH*SPEED*float(lost)/TIME
    case.figure(f"{text}: pieces, fragments", f"{pieces}, {fragments}", "2, 0", (pieces, fragments) == ("2", "0"))
    case.figure(f"{text}: particles on the wrong side", int(wrong), "0", wrong == "0")
    case.figure(f"{text}: stress in pulling, Pa", stress, "<= 1", stress <= 1)
    case.figure(f"{text}: overlap in colliding, spacings", float(overlap)*1e-3/SPACING, "<= 0.25", float(overlap)*1e-3 <= 0.25*SPACING)
    case.hold(f"{text}: two pieces, none on the wrong side, no force", pieces == "2" and wrong == "0" and stress <= 1)
case.finish()
