"""What the scripts that draw meshes share: VTK off screen, meshes cut between whole tets, one panel
beside the other."""
import os
import shutil
import sys

if "DISPLAY" not in os.environ and shutil.which("xvfb-run") and "TISSUE_IN_XVFB" not in os.environ:
    os.environ["TISSUE_IN_XVFB"] = "1"
    os.environ["LIBGL_ALWAYS_SOFTWARE"] = "1"
    os.execvp("xvfb-run", ["xvfb-run", "-a", "/usr/bin/python3"] + sys.argv)

import vtk  # noqa: E402


def read_mesh(path):
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def middle_of(grid):
    bounds = grid.GetBounds()
    return [(bounds[2 * i] + bounds[2 * i + 1]) / 2 for i in range(3)]


def cut(grid, origin, normal):
    """The surface of the whole tets on the side of a plane away from its normal."""
    plane = vtk.vtkPlane()
    plane.SetOrigin(*origin)
    plane.SetNormal(*normal)
    whole_tets = vtk.vtkExtractGeometry()
    whole_tets.SetInputData(grid)
    whole_tets.SetImplicitFunction(plane)
    surface = vtk.vtkGeometryFilter()
    surface.SetInputConnection(whole_tets.GetOutputPort())
    surface.Update()
    return surface.GetOutput()


def moved(surface):
    """A surface with its points where the displacement takes them."""
    warp = vtk.vtkWarpVector()
    warp.SetInputData(surface)
    warp.SetInputArrayToProcess(0, 0, 0, vtk.vtkDataObject.FIELD_ASSOCIATION_POINTS, "displacement")
    warp.Update()
    return warp.GetOutput()


def colours_in_steps(colours):
    table = vtk.vtkLookupTable()
    table.SetNumberOfTableValues(len(colours))
    for i, colour in enumerate(colours):
        table.SetTableValue(i, *colour, 1.0)
    table.SetRange(0, len(colours) - 1)
    return table


def surface_actor(surface, field, table):
    """A surface with its edges, coloured by a cell field through a table that has a range."""
    surface.GetCellData().SetActiveScalars(field)
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(surface)
    mapper.SetScalarModeToUseCellData()
    mapper.SetColorModeToMapScalars()  # Bytes would be taken for colours.
    mapper.SetLookupTable(table)
    mapper.SetScalarRange(*table.GetRange())
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().EdgeVisibilityOn()
    actor.GetProperty().SetEdgeColor(0.05, 0.05, 0.05)
    actor.GetProperty().SetLineWidth(0.5)
    return actor


def ball_actor(centre, radius, opacity=0.5):
    ball = vtk.vtkSphereSource()
    ball.SetCenter(*centre)
    ball.SetRadius(radius)
    ball.SetThetaResolution(48)
    ball.SetPhiResolution(48)
    return _tool_actor(ball, opacity)


def shaft_actor(tip, end, radius, opacity=0.5):
    line = vtk.vtkLineSource()
    line.SetPoint1(*tip)
    line.SetPoint2(*end)
    tube = vtk.vtkTubeFilter()
    tube.SetInputConnection(line.GetOutputPort())
    tube.SetRadius(radius)
    tube.SetNumberOfSides(48)
    return _tool_actor(tube, opacity)


def _tool_actor(source, opacity):
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(source.GetOutputPort())
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(0.25, 0.25, 0.3)
    actor.GetProperty().SetOpacity(opacity)
    return actor


class Panel:
    """A part of a picture with a title, seen along a direction."""

    def __init__(self, viewport, title):
        text = vtk.vtkTextActor()
        text.SetInput(title)
        text.GetTextProperty().SetColor(0, 0, 0)
        text.GetTextProperty().SetFontSize(20)
        text.SetPosition(20, 10)
        self.renderer = vtk.vtkRenderer()
        self.renderer.SetViewport(*viewport)
        self.renderer.SetBackground(1, 1, 1)
        self.renderer.AddActor2D(text)

    def add(self, actor):
        self.renderer.AddActor(actor)

    def add_legend(self, table):
        bar = vtk.vtkScalarBarActor()
        bar.SetLookupTable(table)
        bar.SetNumberOfLabels(5)
        bar.SetMaximumWidthInPixels(90)
        bar.SetPosition(0.89, 0.15)
        bar.SetHeight(0.7)
        labels = bar.GetLabelTextProperty()
        labels.SetColor(0, 0, 0)
        labels.ShadowOff()
        labels.ItalicOff()
        self.renderer.AddActor2D(bar)

    def look(self, surface, direction, up):
        """From that direction at a surface, which fills four fifths of the height."""
        centre = surface.GetCenter()
        bounds = surface.GetBounds()
        height = sum(abs(u) * (bounds[2 * i + 1] - bounds[2 * i]) for i, u in enumerate(up))
        camera = self.renderer.GetActiveCamera()
        camera.SetFocalPoint(*centre)
        camera.SetPosition(*[c + d for c, d in zip(centre, direction)])
        camera.SetViewUp(*up)
        camera.ParallelProjectionOn()
        self.renderer.ResetCamera()
        camera.SetParallelScale(height / 2 / 0.8)


# All pictures come from one window: with one each, and those before left to Python's garbage collector, OpenGL has
# ended the program now and then.
_window = vtk.vtkRenderWindow()
_window.SetOffScreenRendering(1)


def write_picture(panels, size, path):
    _window.SetSize(*size)
    for panel in panels:
        _window.AddRenderer(panel.renderer)
    _window.Render()
    grab = vtk.vtkWindowToImageFilter()
    grab.SetInput(_window)
    grab.ReadFrontBufferOff()
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(str(path))
    writer.SetInputConnection(grab.GetOutputPort())
    writer.Write()
    for panel in panels:
        _window.RemoveRenderer(panel.renderer)
    print(path)
