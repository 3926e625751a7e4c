#!/usr/bin/python3
"""Draws a surface of a run, coloured by a field, with VTK: what docs/surfaces.md shows.

usage: draw_surface.py DIR/surface/surface_N.vtp OUT.png [--field speed] [--top VALUE] [--eye X,Y,Z --at X,Y,Z]
                       [--box X,Y,Z]
needs: apt-get install python3-vtk9 xvfb; without a screen: xvfb-run -a tools/draw_surface.py ...
"""
import argparse
import sys

import vtk

BLUES = [(0.02, 0.10, 0.30), (0.05, 0.35, 0.70), (0.40, 0.75, 0.92), (1, 1, 1)]


def read_surface(path):
    reader = vtk.vtkXMLPolyDataReader()
    reader.SetFileName(path)
    reader.Update()
    return reader.GetOutput()


def draw_field(data, field, top):
    array = data.GetPointData().GetArray(field)
    if array is None:
        names = [data.GetPointData().GetArrayName(k) for k in range(data.GetPointData().GetNumberOfArrays())]
        sys.exit(f"there is no field {field}, but {', '.join(names)}")
    colours, low, high = vtk.vtkColorTransferFunction(), *array.GetRange(-1)
    for k, colour in enumerate(BLUES):
        colours.AddRGBPoint(low + k/3*((top or high) - low), *colour)
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(data)
    mapper.SetScalarModeToUsePointFieldData()
    mapper.SelectColorArray(field)
    mapper.SetLookupTable(colours)
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    shine = actor.GetProperty()
    shine.SetInterpolationToPhong()
    shine.SetAmbient(0.2)
    shine.SetSpecular(0.25)
    shine.SetSpecularPower(80)
    return actor


def draw_box(corner):
    box, outline, mapper, actor = vtk.vtkCubeSource(), vtk.vtkOutlineFilter(), vtk.vtkPolyDataMapper(), vtk.vtkActor()
    box.SetBounds(0, corner[0], 0, corner[1], 0, corner[2])
    outline.SetInputConnection(box.GetOutputPort())
    mapper.SetInputConnection(outline.GetOutputPort())
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(0.3, 0.3, 0.35)
    return actor


def set_light(scene, eye, at):
    scene.RemoveAllLights()
    for shift, strength in (((-0.3, 0.2, 1.2), 0.55), ((0.4, -0.2, 0.3), 0.4)):
        light = vtk.vtkLight()
        light.SetPosition(*(e + s for e, s in zip(eye, shift)))
        light.SetFocalPoint(*at)
        light.SetIntensity(strength)
        scene.AddLight(light)


def write_picture(scene, path):
    window, image, writer = vtk.vtkRenderWindow(), vtk.vtkWindowToImageFilter(), vtk.vtkPNGWriter()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)
    window.SetSize(1000, 640)
    window.AddRenderer(scene)
    window.Render()
    image.SetInput(window)
    image.ReadFrontBufferOff()
    writer.SetFileName(path)
    writer.SetInputConnection(image.GetOutputPort())
    writer.Write()


def main():
    numbers = lambda text: [float(word) for word in text.split(",")]
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("surface")
    parser.add_argument("out")
    parser.add_argument("--field", default="speed")
    parser.add_argument("--top", type=float, help="value of the last colour")
    parser.add_argument("--eye", type=numbers, default=[0.62, -0.85, 0.5])
    parser.add_argument("--at", type=numbers, default=[0.25, 0.075, 0.14])
    parser.add_argument("--box", type=numbers, default=[0.5, 0.15, 0.35], help="far corner of the domain")
    o = parser.parse_args()
    scene = vtk.vtkRenderer()
    scene.AddActor(draw_field(read_surface(o.surface), o.field, o.top))
    scene.AddActor(draw_box(o.box))
    scene.SetBackground(0.95, 0.96, 0.97)
    scene.SetBackground2(0.72, 0.78, 0.84)
    scene.GradientBackgroundOn()
    set_light(scene, o.eye, o.at)
    camera = scene.GetActiveCamera()
    camera.SetPosition(*o.eye)
    camera.SetFocalPoint(*o.at)
    camera.SetViewUp(0, 0, 1)
    camera.SetViewAngle(26)
    scene.ResetCameraClippingRange()
    write_picture(scene, o.out)


if __name__ == "__main__":
    main()
