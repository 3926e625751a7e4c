#!/usr/bin/env pvpython
"""Surfaces of the water and of the bodies from their particles, as pictures, with ParaView.

usage: pvpython tools/paraview_fish.py DIR [--times 0.2,0.4] [--out DIR/paraview] [--state FILE.pvsm]

The recipe, on the series that `tobiuo run` leaves in DIR:
  fluid.pvd + bodies.pvd (Append Datasets)
  -> Threshold object_id = 0 (water), object_id = 1 ... (bodies)
  -> Gaussian Resampling, 200 x 200 x 200 points over x 0.1-0.5, y 0-0.3, z 0-0.4 m
  -> Contour density = 980 kg/m3 (water), object_id = 0.95 (bodies)
Needs the Debian packages paraview and python3-paraview; without a screen also xvfb:
  xvfb-run -a pvpython tools/paraview_fish.py out/flying_fish
"""
import argparse
import json
import os
import sys
import time

from paraview import simple as pv

# ParaView's own splat, exp(-5 (r/R)^2) with R = 0.1 of the box of 0.4 m, is exp(-0.05 (r/L)^2) with
# L = 4 mm: the spacing of the water, twice that of the fish. Here L follows the spacings of the run, and
# a splat ends at REACH L, where it is 0.73: below that a contour at 0.95 or 0.98 does not change, and
# it costs 1/64 of the time. A contour below 0.73 needs a larger --reach: 10 is ParaView's own.
DECAY = 0.05
REACH = 2.5


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("dir", help="folder of a run")
    parser.add_argument("--out", help="folder of the pictures (DIR/paraview)")
    parser.add_argument("--times", default="0.2,0.4,0.6,0.8",
                        help="simulated seconds, separated by commas, or all (0.2,0.4,0.6,0.8)")
    parser.add_argument("--box", default="0.1,0.5,0,0.3,0,0.4", help="x0,x1,y0,y1,z0,z1 in m")
    parser.add_argument("--grid", type=int, default=200, help="points of the grid along each axis (200)")
    parser.add_argument("--density", type=float, default=980, help="of the water's surface, kg/m3 (980)")
    parser.add_argument("--object-id", type=float, default=0.95, help="of the bodies' surface (0.95)")
    parser.add_argument("--reach", type=float, default=REACH, help=f"where a splat ends, in its lengths ({REACH})")
    parser.add_argument("--state", help="also write a ParaView state file, for File > Load State")
    o = parser.parse_args()
    o.out = o.out or os.path.join(o.dir, "paraview")
    o.box = [float(x) for x in o.box.split(",")]
    if len(o.box) != 6:
        parser.error("--box wants six numbers")
    return o


def open_series(folder, name):
    path = os.path.join(folder, name)
    if not os.path.exists(path):
        sys.exit(f"paraview_fish: {path} is missing: is {folder} the folder of a run?")
    return pv.PVDReader(FileName=os.path.abspath(path))


def splat_lengths(folder):
    """L of the water and of the bodies, m; those of the recipe if the run does not say its spacings."""
    try:
        with open(os.path.join(folder, "resolved.json"), encoding="utf-8") as file:
            scene = json.load(file)
    except OSError:
        return 0.004, 0.004
    bodies = [b["spacing"] for b in scene["bodies"] if isinstance(b["spacing"], float)]
    return scene["spacing"], 2*min(bodies + [scene["spacing"]])


def surface(source, ids, array, value, length, o):
    """Threshold -> Gaussian Resampling -> Contour, as by hand in ParaView's menus."""
    box = max(o.box[1] - o.box[0], o.box[3] - o.box[2], o.box[5] - o.box[4])
    part = pv.Threshold(Input=source, Scalars=["POINTS", "object_id"], ThresholdMethod="Between",
                        LowerThreshold=ids[0], UpperThreshold=ids[1])
    grid = pv.GaussianResampling(Input=part, ResampleField=["POINTS", array],
                                 ResamplingGrid=[o.grid] * 3, ExtenttoResample=o.box,
                                 GaussianSplatRadius=o.reach*length/box,
                                 GaussianExponentFactor=-DECAY*o.reach**2)
    return pv.Contour(Input=grid, ContourBy=["POINTS", "SplatterValues"], Isosurfaces=[value],
                      ComputeNormals=1)


def view_of(box):
    pv._DisableFirstRenderCameraReset()
    view = pv.CreateView("RenderView")
    view.ViewSize = [1200, 800]
    view.OrientationAxesVisibility = 0
    view.UseColorPaletteForBackground = 0
    view.Background = [1, 1, 1]
    centre = [(box[0] + box[1])/2, (box[2] + box[3])/2, 0.7*box[4] + 0.3*box[5]]
    size = box[1] - box[0]
    view.CameraFocalPoint = centre
    view.CameraPosition = [centre[0] - 1.3*size, centre[1] - 2.2*size, centre[2] + 1.5*size]
    view.CameraViewUp = [0, 0, 1]
    view.CameraViewAngle = 18
    return view


def show(source, view, colour):
    display = pv.Show(source, view)
    pv.ColorBy(display, None)
    display.AmbientColor = display.DiffuseColor = colour
    display.Specular = 0.3
    return display


def chosen_times(available, text):
    if text == "all":
        return list(available)
    wanted = [float(t) for t in text.split(",")]
    return sorted({min(available, key=lambda a: abs(a - w)) for w in wanted})


def main():
    o = arguments()
    fluid, bodies = open_series(o.dir, "fluid.pvd"), open_series(o.dir, "bodies.pvd")
    pv.UpdatePipeline(proxy=fluid)
    both = pv.AppendDatasets(Input=[fluid, bodies])
    of_water, of_bodies = splat_lengths(o.dir)
    water = surface(both, [0, 0], "density", o.density, of_water, o)
    body = surface(both, [1, 1e9], "object_id", o.object_id, of_bodies, o)
    view = view_of(o.box)
    water_display = show(water, view, [0.36, 0.63, 0.90])
    show(body, view, [0.97, 0.96, 0.92])
    os.makedirs(o.out, exist_ok=True)
    for t in chosen_times(fluid.TimestepValues, o.times):
        begun = time.monotonic()
        for name, with_water in (("surface", 1), ("body", 0)):
            water_display.Visibility = with_water
            view.ViewTime = t
            pv.Render(view)
            path = os.path.join(o.out, f"{name}_{t:.3f}s.png")
            pv.SaveScreenshot(path, view)
            print(path)
        print(f"t = {t:g} s took {time.monotonic() - begun:.0f} s", flush=True)
    if o.state:
        pv.SaveState(o.state)


main()
