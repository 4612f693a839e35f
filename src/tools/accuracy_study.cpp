// Measures what accuracy costs: every row of a study, each in a process of its own, and one table.
#include "program.h"
#include "tissue/base/error.h"
#include "tissue/study/row_file.h"
#include "tissue/study/study_file.h"
#include "tissue/study/study_table.h"

#include <nlohmann/json.hpp>

#include <spawn.h>
#include <sys/wait.h>

#include <chrono>
#include <cstdio>
#include <cstring>
#include <deque>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <thread>

extern char** environ;

namespace {

namespace fs = std::filesystem;
namespace po = boost::program_options;
using tissue::ErrorCode;
using tissue::InputError;

po::options_description options() {
  po::options_description all(
      "accuracy_study STUDY.yaml -o FOLDER [--list | --row K | --merge] [--jobs N]\n"
      "Runs every row of a study that FOLDER does not hold yet, and writes FOLDER/results.csv.\n"
      "example: accuracy_study config/studies/quick.yaml -o quick && scripts/plot_study quick\n"
      "on many machines: accuracy_study S.yaml -o F --list | cut -f1 |\n"
      "    parallel accuracy_study S.yaml -o F --row {} ; accuracy_study S.yaml -o F --merge\n");
  all.add_options()("study", po::value<std::string>(), "study file")(
      "output,o", po::value<std::string>(), "folder for results")(
      "list", "print number and description of every row, and run none")(
      "row", po::value<std::size_t>(), "run this row only, even if it is there")(
      "merge", "write the table of the rows that are there, and run none")(
      "jobs", po::value<int>()->default_value(1),
      "rows at a time; more disturb each other's times")("help,h", "show this");
  return all;
}

struct Places {
  std::string study_file, folder;
  std::string rows() const { return (fs::path(folder) / "rows").string(); }
};

std::vector<std::optional<tissue::RowResult>> results_in(const tissue::Study& study,
                                                         const std::string& rows) {
  std::vector<std::optional<tissue::RowResult>> results;
  for (std::size_t i = 0; i < study.rows.size(); ++i) results.push_back(read_row(study, i, rows));
  return results;
}

std::string machine() {
  std::ifstream file("/proc/cpuinfo");
  std::string model = "unknown processor";
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("model name", 0) == 0) model = line.substr(line.find(": ") + 2);
  }
  return model + ", " + std::to_string(std::thread::hardware_concurrency()) + " cores";
}

void merge(const tissue::Study& study, const Places& places) {
  const auto results = results_in(study, places.rows());
  const auto path = [&](const char* name) { return (fs::path(places.folder) / name).string(); };
  std::size_t there = 0, failed = 0;
  for (const auto& result : results) {
    there += result.has_value();
    failed += result && !result->failure.empty();
  }
  fs::create_directories(places.folder);
  tissue_tools::write_text("-o", path("results.csv"), study_table(study, results));
  const std::optional<double> noise = tissue::noise(study, results);
  tissue_tools::write_text(
      "-o", path("study.json"),
      nlohmann::json{{"name", study.name},
                     {"command", "accuracy_study " + places.study_file + " -o " + places.folder},
                     {"machine", machine()},
                     {"threads", study.threads},
                     {"rows", results.size()},
                     {"rows_there", there},
                     {"noise", noise ? nlohmann::json(*noise) : nlohmann::json()}}
          .dump(2));
  std::printf("%zu of %zu rows are in %s, %zu of them failed\n", there, results.size(),
              path("results.csv").c_str(), failed);
  if (noise)
    std::printf("step times of a row that was run again lie within %.0f %%\n", 100.0 * *noise);
}

pid_t start_row(const Places& places, std::size_t row) {
  const std::string number = std::to_string(row);
  std::vector<std::string> words = {"accuracy_study", places.study_file, "-o",
                                    places.folder,    "--row",           number};
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t child = 0;
  const int failed =
      posix_spawn(&child, "/proc/self/exe", nullptr, nullptr, arguments.data(), environ);
  if (failed != 0) throw std::runtime_error(std::string("row: ") + std::strerror(failed));
  return child;
}

// A row whose process ended without a result has one: what ended it.
void note_end(const tissue::Study& study, const Places& places, std::size_t row, int status) {
  if (read_row(study, row, places.rows())) return;
  tissue::RowResult result;
  result.failure = WIFSIGNALED(status)
                       ? std::string("killed: ") + strsignal(WTERMSIG(status))
                       : "ended with exit code " + std::to_string(WEXITSTATUS(status));
  write_row(study, row, result, places.rows());
}

void run_all(const tissue::Study& study, const Places& places, int jobs) {
  std::deque<std::size_t> waiting;
  for (std::size_t i = 0; i < study.rows.size(); ++i) {
    if (!read_row(study, i, places.rows())) waiting.push_back(i);
  }
  std::size_t done = study.rows.size() - waiting.size();
  if (done > 0) std::printf("%zu rows are there already\n", done);
  std::map<pid_t, std::size_t> running;
  while (!waiting.empty() || !running.empty()) {
    while (!waiting.empty() && running.size() < static_cast<std::size_t>(jobs)) {
      const std::size_t row = waiting.front();
      waiting.pop_front();
      running[start_row(places, row)] = row;
    }
    int status = 0;
    const pid_t child = waitpid(-1, &status, 0);
    const auto found = running.find(child);
    if (found == running.end()) continue;
    note_end(study, places, found->second, status);
    ++done;
    tissue_tools::show_progress(
        static_cast<double>(done) / static_cast<double>(study.rows.size()),
        "row " + std::to_string(done) + " of " + std::to_string(study.rows.size()));
    running.erase(found);
  }
}

void run(const po::variables_map& given) {
  const Places places = {tissue_tools::required(given, "study"),
                         tissue_tools::required(given, "output")};
  const tissue::Study study = tissue::read_study(places.study_file);
  if (given.count("list") != 0) {
    for (std::size_t i = 0; i < study.rows.size(); ++i) {
      std::printf("%zu\t%s\n", i, describe(study, study.rows[i]).c_str());
    }
  } else if (given.count("row") != 0) {
    const auto row = given["row"].as<std::size_t>();
    if (row >= study.rows.size()) {
      throw InputError(ErrorCode::kParam, "--row: " + std::to_string(row) + " is not below " +
                                              std::to_string(study.rows.size()));
    }
    write_row(study, row, run_row(study, study.rows[row]), places.rows());
  } else {
    const int jobs = given["jobs"].as<int>();
    if (jobs < 1 || jobs > 1024) {
      throw InputError(ErrorCode::kParam,
                       "--jobs: " + std::to_string(jobs) + " is not within 1 to 1024");
    }
    if (given.count("merge") == 0) run_all(study, places, jobs);
    merge(study, places);
  }
}

}  // namespace

int main(int argc, char** argv) {
  return tissue_tools::run_program("accuracy_study", options(), "study", argc, argv, run);
}
