#include "ros/convert.h"
#include "ros/display_mesh.h"
#include "ros/guarded.h"
#include "ros/markers.h"
#include "ros/parameters.h"
#include "ros/tool_path_node.h"
#include "ros/volume_node.h"
#include "support/mesh_checks.h"
#include "support/shapes.h"
#include "tissue/refine/build_mesh.h"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

namespace {

using namespace tissue_ros;
using tissue_test::refusal;

tissue::TetMesh small_mesh() {
  const tissue_test::Shape ball = tissue_test::synthetic_shapes()[0];
  tissue::MeshOptions options;
  options.iso_value = ball.iso;
  options.spacing = 0.006;
  return tissue::build_mesh(ball.volume, nullptr, options).mesh;
}

template <class T>
void compare(const YAML::Node& yaml, const char* name, const T& value, std::size_t& count) {
  ASSERT_TRUE(yaml[name].IsDefined()) << name;
  EXPECT_EQ(yaml[name].as<T>(), value) << name;
  ++count;
}

template <class Parameters>
void expect_defaults(const YAML::Node& yaml) {
  Parameters parameters;
  std::size_t count = 0;
  parameters.visit(
      [&](const char* name, auto& value, const auto&...) { compare(yaml, name, value, count); });
  EXPECT_EQ(yaml.size(), count);
}

TEST(Parameters, TheShippedFileHoldsTheDefaultsOfTheCode) {
  const YAML::Node yaml =
      YAML::LoadFile(std::string(TISSUE_SOURCE_DIR) + "/config/parameters.yaml");
  expect_defaults<VolumeNodeParameters>(yaml["volume_node"]);
  expect_defaults<MesherNodeParameters>(yaml["mesher_node"]);
  expect_defaults<DeformerNodeParameters>(yaml["deformer_node"]);
  expect_defaults<ToolPathNodeParameters>(yaml["tool_path_node"]);
  expect_defaults<MouseToolNodeParameters>(yaml["mouse_tool_node"]);
  expect_defaults<DeviceAdapterNodeParameters>(yaml["device_adapter_node"]);
}

TEST(ToolPath, NamesTheParameterThatIsWrong) {
  ToolPathNodeParameters parameters;
  EXPECT_EQ(refusal([&] { path_of(parameters); }), "E_FILE: path: '' cannot be read");
  parameters.kind = "spiral";
  EXPECT_EQ(refusal([&] { path_of(parameters); }),
            "E_PARAM: ~kind: 'spiral' is not file, line or circle");
  parameters.kind = "line";
  parameters.from = {0.0, 0.0};
  EXPECT_EQ(refusal([&] { path_of(parameters); }), "E_PARAM: ~from: has 2 numbers, not x, y, z");
  parameters.from = {0.0, 0.0, 0.0};
  parameters.to = {0.0, 0.0, 0.1};
  EXPECT_NEAR(pose_at(path_of(parameters), 0.5).position.z(), 0.05, 1e-15);
  parameters.kind = "circle";
  parameters.centre = {0.1, 0.0, 0.0};
  const auto circle = path_of(parameters);
  for (const double time : {0.0, 0.3, 1.7, 2.0}) {
    const tissue::Vec3 arm = pose_at(circle, time).position - tissue::Vec3(0.1, 0.0, 0.0);
    EXPECT_NEAR(arm.norm(), 0.01, 1e-6);
    EXPECT_NEAR(arm.z(), 0.0, 1e-15);
  }
}

TEST(Result, HasTheConstantsOfTheCode) {
  using soft_tissue_sim::Result;
  using tissue::ErrorCode;
  EXPECT_EQ(Result::OK, static_cast<int>(ErrorCode::kOk));
  EXPECT_EQ(Result::E_SIZE_MISMATCH, static_cast<int>(ErrorCode::kSizeMismatch));
  EXPECT_EQ(Result::E_TOO_MANY_TETS, static_cast<int>(ErrorCode::kTooManyTets));
  EXPECT_EQ(Result::E_NTINIT, static_cast<int>(ErrorCode::kNTinit));
  EXPECT_EQ(Result::E_PARAM, static_cast<int>(ErrorCode::kParam));
  EXPECT_EQ(Result::E_BUSY, static_cast<int>(ErrorCode::kBusy));
  EXPECT_EQ(Result::E_MESH_QUALITY, static_cast<int>(ErrorCode::kMeshQuality));
  EXPECT_EQ(Result::E_NOMEM, static_cast<int>(ErrorCode::kNomem));
  EXPECT_EQ(Result::E_INTERNAL, static_cast<int>(ErrorCode::kInternal));
}

TEST(Convert, AVolumeComesBackAsItWas) {
  tissue::Volume volume =
      *tissue_test::byte_volume(5, [](double x, double y, double z) { return x + 5 * y + 25 * z; });
  volume.grid.axes = Eigen::AngleAxisd(0.4, tissue::Vec3(1, 2, 2) / 3.0).toRotationMatrix();
  volume.grid.origin = tissue::Vec3(0.1, 0.2, -0.3);
  volume.slope = 2.0;
  volume.intercept = -7.0;
  volume.quantity = tissue::Quantity::kHounsfield;
  const tissue::Volume back = from_message(to_message(volume));
  EXPECT_TRUE(tissue::same_grid(volume.grid, back.grid));
  EXPECT_LT((volume.grid.axes - back.grid.axes).norm(), 1e-12);
  EXPECT_EQ(volume.voxels, back.voxels);
  EXPECT_EQ(back.slope, 2.0);
  EXPECT_EQ(back.intercept, -7.0);
  EXPECT_EQ(back.quantity, tissue::Quantity::kHounsfield);
}

TEST(Convert, AMeshComesBackAsItWas) {
  const tissue::TetMesh mesh = small_mesh();
  const tissue::TetMesh back = from_message(to_message(mesh));
  EXPECT_EQ(tissue::mesh_uuid(back), mesh.uuid);
  EXPECT_EQ(back.parents, mesh.parents);
  EXPECT_EQ(back.surface, mesh.surface);
  EXPECT_EQ(back.lattice_vertices, mesh.lattice_vertices);
}

TEST(Convert, AMeshWhoseArraysDisagreeIsRefused) {
  const soft_tissue_sim::TetMesh good = to_message(small_mesh());
  auto bad = good;
  bad.vertices.pop_back();
  EXPECT_EQ(refusal([&] { from_message(bad); }).substr(0, 15), "E_SIZE_MISMATCH");
  bad = good;
  bad.tetrahedra[5] = 0xffffffff;
  EXPECT_EQ(refusal([&] { from_message(bad); }).substr(0, 15), "E_SIZE_MISMATCH");
  bad = good;
  bad.header.frame_id.clear();
  EXPECT_EQ(refusal([&] { from_message(bad); }).substr(0, 7), "E_FRAME");
  // A mesh from elsewhere, without surface, hierarchy or name, is taken.
  auto foreign = good;
  foreign.surface.clear();
  foreign.parents.clear();
  foreign.uuid.clear();
  EXPECT_EQ(from_message(foreign).surface.size(), good.surface.size() / 3);
  EXPECT_EQ(from_message(foreign).uuid, good.uuid);
}

TEST(Convert, ACloudHoldsEveryVertexInOrder) {
  const tissue::TetMesh mesh = small_mesh();
  const tissue::Body body = tissue::body_of(mesh);
  tissue::State state = rest_state(body);
  state.positions[3] += tissue::Vec3(0.003, 0.004, 0.0);
  const auto levels = vertex_levels(mesh);
  const sensor_msgs::PointCloud2 cloud = cloud_message(body, state, levels);
  ASSERT_EQ(cloud.width, mesh.vertices.size());
  ASSERT_EQ(cloud.data.size(), cloud.width * 6 * sizeof(float));
  float point[6];
  std::memcpy(point, &cloud.data[3 * cloud.point_step], sizeof(point));
  EXPECT_FLOAT_EQ(point[0], mesh.vertices[3].x() + 0.003f);
  EXPECT_EQ(point[3], mesh.densities[3]);
  EXPECT_EQ(point[4], levels[3]);
  EXPECT_NEAR(point[5], 0.005f, 1e-7f);
}

TEST(Convert, X5ACloudIsReadAsFarAsItSaysTheTruth) {
  const tissue::TetMesh mesh = small_mesh();
  const tissue::Body body = tissue::body_of(mesh);
  const sensor_msgs::PointCloud2 cloud = cloud_message(body, rest_state(body), vertex_levels(mesh));
  EXPECT_EQ(places_in(cloud), mesh.vertices);
  const auto code = [&](const auto& change) {
    sensor_msgs::PointCloud2 bad = cloud;
    change(bad);
    const std::string sentence = refusal([&] { places_in(bad); });
    return sentence.substr(0, sentence.find(':'));
  };
  EXPECT_EQ(code([](auto& bad) { ++bad.width; }), "E_SIZE_MISMATCH");
  EXPECT_EQ(code([](auto& bad) { bad.width = bad.height = 4294967295u; }), "E_SIZE_MISMATCH");
  EXPECT_EQ(code([](auto& bad) { bad.point_step = 0; }), "E_ENCODING");
  EXPECT_EQ(code([](auto& bad) { bad.fields[2].datatype = 8; }), "E_ENCODING");
  EXPECT_EQ(code([](auto& bad) { bad.fields.clear(); }), "E_ENCODING");
  EXPECT_EQ(code([](auto& bad) { std::fill(bad.data.begin(), bad.data.end(), 255); }),
            "E_NONFINITE");
}

TEST(PrepareVolume, NamesTheParameterThatIsWrong) {
  VolumeNodeParameters good;
  good.file = std::string(TISSUE_SOURCE_DIR) + "/data/ch2bet.nii.gz";
  const auto refused = [&](const std::function<void(VolumeNodeParameters&)>& spoil) {
    VolumeNodeParameters parameters = good;
    spoil(parameters);
    return refusal([&] { prepare_volume(parameters); });
  };
  using P = VolumeNodeParameters;
  EXPECT_EQ(refused([](P&) {}), "");
  EXPECT_EQ(refused([](P& p) { p.file.clear(); }), "E_FILE: ~file: no volume is named");
  EXPECT_EQ(refused([](P& p) { p.file = "/no.nii"; }).substr(0, 6), "E_FILE");
  EXPECT_EQ(refused([](P& p) { p.frame_id = "/patient"; }).substr(0, 7), "E_FRAME");
  EXPECT_EQ(refused([](P& p) { p.quantity = "mass"; }),
            "E_PARAM: ~quantity: 'mass' is not one of density hounsfield label");
  EXPECT_EQ(refused([](P& p) { p.crop = {1, 2}; }), "E_PARAM: ~crop: has 2 numbers, not 6");
  EXPECT_EQ(refused([](P& p) { p.tumour = {1}; }), "E_PARAM: ~tumour: has 1 numbers, not 5");
  EXPECT_EQ(refused([](P& p) { p.mask_by_threshold = true, p.mask_opening = 99; }).substr(0, 21),
            "E_PARAM: mask_opening");
  EXPECT_EQ(refused([](P& p) { p.mask_by_threshold = true, p.mask_smoothing = -1; }).substr(0, 23),
            "E_PARAM: mask_smoothing");
}

TEST(PrepareVolume, CropsMasksAndPutsATumour) {
  VolumeNodeParameters parameters;
  parameters.file = std::string(TISSUE_SOURCE_DIR) + "/data/ch2bet.nii.gz";
  parameters.crop = {-0.03, -0.06, -0.01, 0.03, 0.0, 0.05};
  parameters.tumour = {0.0, -0.03, 0.02, 0.01, 255};
  parameters.mask_by_threshold = true;
  parameters.mask_above = 20;
  const PreparedVolume prepared = prepare_volume(parameters);
  EXPECT_EQ(prepared.volume.grid.size, (tissue::GridSize{61, 61, 61}));
  EXPECT_EQ(value_range(prepared.volume)[1], 255.0);
  ASSERT_TRUE(prepared.mask);
  EXPECT_TRUE(same_grid(prepared.mask->grid, prepared.volume.grid));
  EXPECT_EQ(value_range(*prepared.mask), (std::array<double, 2>{0.0, 1.0}));
}

TEST(DisplayMesh, KeepsToItsBudgetAndShowsTheInside) {
  const tissue::TetMesh mesh = small_mesh();
  const DisplayMesh whole = display_mesh(mesh, section_from("none", 0.5), 1000000);
  EXPECT_EQ(whole.hull.size(), mesh.surface.size());
  EXPECT_TRUE(whole.cut.empty());
  const DisplayMesh half = display_mesh(mesh, section_from("y", 0.5), 1000000);
  EXPECT_GT(half.cut.size(), 50u);
  EXPECT_NEAR(double(half.hull.size()), 0.5 * double(whole.hull.size()),
              0.1 * double(whole.hull.size()));
  for (const std::size_t budget : {600u, 200u, 50u}) {
    const DisplayMesh few = display_mesh(mesh, section_from("y", 0.5), budget);
    EXPECT_LE(few.hull.size() + few.cut.size(), budget);
    EXPECT_GT(few.hull.size() + few.cut.size(), budget / 5);
  }
}

TEST(Printable, X5WhatOthersWroteIsOneLineOfALog) {
  EXPECT_EQ(printable("frame 'a' is unknown"), "frame 'a' is unknown");
  EXPECT_EQ(printable("a\nb\x1b[31m\x7f"), "a\\x0ab\\x1b[31m\\x7f");
  EXPECT_EQ(printable(std::string(10000, 'x')).size(), 600u);
  EXPECT_EQ(printable("\xc3\xa9"), "\xc3\xa9");
  const Outcome outcome = guarded([] {
    throw tissue::InputError(tissue::ErrorCode::kFrame,
                             std::string("two\nlines") + std::string(5000, '.'));
  });
  EXPECT_EQ(outcome.sentence.find('\n'), std::string::npos);
  EXPECT_LE(outcome.sentence.size(), 600u);
}

TEST(Convert, X5NamesOfAMeshAreShort) {
  soft_tissue_sim::TetMesh message = to_message(small_mesh());
  message.header.frame_id = std::string(257, 'f');
  EXPECT_EQ(refusal([&] { from_message(message); }),
            "E_FRAME: mesh: header.frame_id is empty or too long");
  message.header.frame_id = "patient";
  message.uuid = std::string(257, 'u');
  EXPECT_EQ(refusal([&] { from_message(message); }), "E_TOO_LARGE: mesh: uuid is too long");
}

// F4, X4: what the sources must not say.
TEST(Sources, F4_X4NoQueueIsEndlessAndNoShellIsCalled) {
  namespace fs = std::filesystem;
  const std::regex endless("(advertise|subscribe)<[^;]*\\([^;]*,\\s*0\\s*[,)]"),
      shell("(^|[^_a-z])(system|popen|execl|execv)p?\\(");
  std::size_t files = 0;
  for (const auto& entry :
       fs::recursive_directory_iterator(std::string(TISSUE_SOURCE_DIR) + "/src")) {
    if (!entry.is_regular_file()) continue;
    ++files;
    std::ifstream stream(entry.path());
    const std::string text((std::istreambuf_iterator<char>(stream)), {});
    EXPECT_FALSE(std::regex_search(text, endless)) << entry.path();
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      EXPECT_FALSE(std::regex_search(line, shell)) << entry.path() << line;
    }
  }
  EXPECT_GT(files, 100u);
  EXPECT_TRUE(std::regex_search("handle.advertise<Cloud>(\"cloud\", 0)", endless));
}

}  // namespace
