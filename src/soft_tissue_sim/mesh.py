"""A tetrahedral mesh as numpy arrays."""
import numpy


class Mesh:
    """What a soft_tissue_sim/TetMesh message holds.

    frame_id, uuid: as in the message
    vertices: (n, 3) float32, places at rest [m]
    tets: (m, 4) uint32, of positive volume
    levels: (m,) uint8, how often a tet was split
    densities: (n,) float32
    tet_densities: (m,) float32
    surface: (k, 3) uint32, triangles counter-clockwise seen from outside
    """

    def __init__(self, message):
        self.frame_id = message.header.frame_id
        self.uuid = message.uuid
        self.vertices = numpy.array(message.vertices, dtype=numpy.float32).reshape(-1, 3)
        self.tets = numpy.array(message.tetrahedra, dtype=numpy.uint32).reshape(-1, 4)
        self.levels = numpy.frombuffer(message.levels, dtype=numpy.uint8).copy()
        self.densities = numpy.array(message.densities, dtype=numpy.float32)
        self.tet_densities = numpy.array(message.tet_densities, dtype=numpy.float32)
        self.surface = numpy.array(message.surface, dtype=numpy.uint32).reshape(-1, 3)

    def volumes(self, positions=None):
        """(m,) of each tet [m³], at rest or where its corners are."""
        at = (self.vertices if positions is None else numpy.asarray(positions)).astype(float)[self.tets]
        a, b, c = (at[:, i] - at[:, 0] for i in (1, 2, 3))
        return numpy.einsum("ij,ij->i", numpy.cross(a, b), c) / 6.0

    def write_vtu(self, path, positions=None):
        """For ParaView, by VTK: the mesh at rest with level and density, and where `positions` (n, 3) are given with
        the displacement to them."""
        from vtkmodules.util import numpy_support
        from vtkmodules.vtkCommonCore import vtkPoints
        from vtkmodules.vtkCommonDataModel import VTK_TETRA, vtkCellArray, vtkUnstructuredGrid
        from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter

        def array(values, name):
            result = numpy_support.numpy_to_vtk(numpy.ascontiguousarray(values), deep=True)
            result.SetName(name)
            return result

        points = vtkPoints()
        points.SetData(array(self.vertices, "places"))
        cells = vtkCellArray()
        cells.SetData(4, numpy_support.numpy_to_vtkIdTypeArray(self.tets.astype(numpy.int64).ravel(), deep=True))
        grid = vtkUnstructuredGrid()
        grid.SetPoints(points)
        grid.SetCells(VTK_TETRA, cells)
        grid.GetCellData().AddArray(array(self.levels, "level"))
        grid.GetCellData().AddArray(array(self.tet_densities, "density"))
        grid.GetPointData().AddArray(array(self.densities, "density"))
        if positions is not None:
            moved = numpy.asarray(positions, dtype=numpy.float32) - self.vertices
            grid.GetPointData().AddArray(array(moved, "displacement"))
        writer = vtkXMLUnstructuredGridWriter()
        writer.SetFileName(str(path))
        writer.SetInputData(grid)
        if writer.Write() != 1:
            raise OSError(f"{path} cannot be written")
