#include "tissue/base/mesh_file.h"

#include "tissue/base/check_mesh.h"
#include "tissue/base/error.h"
#include "tissue/base/atomic_file.h"

#include <vtkCallbackCommand.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkExecutive.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkStringArray.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridWriter.h>
#include <xxhash.h>

#include <cstdio>
#include <fstream>
#include <iterator>

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

void add_displacements(const std::vector<Vec3>& displacements, vtkPointData* data) {
  vtkNew<vtkFloatArray> array;
  array->SetName("displacement");
  array->SetNumberOfComponents(3);
  array->SetNumberOfTuples(static_cast<vtkIdType>(displacements.size()));
  for (std::size_t v = 0; v < displacements.size(); ++v) {
    for (int axis = 0; axis < 3; ++axis) {
      array->SetTypedComponent(static_cast<vtkIdType>(v), axis,
                               static_cast<float>(displacements[v][axis]));
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

// Says near the head of the file that it has a seal, and whose mesh it is.
constexpr char kMark[] = "soft_tissue_sim_mesh";

void add_mark(const TetMesh& mesh, vtkUnstructuredGrid* grid) {
  vtkNew<vtkStringArray> mark;
  mark->SetName(kMark);
  mark->InsertNextValue(mesh.frame_id);
  grid->GetFieldData()->AddArray(mark);
}

// The seal: a comment with a hash of all bytes before it.
constexpr char kSealBegin[] = "<!-- xxh64 ";
constexpr char kSealEnd[] = " -->\n";
constexpr std::size_t kSealLength = sizeof(kSealBegin) - 1 + 16 + sizeof(kSealEnd) - 1;

std::string seal_text(std::uint64_t hash) {
  char text[kSealLength + 1];
  std::snprintf(text, sizeof(text), "%s%016llx%s", kSealBegin,
                static_cast<unsigned long long>(hash), kSealEnd);
  return text;
}

template <class Refuse>
void append_seal(const std::string& path, const Refuse& refuse) {
  XXH64_state_t* state = XXH64_createState();
  XXH64_reset(state, 0);
  std::ifstream input(path, std::ios::binary);
  std::vector<char> buffer(1 << 20);
  while (input.read(buffer.data(), static_cast<std::streamsize>(buffer.size())) ||
         input.gcount() > 0) {
    XXH64_update(state, buffer.data(), static_cast<std::size_t>(input.gcount()));
  }
  const std::uint64_t hash = XXH64_digest(state);
  XXH64_freeState(state);
  std::ofstream output(path, std::ios::binary | std::ios::app);
  output << seal_text(hash);
  output.close();
  if (input.bad() || !output) refuse();
}

bool has_seal(const std::string& bytes) {
  if (bytes.size() < kSealLength) return false;
  const std::size_t sealed = bytes.size() - kSealLength;
  return bytes.compare(sealed, kSealLength, seal_text(XXH64(bytes.data(), sealed, 0))) == 0;
}

template <class T>
std::vector<T> field_of(vtkDataSetAttributes* data, const char* name, vtkIdType count,
                        double otherwise) {
  std::vector<T> values(static_cast<std::size_t>(count), static_cast<T>(otherwise));
  vtkDataArray* array = data->GetArray(name);
  if (array == nullptr || array->GetNumberOfTuples() != count) return values;
  for (vtkIdType i = 0; i < count; ++i) {
    values[static_cast<std::size_t>(i)] = static_cast<T>(array->GetComponent(i, 0));
  }
  return values;
}

void take_parents(vtkDataArray* array, TetMesh& mesh) {
  mesh.lattice_vertices = static_cast<std::uint32_t>(mesh.vertices.size());
  if (array == nullptr || array->GetNumberOfComponents() != 2 ||
      array->GetNumberOfTuples() != static_cast<vtkIdType>(mesh.vertices.size())) {
    return;
  }
  std::uint32_t v = 0;
  while (v < mesh.vertices.size() && array->GetComponent(v, 0) < 0.0) ++v;
  mesh.lattice_vertices = v;
  for (; v < mesh.vertices.size(); ++v) {
    Edge ends{};
    for (int k = 0; k < 2; ++k) {
      const double end = array->GetComponent(v, k);
      // check_mesh() refuses what this makes of a number that is none.
      ends[k] = end >= 0.0 && end < 4294967295.0 ? static_cast<std::uint32_t>(end) : 0xffffffffu;
    }
    mesh.parents.push_back(ends);
  }
}

TetMesh mesh_of(vtkUnstructuredGrid* grid) {
  TetMesh mesh;
  const vtkIdType points = grid->GetNumberOfPoints(), cells = grid->GetNumberOfCells();
  for (vtkIdType p = 0; p < points; ++p) {
    double place[3];
    grid->GetPoint(p, place);
    mesh.vertices.push_back(Vec3(place[0], place[1], place[2]).cast<float>());
  }
  vtkNew<vtkIdList> ids;
  for (vtkIdType c = 0; c < cells; ++c) {
    grid->GetCellPoints(c, ids);
    Tet tet{};
    for (int i = 0; i < 4; ++i) tet[i] = static_cast<std::uint32_t>(ids->GetId(i));
    mesh.tets.push_back(tet);
  }
  mesh.densities = field_of<float>(grid->GetPointData(), "density", points, 1.0);
  mesh.tet_densities = field_of<float>(grid->GetCellData(), "density", cells, 1.0);
  mesh.levels = field_of<std::uint8_t>(grid->GetCellData(), "level", cells, 0.0);
  take_parents(grid->GetPointData()->GetArray("parents"), mesh);
  const auto* mark = vtkStringArray::SafeDownCast(grid->GetFieldData()->GetAbstractArray(kMark));
  if (mark != nullptr && mark->GetNumberOfValues() == 1) {
    mesh.frame_id = const_cast<vtkStringArray*>(mark)->GetValue(0);
  }
  return mesh;
}

}  // namespace

void write_mesh(const TetMesh& mesh, const std::string& path, const std::vector<TetField>& further,
                const std::vector<Vec3>& displacements) {
  const vtkNew<vtkUnstructuredGrid> grid = grid_of(mesh);
  add_field<vtkFloatArray>(grid->GetPointData(), "density", mesh.densities);
  if (!mesh.parents.empty()) add_parents(mesh, grid->GetPointData());
  if (!displacements.empty()) add_displacements(displacements, grid->GetPointData());
  add_field<vtkUnsignedCharArray>(grid->GetCellData(), "level", mesh.levels);
  add_field<vtkFloatArray>(grid->GetCellData(), "density", mesh.tet_densities);
  for (const TetField& field : further) {
    add_field<vtkDoubleArray>(grid->GetCellData(), field.name, field.values);
  }
  add_mark(mesh, grid);
  AtomicFile file(path);
  const auto refuse = [&] {
    throw InputError(ErrorCode::kIo, "output: '" + path + "' cannot be written");
  };
  // VTK would say so on the terminal.
  if (!std::ofstream(file.temporary())) refuse();
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->SetFileName(file.temporary().c_str());
  writer->SetInputData(grid);
  writer->SetDataModeToAppended();
  writer->EncodeAppendedDataOff();
  writer->SetCompressorTypeToNone();
  if (writer->Write() != 1 || writer->GetErrorCode() != 0) refuse();
  append_seal(file.temporary(), refuse);
  file.commit();
}

TetMesh read_mesh(const std::string& path, bool only_own) {
  const auto refuse = [&](const std::string& why) {
    throw InputError(ErrorCode::kFile, "mesh: '" + path + "' " + why);
  };
  std::ifstream file(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (!file.is_open() || file.bad() || bytes.empty()) refuse("cannot be read");
  const bool is_sealed = has_seal(bytes);
  // Cutting or changing one place cannot take away both.
  const bool claims_seal = bytes.substr(0, 65536).find(kMark) != std::string::npos ||
                           bytes.find(kSealBegin) != std::string::npos;
  if (!is_sealed && claims_seal) refuse("has been cut or changed: its hash does not fit");
  if (!is_sealed && only_own) refuse("was not written by this package: it has no hash");

  vtkNew<vtkXMLUnstructuredGridReader> reader;
  bool failed = false;
  const auto note = [](vtkObject*, unsigned long, void* flag, void*) {
    *static_cast<bool*>(flag) = true;
  };
  vtkNew<vtkCallbackCommand> observer;
  observer->SetCallback(note);
  observer->SetClientData(&failed);
  reader->AddObserver(vtkCommand::ErrorEvent, observer);
  reader->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, observer);
  reader->SetParserErrorObserver(observer);
  reader->SetReaderErrorObserver(observer);
  reader->ReadFromInputStringOn();
  reader->SetInputString(bytes);
  reader->Update();
  vtkUnstructuredGrid* grid = reader->GetOutput();
  if (failed || reader->GetErrorCode() != 0 || grid == nullptr || grid->GetNumberOfCells() == 0) {
    refuse("is no VTU file with cells");
  }
  if (grid->IsHomogeneous() == 0 || grid->GetCellType(0) != VTK_TETRA) {
    refuse("holds other cells than tets");
  }
  TetMesh mesh = mesh_of(grid);
  check_mesh(mesh);
  mesh.surface = boundary_of(mesh.tets, mesh.vertices.size());
  mesh.uuid = mesh_uuid(mesh);
  mesh.statistics.tetrahedra = mesh.tets.size();
  mesh.statistics.vertices = mesh.vertices.size();
  return mesh;
}

}  // namespace tissue
