#include "poly_data.h"
#include "tissue/base/error.h"
#include "tissue/base/atomic_file.h"

#include <vtkCallbackCommand.h>
#include <vtkCellArray.h>
#include <vtkCleanPolyData.h>
#include <vtkExecutive.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkOBJReader.h>
#include <vtkPLYReader.h>
#include <vtkPLYWriter.h>
#include <vtkPoints.h>
#include <vtkSTLReader.h>
#include <vtkSTLWriter.h>
#include <vtkTriangleFilter.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLPolyDataWriter.h>

#include <cctype>
#include <fstream>

namespace tissue {
namespace {

std::string ending_of(const std::string& path) {
  const std::size_t dot = path.rfind('.');
  std::string ending = dot == std::string::npos ? "" : path.substr(dot + 1);
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending;
}

// Runs a reader without letting it print; null if it failed.
template <class Reader>
PolyData output_of(const std::string& path) {
  vtkNew<Reader> reader;
  vtkNew<vtkCallbackCommand> silent;
  silent->SetCallback([](vtkObject*, unsigned long, void*, void*) {});
  for (const auto event : {vtkCommand::ErrorEvent, vtkCommand::WarningEvent}) {
    reader->AddObserver(event, silent);
    reader->GetExecutive()->AddObserver(event, silent);
  }
  reader->SetFileName(path.c_str());
  reader->Update();
  return reader->GetErrorCode() == 0 ? PolyData(reader->GetOutput()) : nullptr;
}

PolyData read_poly(const std::string& path) {
  const std::string ending = ending_of(path);
  if (ending == "ply") return output_of<vtkPLYReader>(path);
  if (ending == "stl") return output_of<vtkSTLReader>(path);
  if (ending == "obj") return output_of<vtkOBJReader>(path);
  if (ending == "vtp") return output_of<vtkXMLPolyDataReader>(path);
  throw InputError(ErrorCode::kFile, "surface: '" + path + "' is not PLY, STL, OBJ or VTP");
}

}  // namespace

PolyData poly_of(const TriangleSurface& surface) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (const Vec3& vertex : surface.vertices) points->InsertNextPoint(vertex.data());
  vtkNew<vtkCellArray> cells;
  for (const Triangle& triangle : surface.triangles) {
    const vtkIdType ids[3] = {triangle[0], triangle[1], triangle[2]};
    cells->InsertNextCell(3, ids);
  }
  PolyData poly = PolyData::New();
  poly->SetPoints(points);
  poly->SetPolys(cells);
  return poly;
}

TriangleSurface surface_from(vtkPolyData* poly) {
  // STL repeats its points, others hold strips and polygons.
  vtkNew<vtkTriangleFilter> triangles;
  triangles->SetInputData(poly);
  triangles->PassLinesOff();
  triangles->PassVertsOff();
  vtkNew<vtkCleanPolyData> clean;
  clean->SetInputConnection(triangles->GetOutputPort());
  clean->ConvertPolysToLinesOff();
  clean->Update();
  vtkPolyData* output = clean->GetOutput();
  TriangleSurface surface;
  for (vtkIdType i = 0; i < output->GetNumberOfPoints(); ++i) {
    surface.vertices.emplace_back(output->GetPoint(i));
  }
  vtkNew<vtkIdList> ids;
  for (vtkIdType c = 0; c < output->GetNumberOfCells(); ++c) {
    output->GetCellPoints(c, ids);
    if (ids->GetNumberOfIds() != 3) continue;
    Triangle triangle{};
    for (int i = 0; i < 3; ++i) triangle[i] = static_cast<std::uint32_t>(ids->GetId(i));
    surface.triangles.push_back(triangle);
  }
  return surface;
}

TriangleSurface read_surface(const std::string& path) {
  if (!std::ifstream(path)) {
    throw InputError(ErrorCode::kFile, "surface: '" + path + "' cannot be opened");
  }
  const PolyData poly = read_poly(path);
  TriangleSurface surface;
  if (poly != nullptr) surface = surface_from(poly);
  bool finite = true;
  for (const Vec3& vertex : surface.vertices) finite = finite && vertex.allFinite();
  if (surface.triangles.empty() || !finite) {
    throw InputError(ErrorCode::kFile, "surface: '" + path + "' holds no finite triangles");
  }
  return surface;
}

void write_surface(const TriangleSurface& surface, const std::string& path) {
  const PolyData poly = poly_of(surface);
  AtomicFile file(path);
  const auto write = [&](auto* writer) {
    writer->SetFileName(file.temporary().c_str());
    writer->SetInputData(poly);
    if (!std::ofstream(file.temporary()) || writer->Write() != 1) {
      throw InputError(ErrorCode::kIo, "output: '" + path + "' cannot be written");
    }
    file.commit();
  };
  const std::string ending = ending_of(path);
  if (ending == "ply") return write(vtkSmartPointer<vtkPLYWriter>::New().GetPointer());
  if (ending == "stl") return write(vtkSmartPointer<vtkSTLWriter>::New().GetPointer());
  if (ending == "vtp") return write(vtkSmartPointer<vtkXMLPolyDataWriter>::New().GetPointer());
  throw InputError(ErrorCode::kParam, "output: '" + path + "' does not end in .ply, .stl or .vtp");
}

}  // namespace tissue
