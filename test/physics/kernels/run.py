#!/usr/bin/python3
"""The kernels' integrals, and kernels against oracles."""
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case

case = Case("kernels", "Kernels")

N = 5, 10, 15, 20, 25
TABLE = {"cubic spline": dict(zip(N, (1.00527, 1.00011, 0.999972, 1, 1))),
         "quintic spline": dict(zip(N, (0.999206, 1.00005, 0.999999, 1, 1)))}
sums = re.findall(r"((?:wendland|cubic|quartic|quintic) \w+) +([23])-D N = *([0-9]+): ([0-9.]+)", case.unit("test_smoothing"))
case.hold("six kernels, two dimensions, five lattices", len(sums) == 60)
curves = {}
for kernel, dimension, n, value in sums:
    text, off = f"{kernel}, {dimension}-D, N = {n}: integral", float(value) - 1
    curves.setdefault(f"{kernel}, {dimension}-D", []).append((float(n), float(value)))
    if kernel in TABLE and dimension == "3":
        published = TABLE[kernel][int(n)]
        case.figure(text, value, f"{published:g} within 6e-6", abs(float(value) - published) <= 6e-6)
    elif n == "25":
        case.figure(text, value, "1 within 1e-5", abs(off) <= 1e-5)
    else:
        case.state(text, value)
passed = case.unit("test_sph_oracle")
for name in "kernels_follow_the_equations", "instruction_sets_give_the_same_bits", "pressure_keeps_momentum":
    case.figure(name.replace("_", " "), "passed" if f"OK ] {name}" in passed else "failed", "passed", f"OK ] {name}" in passed)
case.plot("Integral over the support", "intervals across", "1", [(name, *zip(*points), False) for name, points in curves.items()])
case.finish()
