#include "tissue/base/mesh_file.h"

#include "tissue/base/error.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <cstdio>
#include <fstream>

namespace tissue {
namespace {

template <class Array, class T>
void add_field(vtkDataSetAttributes* data, const std::string& name, const std::vector<T>& values) {
  vtkNew<Array> array;
  array->SetName(name.c_str());
  array->SetNumberOfValues(static_cast<vtkIdType>(values.size()));
  for (std::size_t i = 0; i < values.size(); ++i) {
    array->SetValue(static_cast<vtkIdType>(i), values[i]);
  }
  data->AddArray(array);
}

void add_parents(const TetMesh& mesh, vtkPointData* data) {
  vtkNew<vtkTypeInt64Array> array;
  array->SetName("parents");
  array->SetNumberOfComponents(2);
  array->SetNumberOfTuples(static_cast<vtkIdType>(mesh.vertices.size()));
  array->Fill(-1.0);
  for (std::size_t i = 0; i < mesh.parents.size(); ++i) {
    const auto vertex = static_cast<vtkIdType>(mesh.lattice_vertices + i);
    for (int end = 0; end < 2; ++end) {
      array->SetTypedComponent(vertex, end, static_cast<vtkTypeInt64>(mesh.parents[i][end]));
    }
  }
  data->AddArray(array);
}

vtkNew<vtkUnstructuredGrid> grid_of(const TetMesh& mesh) {
  vtkNew<vtkUnstructuredGrid> grid;
  vtkNew<vtkPoints> points;
  points->SetDataTypeToFloat();
  points->SetNumberOfPoints(static_cast<vtkIdType>(mesh.vertices.size()));
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    points->SetPoint(static_cast<vtkIdType>(v), mesh.vertices[v].data());
  }
  grid->SetPoints(points);
  vtkNew<vtkCellArray> cells;
  for (const Tet& tet : mesh.tets) {
    const vtkIdType ids[4] = {tet[0], tet[1], tet[2], tet[3]};
    cells->InsertNextCell(4, ids);
  }
  grid->SetCells(VTK_TETRA, cells);
  return grid;
}

}  // namespace

void write_mesh(const TetMesh& mesh, const std::string& path,
                const std::vector<TetField>& further) {
  const vtkNew<vtkUnstructuredGrid> grid = grid_of(mesh);
  add_field<vtkFloatArray>(grid->GetPointData(), "density", mesh.densities);
  if (!mesh.parents.empty()) add_parents(mesh, grid->GetPointData());
  add_field<vtkUnsignedCharArray>(grid->GetCellData(), "level", mesh.levels);
  add_field<vtkFloatArray>(grid->GetCellData(), "density", mesh.tet_densities);
  for (const TetField& field : further) {
    add_field<vtkDoubleArray>(grid->GetCellData(), field.name, field.values);
  }
  const std::string unfinished = path + ".part";
  const auto refuse = [&] {
    std::remove(unfinished.c_str());
    throw InputError(ErrorCode::kIo, "output: '" + path + "' cannot be written");
  };
  // VTK would say so on the terminal.
  if (!std::ofstream(unfinished)) refuse();
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->SetFileName(unfinished.c_str());
  writer->SetInputData(grid);
  writer->SetDataModeToAppended();
  writer->EncodeAppendedDataOff();
  writer->SetCompressorTypeToNone();
  if (writer->Write() != 1 || writer->GetErrorCode() != 0 ||
      std::rename(unfinished.c_str(), path.c_str()) != 0) {
    refuse();
  }
}

}  // namespace tissue
