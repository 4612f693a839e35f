#include "tissue/base/mesh_file.h"

#include "support/mesh_checks.h"
#include "support/shapes.h"
#include "tissue/refine/build_mesh.h"

#include <filesystem>
#include <fstream>
#include <iterator>

namespace {

using namespace tissue;
using tissue_test::refusal;

std::string temporary(const std::string& name) {
  return (std::filesystem::temp_directory_path() / name).string();
}

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

void write_bytes(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

TetMesh built(Method method) {
  MeshOptions options;
  options.method = method;
  options.iso_value = 100.0;
  options.spacing = 0.008;
  return build_mesh(tissue_test::synthetic_shapes()[0].volume, nullptr, options).mesh;
}

TEST(MeshFile, AMeshOfEveryMethodComesBackAsItWasAndCountsTheSame) {
  for (const Method method : {Method::kDensity, Method::kUniform, Method::kSurface}) {
    const TetMesh mesh = built(method);
    const std::string path = temporary("tissue_mesh_file.vtu");
    write_mesh(mesh, path);
    const TetMesh read = read_mesh(path, true);
    EXPECT_EQ(read.uuid, mesh.uuid);
    EXPECT_EQ(read.parents, mesh.parents);
    EXPECT_EQ(read.lattice_vertices, mesh.lattice_vertices);
    EXPECT_EQ(read.frame_id, mesh.frame_id);
    EXPECT_EQ(read.surface.size(), mesh.surface.size());
    const tissue_test::MeshFindings found = tissue_test::expect_sound(read);
    EXPECT_NEAR(found.tet_volume, mesh.statistics.volume, 1e-9 * mesh.statistics.volume);
    EXPECT_NEAR(found.min_dihedral_deg, mesh.statistics.dihedral[0] * 180.0 / M_PI, 1e-3);
    EXPECT_NEAR(found.max_dihedral_deg, mesh.statistics.dihedral[1] * 180.0 / M_PI, 1e-3);
  }
}

TEST(MeshFile, M12_AFileThatWasCutAnywhereOrChangedInOneBitIsRefusedBeforeItIsParsed) {
  TetMesh tet;
  tet.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  tet.tets = {{0, 1, 2, 3}};
  tet.levels = {0};
  tet.densities = {1, 2, 3, 4};
  tet.tet_densities = {2.5f};
  const std::string path = temporary("tissue_mesh_file_whole.vtu"),
                    broken = temporary("tissue_mesh_file_broken.vtu");
  write_mesh(tet, path);
  const std::string bytes = bytes_of(path);
  EXPECT_NO_THROW(read_mesh(path, true));
  ASSERT_GT(bytes.size(), 1000u);
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    write_bytes(broken, bytes.substr(0, length));
    ASSERT_EQ(refusal([&] { read_mesh(broken, true); }).substr(0, 6), "E_FILE") << length;
    // Also by those who take files from elsewhere, unless what is left has no trace of us.
    if (length > 600) {
      ASSERT_EQ(refusal([&] { read_mesh(broken); }).substr(0, 6), "E_FILE") << length;
    }
  }
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::string changed = bytes;
    changed[i] = static_cast<char>(changed[i] ^ (1 << (i % 8)));
    write_bytes(broken, changed);
    ASSERT_EQ(refusal([&] { read_mesh(broken, true); }).substr(0, 6), "E_FILE") << i;
    ASSERT_EQ(refusal([&] { read_mesh(broken); }).substr(0, 6), "E_FILE") << i;
  }
}

TEST(MeshFile, TakesAMeshFromElsewhereOnceItsTetsAreChecked) {
  const std::string path = temporary("tissue_mesh_file_foreign.vtu");
  const auto write = [&](const std::string& connectivity) {
    write_bytes(path,
                "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"5\" "
                "NumberOfCells=\"2\"><Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" "
                "format=\"ascii\">0 0 0 1 0 0 0 1 0 0 0 1 1 1 1</DataArray></Points><Cells>"
                "<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">" +
                    connectivity +
                    "</DataArray><DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">4 8"
                    "</DataArray><DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">10 10"
                    "</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>");
  };
  write("0 1 2 3 1 2 3 4");
  const TetMesh mesh = read_mesh(path);
  EXPECT_EQ(mesh.tets.size(), 2u);
  EXPECT_EQ(mesh.surface.size(), 6u);
  EXPECT_EQ(mesh.lattice_vertices, 5u);
  EXPECT_EQ(refusal([&] { read_mesh(path, true); }).substr(0, 6), "E_FILE");
  write("0 1 2 3 1 2 4 3");
  EXPECT_EQ(refusal([&] { read_mesh(path); }),
            "E_MESH_QUALITY: mesh: 1 tets are flat or inverted: 1");
  write_bytes(path, "not a mesh at all");
  EXPECT_EQ(refusal([&] { read_mesh(path); }).substr(0, 6), "E_FILE");
}

}  // namespace
