#include "support/program.h"
#include "support/sanitizers.h"

#include <gtest/gtest.h>

#include <csignal>
#include <sstream>

namespace {

using tissue_test::Outcome;
using tissue_test::read_json;
using tissue_test::run_program;
using tissue_test::temporary;

const std::string kRoot = TISSUE_SOURCE_DIR;

Outcome accuracy_study(const std::string& arguments) {
  return run_program(ACCURACY_STUDY, arguments);
}

std::string text_of(const std::string& path) {
  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

// A handful of rows on the shipped brain, one of which asks for a model that cannot have the
// scene's effects.
std::string small_study() {
  const std::string path = temporary("tissue_small_study.yaml");
  std::ofstream(path) << "volume: " << kRoot << "/data/ch2bet.nii.gz\n"
                      << "problems: {palpate: {scene: " << kRoot << "/config/scenes/palpate.yaml,"
                      << " paths: {tool: " << kRoot << "/config/paths/palpate_tumour.csv},"
                      << " tumours: [[0.002, -0.020, 0.045, 0.012, 255]]},"
                      << " tilt: {scene: " << kRoot << "/config/scenes/tilt.yaml,"
                      << " tumours: [[0.002, -0.020, 0.045, 0.012, 255]]}}\n"
                      << "points: 2000\n"
                      << "meshes: {uniform: {method: uniform}, strain: {method: strain}}\n"
                      << "reference: {mesh: uniform, tetrahedra: 4000}\n"
                      << "rows:\n"
                      << "  - {problems: [palpate], tetrahedra: [1000]}\n"
                      << "  - {problems: [tilt], meshes: [uniform], tetrahedra: [300],"
                      << " models: [closed_form]}\n";
  return path;
}

// Columns that say what was found, not what it cost.
std::vector<std::string> errors_in(const std::string& table) {
  std::vector<std::string> lines;
  std::stringstream stream(table);
  for (std::string line; std::getline(stream, line);) {
    std::stringstream fields(line);
    std::string kept, field;
    for (int i = 0; i < 24 && std::getline(fields, field, ','); ++i) kept += field + ",";
    lines.push_back(kept);
  }
  return lines;
}

TEST(AccuracyStudy, RunsEveryRowSaysWhyOneFailedAndGivesTheSameErrorsAgain) {
  const std::string study = small_study();
  std::vector<std::string> errors;
  for (const char* name : {"tissue_study_a", "tissue_study_b"}) {
    const std::string folder = temporary(name);
    std::filesystem::remove_all(folder);
    const Outcome outcome = accuracy_study(study + " -o " + folder);
    ASSERT_EQ(outcome.code, 0) << outcome.output;
    EXPECT_NE(outcome.output.find("7 of 7 rows"), std::string::npos) << outcome.output;
    const std::string table = text_of(folder + "/results.csv");
    EXPECT_NE(table.find("failed,E_SCENE: model closed_form cannot have the effect"),
              std::string::npos)
        << table;
    EXPECT_EQ(read_json(folder + "/study.json")["rows_there"], 7);
    if (errors.empty()) {
      errors = errors_in(table);
    } else {
      EXPECT_EQ(errors_in(table), errors);
    }
  }
  EXPECT_EQ(errors.size(), 8u);
}

TEST(AccuracyStudy, AKilledStudyResumesWithTheRowsThatItHas) {
  const std::string study = small_study(), folder = temporary("tissue_study_killed");
  std::filesystem::remove_all(folder);
  ASSERT_EQ(accuracy_study(study + " -o " + folder + " --row 4").code, 0);
  const std::string kept = folder + "/rows/row_0004.json";
  const auto written = std::filesystem::last_write_time(kept);
  // What a killed row leaves behind.
  std::ofstream(folder + "/rows/row_0000.json.part") << "{\"source\": \"";
  std::ofstream(folder + "/rows/row_0001.json") << "{\"source\": \"";
  const Outcome merged = accuracy_study(study + " -o " + folder + " --merge");
  EXPECT_NE(merged.output.find("1 of 7 rows"), std::string::npos) << merged.output;
  const Outcome outcome = accuracy_study(study + " -o " + folder + " --jobs 2");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_NE(outcome.output.find("1 rows are there already"), std::string::npos) << outcome.output;
  EXPECT_NE(outcome.output.find("7 of 7 rows"), std::string::npos) << outcome.output;
  EXPECT_EQ(std::filesystem::last_write_time(kept), written);
}

TEST(AccuracyStudy, ARowWithoutMemoryIsARowWithItsReason) {
  if (tissue_test::kSanitized) GTEST_SKIP() << "a sanitizer needs the address space";
  const std::string folder = temporary("tissue_study_starved");
  std::filesystem::remove_all(folder);
  // Address space in kilobytes: enough to start with, too little to factorise. (OpenBLAS would ask
  // for its buffers for ever.)
  const Outcome outcome =
      run_program("ulimit -v 250000; timeout 120 " + std::string(ACCURACY_STUDY),
                  small_study() + " -o " + folder);
  EXPECT_EQ(outcome.code, 0) << outcome.output;
  EXPECT_NE(outcome.output.find("7 of 7 rows"), std::string::npos) << outcome.output;
  EXPECT_NE(text_of(folder + "/results.csv").find("E_NOMEM: out of memory"), std::string::npos);
}

TEST(AccuracyStudy, ListsItsRowsAndRefusesWhatItDoesNotKnow) {
  const std::string study = small_study(), folder = temporary("tissue_study_list");
  std::filesystem::remove_all(folder);
  const Outcome list = accuracy_study(study + " -o " + folder + " --list");
  EXPECT_EQ(list.code, 0);
  EXPECT_EQ(list.output.substr(0, list.output.find('\n')),
            "0\treference: palpate, uniform, 4000 tets, neo_hookean of order 2");
  EXPECT_FALSE(std::filesystem::exists(folder));
  EXPECT_EQ(accuracy_study(study + " -o " + folder + " --row 7").output,
            "accuracy_study: E_PARAM: --row: 7 is not below 7\n");
  EXPECT_EQ(accuracy_study(study).code, 2);
  EXPECT_EQ(accuracy_study("nowhere.yaml -o " + folder).output,
            "accuracy_study: E_FILE: study: 'nowhere.yaml' cannot be read\n");
  for (const char* shipped : {"quick", "brain", "claim", "effects"}) {
    EXPECT_EQ(
        accuracy_study(kRoot + "/config/studies/" + shipped + ".yaml -o " + folder + " --list")
            .code,
        0)
        << shipped;
  }
}

}  // namespace
