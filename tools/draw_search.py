#!/usr/bin/python3
"""Draws the files of `tobiuo inspect` seen along z, as SVG: draw_search.py DIR PICTURE.svg [REACH]

REACH: how far around the particle, in support radii (3). Needs VTK for Python (Debian: python3-vtk9).
"""
import csv
import sys

import vtk
from vtk.util.numpy_support import vtk_to_numpy

SIZE = 640
SETS = [("all", "#bbbbbb", "particle"), ("inCell", "#56B4E9", "in the cells searched"),
        ("inSphere", "#D55E00", "within the support"), ("center", "#000000", "the particle")]


def read(path):
    reader = vtk.vtkXMLPolyDataReader()
    reader.SetFileName(path)
    reader.Update()
    return reader.GetOutput()


def points(data):
    return vtk_to_numpy(data.GetPoints().GetData())


def draw(folder, reach):
    with open(f"{folder}/kernel_curves.csv", newline="") as file:
        support = float(list(csv.DictReader(file))[-1]["r"])
    centre = points(read(f"{folder}/center.vtp"))[0]
    cells = read(f"{folder}/each_cell_position.vtp")
    layer = abs(points(cells)[:, 2] - centre[2])
    scale = SIZE / (2 * reach * support)

    def place(x):
        return (x[0] - centre[0]) * scale + SIZE / 2, SIZE / 2 - (x[1] - centre[1]) * scale

    yield f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {SIZE} {SIZE + 30}" font-family="sans-serif" font-size="13">'
    yield f'<rect width="{SIZE}" height="{SIZE + 30}" fill="white"/>'
    middles = points(cells)[layer == layer.min()]
    searched = vtk_to_numpy(cells.GetPointData().GetArray("searched"))[layer == layer.min()]
    width = [min(b - a for a, b in zip(u, u[1:])) for u in (sorted(set(middles[:, a])) for a in (0, 1))]
    for x, inside in zip(middles, searched):
        left, top = place((x[0] - width[0] / 2, x[1] + width[1] / 2))
        yield (f'<rect x="{left:.1f}" y="{top:.1f}" width="{width[0] * scale:.1f}" height="{width[1] * scale:.1f}" '
               f'fill="{"#eef6fc" if inside else "none"}" stroke="#999999"/>')
    for name, colour, _ in SETS:
        for x in points(read(f"{folder}/{name}.vtp")):
            a, b = place(x)
            if 0 < a < SIZE and 0 < b < SIZE:
                yield f'<circle cx="{a:.1f}" cy="{b:.1f}" r="5" fill="{colour}"/>'
    yield f'<circle cx="{SIZE / 2}" cy="{SIZE / 2}" r="{support * scale:.1f}" fill="none" stroke="#D55E00" stroke-width="2"/>'
    yield f'<rect y="{SIZE}" width="{SIZE}" height="30" fill="white"/>'
    for k, (_, colour, text) in enumerate(SETS):
        yield f'<circle cx="{12 + 165 * k}" cy="{SIZE + 15}" r="5" fill="{colour}"/>'
        yield f'<text x="{21 + 165 * k}" y="{SIZE + 20}">{text}</text>'
    yield "</svg>"


if len(sys.argv) not in (3, 4):
    sys.exit(__doc__)
with open(sys.argv[2], "w", encoding="utf-8") as picture:
    picture.write("\n".join(draw(sys.argv[1], float(sys.argv[3]) if len(sys.argv) > 3 else 3.0)) + "\n")
