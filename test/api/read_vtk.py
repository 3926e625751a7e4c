#!/usr/bin/python3
"""Reads VTU, VTP, VTI, STL and PVD files with VTK's own readers and compares them with what was written.

    read_vtk.py CHECKS.json        a list of {"file": ..., expected values}; paths relative to the JSON file
    read_vtk.py FILE [key=value]   one file, values as JSON:  read_vtk.py a.vtu points=1000 'arrays={"p":1}'

Keys: points, cells (counts), cell_type (VTK number of every cell), arrays {name: components}, lacks [name],
ranges {name: [min, max]} (all components together; "Points" is the coordinates), sums {name: sum of
(row + 1) * value over all components}, connectivity (the sum over cells of cell number * point ids),
bounds [x0, x1, y0, y1, z0, z1]; for a PVD: times, parts, names, and each data set is read too
(each: keys as above, for every file of the collection).
Prints "N passed, N failed"; exit code 0 only if nothing failed; 77 if VTK is missing.
"""
import json
import math
import os
import sys
import xml.etree.ElementTree as ET

try:
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy
    import numpy
except ImportError as problem:
    print("VTK for Python is missing:", problem)
    sys.exit(77)

READERS = {".vtu": vtk.vtkXMLUnstructuredGridReader, ".vtp": vtk.vtkXMLPolyDataReader, ".stl": vtk.vtkSTLReader,
           ".vti": vtk.vtkXMLImageDataReader}
passed = failed = 0


def check(what, ok, detail=""):
    global passed, failed
    if ok:
        passed += 1
    else:
        failed += 1
        print(f"failed: {what} {detail}")


def close(a, b):
    return a == b or math.isclose(a, b, rel_tol=1e-12, abs_tol=1e-300)


def read(path):
    """The data set and the errors VTK reported while reading it."""
    errors = []
    reader = READERS[os.path.splitext(path)[1]]()
    reader.AddObserver("ErrorEvent", lambda caller, event: errors.append(event))
    log = vtk.vtkStringOutputWindow()
    vtk.vtkOutputWindow.SetInstance(log)
    reader.SetFileName(path)
    reader.Update()
    text = log.GetOutput() or ""
    if text:
        errors.append(text)
    return reader.GetOutput(), errors


def array_of(data, name):
    if name == "Points":
        return data.GetPoints().GetData() if data.GetPoints() else None
    return data.GetPointData().GetArray(name) or data.GetCellData().GetArray(name)


def weighted_sum(values):
    flat = numpy.asarray(values, dtype=numpy.float64).reshape(len(values), -1)
    return float(((numpy.arange(len(flat)) + 1.0)[:, None] * flat).sum())


def check_data(path, want):
    if not os.path.exists(path):
        check(f"{path} exists", False)
        return
    data, errors = read(path)
    check(f"{path}: no reader errors", not errors, str(errors))
    if "points" in want:
        check(f"{path}: points", data.GetNumberOfPoints() == want["points"], f"{data.GetNumberOfPoints()}")
    if "cells" in want:
        check(f"{path}: cells", data.GetNumberOfCells() == want["cells"], f"{data.GetNumberOfCells()}")
    if "cell_type" in want:
        types = {data.GetCellType(i) for i in range(data.GetNumberOfCells())}
        check(f"{path}: cell types", types <= {want["cell_type"]}, str(types))
    if "connectivity" in want:
        ids = 0
        for c in range(data.GetNumberOfCells()):
            cell = data.GetCell(c)
            ids += (c + 1) * sum(cell.GetPointId(k) for k in range(cell.GetNumberOfPoints()))
        check(f"{path}: connectivity", ids == want["connectivity"], str(ids))
    for name, components in want.get("arrays", {}).items():
        a = array_of(data, name)
        check(f"{path}: array {name}", a is not None and a.GetNumberOfComponents() == components)
    for name in want.get("lacks", []):
        check(f"{path}: no array {name}", array_of(data, name) is None)
    for name, (low, high) in want.get("ranges", {}).items():
        a = array_of(data, name)
        v = vtk_to_numpy(a) if a is not None and a.GetNumberOfTuples() else None
        check(f"{path}: range of {name}", v is not None and close(float(v.min()), low) and close(float(v.max()), high),
              "" if v is None else f"{float(v.min())!r} {float(v.max())!r}")
    for name, total in want.get("sums", {}).items():
        a = array_of(data, name)
        v = weighted_sum(vtk_to_numpy(a)) if a is not None and a.GetNumberOfTuples() else 0.0
        check(f"{path}: sum of {name}", math.isclose(v, total, rel_tol=1e-10, abs_tol=1e-12), f"{v!r} {total!r}")
    if "bounds" in want:
        got = data.GetBounds()
        check(f"{path}: bounds", all(math.isclose(a, b, rel_tol=1e-6, abs_tol=1e-9)
                                     for a, b in zip(got, want["bounds"])), str(got))


def check_collection(path, want):
    """A PVD as ParaView reads it: an XML list of files with times, every file readable."""
    try:
        sets = ET.parse(path).getroot().find("Collection").findall("DataSet")
    except (OSError, ET.ParseError, AttributeError) as problem:
        check(f"{path}: readable", False, str(problem))
        return
    for key, attribute, convert in (("times", "timestep", float), ("parts", "part", int), ("names", "name", str)):
        if key in want:
            got = [convert(s.get(attribute)) for s in sets]
            check(f"{path}: {key}", got == want[key], str(got))
    for s in sets:
        check_data(os.path.join(os.path.dirname(path), s.get("file")), want.get("each", {}))


def check_file(path, want):
    (check_collection if path.endswith(".pvd") else check_data)(path, want)


def main(arguments):
    if not arguments:
        print(__doc__)
        return 2
    if arguments[0].endswith(".json"):
        folder = os.path.dirname(os.path.abspath(arguments[0]))
        with open(arguments[0], encoding="utf-8") as stream:
            wants = json.load(stream)
        for want in wants:
            check_file(os.path.join(folder, want["file"]), want)
    else:
        pairs = (a.split("=", 1) for a in arguments[1:])
        check_file(arguments[0], {key: json.loads(value) for key, value in pairs})
    print(f"{passed} passed, {failed} failed")
    return 1 if failed or not passed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
