#!/usr/bin/python3
"""Hinged bodies in water: a gate that holds water back, and a pendulum with its added mass."""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, mean, read_table

METHODS = ("dfsph", "isph", "wcsph")
case = Case("hinges", "Hinged bodies in water")

G, RHO = 9.81, 1000
H, DEPTH, EDGE, THICK, STIFF = 0.26, 0.2, 0.003, 0.02, 20000
R, L, SQUARE, AMPLITUDE, HEAVY = 0.05, 0.15, 0.8, math.radians(10), 3


def water(method, width, height, spacing, end, filled, bodies, interval):
    return {"dimension": 2, "method": method, "domain": {"min": [0, 0], "max": [width, height]}, "spacing": spacing,
            "end_time": end, "gravity": [0, -G],
            "fluids": [{"name": "water", "density": RHO, "viscosity": 0, "fill": [{"box": {"min": [0, 0], "max": filled}}]}],
            "bodies": bodies, "output": {"interval": interval, "surfaces": False, "fields": ["velocity"]}}


def hold_gate(method, layers):
    at, end = 0.3, 0.6
    gate = {"name": "gate", "box": {"min": [at, EDGE], "max": [at + THICK, H]}, "dynamics": "free", "density": 500,
            "hinge": {"point": [at + THICK/2, H], "stiffness": STIFF, "damping": 200}}
    label = f"gate_{method}_{layers}"
    content = water(method, 0.5, 0.3, DEPTH/layers, end, [at, DEPTH], [gate], 0.01)
    table = read_table(case.run(label, scene=case.write_scene(label, content))/"bodies.csv")
    turn = [2*math.atan2(z, w) for z, w in zip(table["orientation_z"], table["orientation_w"])]
    angle = mean([q for t, q in zip(table["time"], turn) if t > end/2])
    weight = 500*THICK*(H - EDGE)*G*(H - EDGE)/2*math.sin(angle)
    moment = RHO*G*(DEPTH*H*(DEPTH - EDGE) - (DEPTH + H)*(DEPTH**2 - EDGE**2)/2 + (DEPTH**3 - EDGE**3)/3)
    off = (STIFF*angle + weight)/moment - 1
    case.figure(f"gate, {method}, {layers} layers: moment, deviation", off, "within 0.01", abs(off) <= 0.01)


def swing(method, across):
    middle, top = SQUARE/2, SQUARE/2 + L
    bob = {"name": "bob", "sphere": {"centre": [middle + L*math.sin(AMPLITUDE), top - L*math.cos(AMPLITUDE)], "radius": R},
           "dynamics": "free", "density": HEAVY*RHO, "hinge": {"point": [middle, top]}}
    label = f"pendulum_{method}_{across}"
    content = water(method, SQUARE, SQUARE, 2*R/across, 0.95, [SQUARE, SQUARE], [bob], 0.005)
    table = read_table(case.run(label, scene=case.write_scene(label, content))/"bodies.csv")
    times = table["time"]
    angles = [math.atan2(x - middle, top - y) for x, y in zip(table["position_x"], table["position_y"])]
    zeros = [t + (u - t)*a/(a - b) for t, u, a, b in zip(times, times[1:], angles, angles[1:]) if a*b < 0]
    added = (SQUARE**2/4 + R**2)/(SQUARE**2/4 - R**2)
    rate = math.sqrt((HEAVY - 1)*G/L/(HEAVY*(1 + R**2/(2*L**2)) + added))
    off = (zeros[1] - zeros[0])/(math.pi/rate*(1 + AMPLITUDE**2/16)) - 1
    label = f"pendulum, {method}, {across} across"
    case.figure(f"{label}: half a period, deviation", off, "within 0.02", abs(off) <= 0.02)
    lost = 1 + min(angles)/AMPLITUDE
    case.figure(f"{label}: amplitude lost in the first half swing", lost, "<= 0.05", lost <= 0.05)
    arms = [math.hypot(x - middle, top - y) for x, y in zip(table["position_x"], table["position_y"])]
    case.hold(f"{label}: the arm keeps its length", max(abs(a - L) for a in arms) < 1e-8)
    return label, times, angles


for method in METHODS:
    for layers in case.pick((20,), (20, 40)):
        hold_gate(method, layers)
curves = [swing(method, across) + (False,) for method in case.pick(("dfsph", "isph"), METHODS)
          for across in case.pick((10,), (10, 20))]
case.plot("Pendulum in water", "t, s", "angle, rad", curves)
case.finish()
