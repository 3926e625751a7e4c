#!/usr/bin/python3
"""A rigid body without forces."""
import pathlib
import re
import sys
from math import log10

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case

case = Case("top", "Free rigid body")

text = case.unit("test_rigid")
energy, momentum, length = (float(v) for v in re.search(r"energy (\S+), momentum (\S+), \|q\|\^2 - 1 (\S+)", text).groups())
case.figure("largest change of the energy, relative", energy, "<= 1e-12", energy <= 1e-12)
case.figure("change of the angular momentum, relative", momentum, "<= 1e-15", momentum <= 1e-15)
case.state("length of the quaternion squared less 1", length)
order = float(re.search(r"order ([0-9.]+)", text).group(1))
case.figure("order of the precession's phase", order, "2 within 0.1", abs(order - 2) <= 0.1)
points = [(float(n), float(e)) for n, e in re.findall(r"(\d+) steps: precession error (\S+)", text)]
case.hold("five lengths of the step", len(points) == 5)
first = points[0]
case.plot("Error of the axis after its way, of 1", "log10 of the steps", "log10 of the error",
          [("tobiuo", [log10(n) for n, _ in points], [log10(e) for _, e in points], True),
           ("second order", [log10(n) for n, _ in points], [log10(first[1]*(first[0]/n)**2) for n, _ in points], False)])
case.finish()
