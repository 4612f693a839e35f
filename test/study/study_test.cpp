#include "support/bodies.h"
#include "support/known_solutions.h"
#include "support/mesh_checks.h"
#include "support/problem.h"
#include "support/program.h"
#include "tissue/simulate/scene_file.h"
#include "tissue/study/leave_out.h"
#include "tissue/simulate/material_places.h"
#include "tissue/study/row_file.h"
#include "tissue/study/study_file.h"
#include "tissue/study/study_table.h"

#include <filesystem>
#include <fstream>

namespace {

using namespace tissue;
using tissue_test::refusal;
using tissue_test::temporary;

const std::string kRoot = TISSUE_SOURCE_DIR;

// A study file beside the shipped ones, so to say: its paths lead to theirs.
std::string study_with(const std::string& more,
                       const std::string& problem = "{scene: palpate.yaml}") {
  const std::string folder = temporary("tissue_study_test");
  std::filesystem::create_directories(folder);
  std::ofstream(folder + "/palpate.yaml")
      << std::ifstream(kRoot + "/config/scenes/palpate.yaml").rdbuf();
  const std::string path = folder + "/study.yaml";
  std::ofstream(path) << "volume: " << kRoot << "/data/ch2bet.nii.gz\n"
                      << "problems: {p: " << problem << "}\n"
                      << "meshes: {uniform: {method: uniform}, strain: {method: strain}}\n"
                      << more;
  return path;
}

TEST(StudyFile, MakesEveryCombinationAndPutsReferencesFirst) {
  const Study study = read_study(
      study_with("reference: {mesh: uniform, tetrahedra: 80000}\nrepeats: 2\n"
                 "rows: [{tetrahedra: [100, 200], models: [linear, scene], orders: [1, 2],"
                 " without: [nothing, each]}]\n"));
  // Reference and check, two repeats, 2 meshes x 2 sizes x 2 models x 2 orders x 2.
  ASSERT_EQ(study.rows.size(), 2u + 2u + 32u);
  EXPECT_EQ(describe(study, study.rows[0]),
            "reference: p, uniform, 80000 tets, neo_hookean of order 2");
  EXPECT_EQ(describe(study, study.rows[1]),
            "check: p, uniform, 10000 tets, neo_hookean of order 2");
  EXPECT_EQ(describe(study, study.rows[2]), "repeat: p, uniform, 100 tets, linear of order 1");
  EXPECT_EQ(describe(study, study.rows[4]),
            "p, uniform, 100 tets, linear of order 1, without density_response");
  EXPECT_EQ(describe(study, study.rows.back()), "repeat: p, uniform, 100 tets, linear of order 1");
  EXPECT_EQ(reference_of(study, 9), 0u);
  EXPECT_EQ(check_of(study, 9), 1u);
}

TEST(StudyFile, AgainstAllEffectsARowIsMeasuredByItsOwnMesh) {
  const Study study = read_study(study_with(
      "reference: all_effects\nrows: [{tetrahedra: [100, 200], without: [nothing, each]}]\n"));
  ASSERT_EQ(study.rows.size(), 8u);
  EXPECT_EQ(reference_of(study, 1), 0u);
  EXPECT_EQ(reference_of(study, 3), 2u);
  EXPECT_FALSE(check_of(study, 3));
}

TEST(StudyFile, RefusesUnknownWordsByLineAndKey) {
  const std::string rows = "rows: [{tetrahedra: [100]}]\n";
  const auto said = [](const std::string& path) { return refusal([&] { read_study(path); }); };
  EXPECT_EQ(said(study_with(rows + "refrence: {}\n")).substr(0, 48),
            "E_PARAM: study: line 5, refrence: is not a key o");
  EXPECT_NE(said(study_with("rows: [{tetrahedra: [100], meshes: [unifrom]}]\n"))
                .find("meshes[0]: 'unifrom' is not one of uniform strain"),
            std::string::npos);
  EXPECT_NE(said(study_with("rows: [{tetrahedra: [12.5]}]\n")).find("12.5"), std::string::npos);
  EXPECT_NE(said(study_with("rows: [{tetrahedra: [100], models: [jelly]}]\n")).find("'jelly'"),
            std::string::npos);
  EXPECT_NE(said(study_with("rows: [{tetrahedra: [100], without: [noise]}]\n")).find("'noise'"),
            std::string::npos);
  EXPECT_NE(said(study_with(rows, "{scene: nowhere.yaml}")).find("nowhere.yaml"),
            std::string::npos);
  EXPECT_NE(said(study_with(rows, "{scene: palpate.yaml, paths: {hand: x.csv}}")).find("hand"),
            std::string::npos);
  EXPECT_EQ(said(study_with("rows: []\n")).substr(0, 8), "E_PARAM:");
  EXPECT_EQ(said(study_with("rows: [\n")).substr(0, 25), "E_PARAM: study: not YAML:");
}

RowResult plain_result() {
  RowResult result;
  result.displacements = {Vec3(3e-3, 0, 0), Vec3(0, 4e-3, 0)};
  result.tumour = {Vec3(1e-3, 0, 0)};
  result.force = {Vec3(0, 0, 2)};
  result.tetrahedra = 12345;
  result.solver = "multigrid";
  return result;
}

TEST(StudyTable, MeasuresByTheWholeFieldTheTumourAndTheForce) {
  RowResult off = plain_result();
  off.displacements[0] += Vec3(0, 0, 5e-4);
  off.tumour[0] += Vec3(0, 3e-4, 4e-4);
  off.force[0] *= 0.9;
  off.volume_change = -0.2;
  const Difference found = difference(off, plain_result());
  EXPECT_NEAR(found.displacement, 0.1, 1e-15);
  EXPECT_NEAR(found.tumour, 5e-4, 1e-18);
  EXPECT_NEAR(*found.force, 0.1, 1e-15);
  EXPECT_NEAR(found.volume_change, 0.2, 1e-15);
  off.displacements.pop_back();
  EXPECT_EQ(refusal([&] { difference(off, plain_result()); }).substr(0, 16), "E_SIZE_MISMATCH:");
}

TEST(StudyTable, AFailedRowHasItsReasonAndTheRestGoesOn) {
  const Study study = read_study(study_with(
      "reference: {mesh: uniform, tetrahedra: 80000}\nrows: [{tetrahedra: [100, 200]}]\n"));
  std::vector<std::optional<RowResult>> results(study.rows.size());
  for (auto& result : results) result = plain_result();
  results[2]->failure = "E_PARAM: tool: \"one, two\" are too many";
  results[4].reset();
  const std::string table = study_table(study, results);
  EXPECT_NE(table.find(",failed,\"E_PARAM: tool: \"\"one, two\"\" are too many\",,,,"),
            std::string::npos)
      << table;
  EXPECT_NE(table.find("\n3,measure,p,uniform,corotational,1,,200,12345,0,0,ok,,0,0,0,"),
            std::string::npos)
      << table;
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 5);
}

TEST(RowFile, BringsBackToTheLastBitWhatWasWrittenUnlessTheStudyHasChanged) {
  const std::string rows = "rows: [{tetrahedra: [100]}]\n";
  const std::string folder = temporary("tissue_study_rows");
  std::filesystem::remove_all(folder);
  Study study = read_study(study_with(rows));
  EXPECT_FALSE(read_row(study, 0, folder));
  RowResult written = plain_result();
  written.displacements[1].z() = 1.0 / 3.0;
  write_row(study, 0, written, folder);
  const std::optional<RowResult> read = read_row(study, 0, folder);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->displacements, written.displacements);
  EXPECT_EQ(read->force, written.force);
  EXPECT_EQ(read->solver, "multigrid");
  study = read_study(study_with(rows, "{scene: palpate.yaml, tissue: 90}"));
  EXPECT_FALSE(read_row(study, 0, folder));
}

TEST(LeaveOut, HomogeneousTissueIsAsStiffAsItWasInTheMean) {
  const auto body = body_of(tissue_test::refined_ball(0.015));
  SceneDescription scene = parse_scene(
      "model: corotational\nmaterial: {young: [[60, 1e3], [255, 9e3]]}\n"
      "effects: [density_response, inertia, damping]\n");
  const SceneDescription without = leave_out(scene, "density_response", body);
  ASSERT_EQ(without.material.young.size(), 1u);
  // A ball of a third of the radius is a 27th of the volume.
  EXPECT_NEAR(without.material.young[0][1], 1e3 + 8e3 / 27.0, 150.0);
  EXPECT_EQ(without.effects.size(), 2u);
  const std::vector<Effect> left = leave_out(scene, "inertia", body).effects;
  ASSERT_EQ(left.size(), 1u);
  EXPECT_STREQ(left[0].name(), "density_response");
  EXPECT_EQ(refusal([&] { leave_out(scene, "gravity", body); }),
            "E_PARAM: without: scene scene does not name gravity");
}

// Each tet's density as its volume within 10 mm of the origin says, of voxels without end.
Body sharp_ball(double spacing) {
  Body body = body_of(tissue_test::refined_ball(spacing, 1));
  constexpr int kParts = 12;
  for (std::size_t t = 0; t < body.tets.size(); ++t) {
    std::array<Vec3, 4> corners;
    for (std::size_t k = 0; k < 4; ++k) corners[k] = body.rest[body.tets[t][k]].cast<double>();
    int inside = 0, all = 0;
    for (int i = 0; i < kParts; ++i) {
      for (int j = 0; i + j < kParts; ++j) {
        for (int k = 0; i + j + k < kParts; ++k, ++all) {
          const double a = (i + 0.25) / kParts, b = (j + 0.25) / kParts, c = (k + 0.25) / kParts;
          const Vec3 place =
              a * corners[0] + b * corners[1] + c * corners[2] + (1.0 - a - b - c) * corners[3];
          inside += place.norm() < 0.010;
        }
      }
    }
    body.tet_densities[t] = 60.0f + 195.0f * static_cast<float>(inside) / static_cast<float>(all);
  }
  return body;
}

// Of a study's reference on the tumour sphere, whose exact displacements are known.
RowResult tumour_sphere(double spacing, const tissue_test::TumourSphere& exact,
                        const std::vector<Vec3>& points) {
  const Material material = {{{60.0, 3e3}, {255.0, 6e4}}, 0.3, 1000.0};
  tissue_test::Problem problem(sharp_ball(spacing), 2, Constitution::kNeoHookean, material);
  const std::vector<std::uint8_t> held = tissue_test::boundary_nodes(problem);
  for (std::size_t node = 0; node < held.size(); ++node) {
    if (held[node] != 0) problem.move(node, exact.displacement(problem.elements.rest()[node]));
  }
  EXPECT_TRUE(problem.solve(held).converged);
  RowResult result;
  for (const TetPlace& place : material_places(problem.body, points)) {
    Vec3& now = result.displacements.emplace_back(Vec3::Zero());
    for (const NodeWeight& of : problem.elements.shape_at(place.tet, place.barycentric)) {
      now += of.weight * problem.positions.segment<3>(3 * Eigen::Index{of.node});
    }
  }
  for (std::size_t i = 0; i < points.size(); ++i) result.displacements[i] -= points[i];
  return result;
}

TEST(Reference, ErrsLessOnTheTumourSphereThanItClaims) {
  const tissue_test::TumourSphere exact(0.010, 0.030, 1e-6, lame_of(3e3, 0.3), lame_of(6e4, 0.3));
  std::vector<Vec3> points;
  for (double x = -0.027; x < 0.028; x += 0.003) {
    for (double y = -0.027; y < 0.028; y += 0.003) {
      for (double z = -0.027; z < 0.028; z += 0.003) {
        if (Vec3(x, y, z).norm() < 0.028) points.emplace_back(x, y, z);
      }
    }
  }
  RowResult truth;
  for (const Vec3& point : points) truth.displacements.push_back(exact.displacement(point));
  const RowResult check = tumour_sphere(0.010, exact, points),
                  reference = tumour_sphere(0.005, exact, points);
  const double claimed = claimed_error(reference, check).displacement;
  const double error = difference(reference, truth).displacement;
  EXPECT_LT(error, claimed);
  EXPECT_LT(claimed, 0.15);
  std::printf("reference on the tumour sphere: claims %.2f %%, errs by %.2f %%\n", 100.0 * claimed,
              100.0 * error);
}

}  // namespace
