#include "tissue/study/row_file.h"

#include "tissue/base/error.h"
#include "tissue/base/atomic_file.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <filesystem>
#include <fstream>

namespace tissue {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

std::string path_of(std::size_t row, const std::string& folder, const char* ending) {
  char name[32];
  std::snprintf(name, sizeof(name), "row_%04zu%s", row, ending);
  return (fs::path(folder) / name).string();
}

void write_whole(const std::string& path, const char* data, std::size_t size) {
  AtomicFile whole(path);
  std::ofstream file(whole.temporary(), std::ios::binary);
  file.write(data, static_cast<std::streamsize>(size));
  file.close();
  if (!file) throw InputError(ErrorCode::kIo, "output: '" + path + "' cannot be written");
  whole.commit();
}

void append(std::vector<double>& values, const std::vector<Vec3>& vectors) {
  for (const Vec3& v : vectors) values.insert(values.end(), v.data(), v.data() + 3);
}

std::vector<Vec3> taken(const std::vector<double>& values, std::size_t begin, std::size_t count) {
  std::vector<Vec3> vectors;
  for (std::size_t i = 0; i < count; ++i) {
    vectors.emplace_back(values[begin + 3 * i], values[begin + 3 * i + 1],
                         values[begin + 3 * i + 2]);
  }
  return vectors;
}

std::vector<double> read_samples(const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) return {};
  std::vector<double> values(static_cast<std::size_t>(file.tellg()) / sizeof(double));
  file.seekg(0);
  file.read(reinterpret_cast<char*>(values.data()),
            static_cast<std::streamsize>(values.size() * sizeof(double)));
  return file ? values : std::vector<double>();
}

}  // namespace

void write_row(const Study& study, std::size_t row, const RowResult& result,
               const std::string& folder) {
  std::error_code failed;
  fs::create_directories(folder, failed);
  std::vector<double> samples;
  append(samples, result.displacements);
  append(samples, result.tumour);
  append(samples, result.force);
  write_whole(path_of(row, folder, ".f64"), reinterpret_cast<const char*>(samples.data()),
              samples.size() * sizeof(double));
  json effects = json::array();
  for (const EffectCost& cost : result.effects) {
    effects.push_back({cost.name, cost.seconds, cost.bytes});
  }
  const std::string text = json{
      {"source", source_of(study, study.rows[row])},
      {"row", describe(study, study.rows[row])},
      {"failure", result.failure},
      {"tetrahedra", result.tetrahedra},
      {"vertices", result.vertices},
      {"nodes", result.nodes},
      {"meshing_seconds", result.meshing_seconds},
      {"setup_seconds", result.setup_seconds},
      {"step_median", result.step_median},
      {"step_p99", result.step_p99},
      {"steps", result.steps},
      {"bytes", result.bytes},
      {"run_seconds", result.run_seconds},
      {"effects", effects},
      {"iterations", result.iterations},
      {"solver", result.solver},
      {"min_det_f", result.min_det_f},
      {"inverted", result.inverted},
      {"volume_change", result.volume_change},
      {"displacements", result.displacements.size()},
      {"tumour", result.tumour.size()},
      {"force",
       result.force.size()}}.dump(2);
  write_whole(path_of(row, folder, ".json"), text.data(), text.size());
}

std::optional<RowResult> read_row(const Study& study, std::size_t row, const std::string& folder) {
  std::ifstream file(path_of(row, folder, ".json"));
  const json figures = json::parse(file, nullptr, false);
  if (figures.is_discarded()) return std::nullopt;
  try {
    if (figures.at("source") != source_of(study, study.rows[row])) return std::nullopt;
    RowResult result;
    figures.at("failure").get_to(result.failure);
    figures.at("tetrahedra").get_to(result.tetrahedra);
    figures.at("vertices").get_to(result.vertices);
    figures.at("nodes").get_to(result.nodes);
    figures.at("meshing_seconds").get_to(result.meshing_seconds);
    figures.at("setup_seconds").get_to(result.setup_seconds);
    figures.at("step_median").get_to(result.step_median);
    figures.at("step_p99").get_to(result.step_p99);
    figures.at("steps").get_to(result.steps);
    figures.at("bytes").get_to(result.bytes);
    figures.at("run_seconds").get_to(result.run_seconds);
    for (const json& cost : figures.at("effects")) {
      result.effects.push_back({cost.at(0), cost.at(1), cost.at(2)});
    }
    figures.at("iterations").get_to(result.iterations);
    figures.at("solver").get_to(result.solver);
    figures.at("min_det_f").get_to(result.min_det_f);
    figures.at("inverted").get_to(result.inverted);
    figures.at("volume_change").get_to(result.volume_change);
    const auto displacements = figures.at("displacements").get<std::size_t>();
    const auto tumour = figures.at("tumour").get<std::size_t>();
    const auto force = figures.at("force").get<std::size_t>();
    const std::vector<double> samples = read_samples(path_of(row, folder, ".f64"));
    if (samples.size() != 3 * (displacements + tumour + force)) return std::nullopt;
    result.displacements = taken(samples, 0, displacements);
    result.tumour = taken(samples, 3 * displacements, tumour);
    result.force = taken(samples, 3 * (displacements + tumour), force);
    return result;
  } catch (const json::exception&) {
    return std::nullopt;
  }
}

}  // namespace tissue
