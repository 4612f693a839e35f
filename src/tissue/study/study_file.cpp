#include "tissue/study/study_file.h"

#include "tissue/base/yaml_reader.h"
#include "tissue/simulate/material_reader.h"
#include "tissue/simulate/scene_file.h"

#include <algorithm>
#include <filesystem>
#include <set>

namespace tissue {
namespace {

namespace fs = std::filesystem;

constexpr double kHuge = 1e12;

class StudyFile {
 public:
  explicit StudyFile(const std::string& path)
      : folder_(fs::path(path).parent_path()),
        file_(text_of_file(path, "study"), {"study", ErrorCode::kParam}) {}

  Study read() {
    file_.require_keys({"name", "volume", "iso", "smoothing", "tumour_above", "points", "threads",
                        "problems", "meshes", "reference", "repeats", "rows"});
    if (file_.has("name")) study_.name = file_.at("name").word();
    SamplePointOptions& points = study_.points;
    if (file_.has("points")) {
      points.organ = static_cast<int>(file_.at("points").whole(100, 10000000));
    }
    if (file_.has("tumour_above")) {
      points.tumour_above = file_.at("tumour_above").number(0.0, kHuge);
    }
    if (file_.has("threads")) study_.threads = static_cast<int>(file_.at("threads").whole(1, 1024));
    volume_ = in_folder(file_.at("volume").word());
    if (!fs::exists(volume_)) {
      file_.at("volume").refuse(ErrorCode::kFile, "'" + volume_ + "' does not exist");
    }
    if (file_.has("iso")) iso_ = file_.at("iso").number(-kHuge, kHuge);
    if (file_.has("smoothing")) smoothing_ = file_.at("smoothing").number(0.0, 20.0);
    for (const YamlReader& problem : file_.at("problems").members()) read_problem(problem);
    for (const YamlReader& mesh : file_.at("meshes").members()) read_mesh(mesh);
    if (file_.has("reference")) read_reference(file_.at("reference"));
    std::vector<StudyRow> rows;
    for (const YamlReader& combination : file_.at("rows").entries()) {
      for (const StudyRow& row : rows_of(combination)) rows.push_back(row);
    }
    if (rows.empty()) file_.at("rows").refuse("has no entries");
    add_repeats(rows);
    study_.rows.insert(study_.rows.end(), rows.begin(), rows.end());
    return std::move(study_);
  }

 private:
  std::string in_folder(const std::string& name) const { return (folder_ / name).string(); }

  void read_problem(const YamlReader& reader) {
    reader.require_keys({"scene", "paths", "tumours", "tissue", "young"});
    StudyProblem problem;
    problem.name = reader.key();
    problem.volume = volume_;
    problem.iso_value = iso_;
    problem.smoothing = smoothing_;
    const std::string scene_path = in_folder(reader.at("scene").word());
    const std::string scene_text = text_of_file(scene_path, "scene");
    problem.source = volume_ + ' ' + std::to_string(fs::file_size(volume_)) + ' ' + to_text(iso_) +
                     ' ' + to_text(smoothing_) + '\n' + reader.text() + '\n' + scene_text;
    SceneDescription& scene = problem.motion.scene;
    scene = parse_scene(scene_text);
    std::vector<std::vector<StampedPose>> paths(scene.tools.size());
    if (reader.has("paths")) {
      for (const YamlReader& path : reader.at("paths").members()) {
        const std::string file = in_folder(path.word());
        const std::size_t tool = tool_named(path, scene);
        paths[tool] = read_poses(file);
        problem.source += text_of_file(file, "path");
      }
    }
    problem.motion.instants = instants_of(scene, paths);
    if (reader.has("tumours")) {
      for (const YamlReader& tumour : reader.at("tumours").entries()) {
        const std::vector<YamlReader> v = tumour.entries();
        if (v.size() != 5) tumour.refuse("is not a tumour [x, y, z, radius, value]");
        const auto number = [&](std::size_t i) { return v[i].number(-kHuge, kHuge); };
        problem.tumours.push_back({{number(0), number(1), number(2)}, number(3), number(4)});
      }
    }
    if (reader.has("tissue")) problem.tissue = reader.at("tissue").number(-kHuge, kHuge);
    if (reader.has("young")) {
      scene.material.young = young_from(reader.at("young"), scene.has<DensityResponseOptions>());
    }
    study_.problems.push_back(std::move(problem));
  }

  static std::size_t tool_named(const YamlReader& path, const SceneDescription& scene) {
    for (std::size_t i = 0; i < scene.tools.size(); ++i) {
      if (scene.tools[i].name == path.key()) return i;
    }
    path.refuse("scene " + scene.name + " has no tool of that name");
  }

  void read_mesh(const YamlReader& reader) {
    reader.require_keys({"method", "sections", "base_level", "smooth_levels", "keep_interfaces",
                         "project_boundary"});
    StudyMesh mesh;
    mesh.name = reader.key();
    mesh.source = reader.text();
    std::string method = reader.at("method").word();
    if (method == "border") mesh.wishes = Wishes::kBorder;
    if (method == "tissue") mesh.wishes = Wishes::kTissue;
    if (mesh.wishes != Wishes::kStrain) method = "strain";
    const std::optional<Method> known = method_named(method);
    if (!known)
      reader.at("method").refuse("'" + method + "' is not one of " + method_names() +
                                 ", nor one of the experiments border and tissue");
    MeshOptions& options = mesh.options;
    options.method = *known;
    const auto whole = [&](const char* key, int& value, int lowest, int highest) {
      if (reader.has(key)) value = static_cast<int>(reader.at(key).whole(lowest, highest));
    };
    whole("sections", options.levels.sections, 1, 255);
    whole("base_level", options.levels.base_level, 0, 20);
    whole("smooth_levels", options.levels.smooth_levels, 0, 100);
    if (reader.has("keep_interfaces")) {
      options.keep_interfaces = reader.at("keep_interfaces").flag();
    }
    if (reader.has("project_boundary")) {
      options.project_boundary = reader.at("project_boundary").flag();
    }
    study_.meshes.push_back(std::move(mesh));
  }

  // References are rows too, so that they can be made wherever rows are.
  void read_reference(const YamlReader& reader) {
    if (reader.is_word()) {
      if (reader.word() != "all_effects") {
        reader.refuse("'" + reader.word() + "' is neither all_effects nor {mesh, tetrahedra}");
      }
      study_.against_all_effects = true;
      return;
    }
    reader.require_keys({"mesh", "tetrahedra"});
    StudyRow row;
    row.mesh = number_of(reader.at("mesh"), study_.meshes);
    row.element_order = 2;
    const auto fine = static_cast<std::uint64_t>(reader.at("tetrahedra").whole(1000, 100000000));
    for (row.problem = 0; row.problem < study_.problems.size(); ++row.problem) {
      row.purpose = RowPurpose::kReference;
      row.tetrahedra = fine;
      study_.rows.push_back(row);
      row.purpose = RowPurpose::kCheck;
      row.tetrahedra = fine / 8;
      study_.rows.push_back(row);
    }
  }

  template <class Named>
  static std::size_t number_of(const YamlReader& word, const std::vector<Named>& all) {
    std::string list;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (all[i].name == word.word()) return i;
      list += " " + all[i].name;
    }
    word.refuse("'" + word.word() + "' is not one of" + list);
  }

  // The numbers of those that a list names; of all without one.
  template <class Named>
  static std::vector<std::size_t> chosen(const YamlReader& combination, const char* key,
                                         const std::vector<Named>& all) {
    std::vector<std::size_t> result;
    if (!combination.has(key)) {
      for (std::size_t i = 0; i < all.size(); ++i) result.push_back(i);
      return result;
    }
    for (const YamlReader& entry : combination.at(key).entries()) {
      result.push_back(number_of(entry, all));
    }
    return result;
  }

  // What a list gives for each entry that is not the word `scene`, which stands for the scene's
  // own.
  template <class Value, class Read>
  static std::vector<Value> values(const YamlReader& combination, const char* key, Value own,
                                   const Read& read) {
    if (!combination.has(key)) return {own};
    std::vector<Value> result;
    for (const YamlReader& entry : combination.at(key).entries()) {
      result.push_back(entry.word() == "scene" ? own : read(entry));
    }
    return result;
  }

  // Every combination of what the lists name.
  std::vector<StudyRow> rows_of(const YamlReader& combination) const {
    combination.require_keys({"problems", "meshes", "tetrahedra", "models", "orders", "without"});
    std::vector<StudyRow> rows;
    for (const std::size_t problem : chosen(combination, "problems", study_.problems)) {
      const SceneDescription& scene = study_.problems[problem].motion.scene;
      const auto models = values(combination, "models", scene.model, [](const YamlReader& entry) {
        for (const Model model : all_models()) {
          if (entry.word() == name(model)) return model;
        }
        entry.refuse("'" + entry.word() + "' is not a model");
      });
      const auto orders =
          values(combination, "orders", scene.element_order,
                 [](const YamlReader& entry) { return static_cast<int>(entry.whole(1, 2)); });
      for (const std::size_t mesh : chosen(combination, "meshes", study_.meshes)) {
        for (const YamlReader& tets : combination.at("tetrahedra").entries()) {
          StudyRow row;
          row.problem = problem;
          row.mesh = mesh;
          row.tetrahedra = static_cast<std::uint64_t>(tets.whole(24, 100000000));
          for (const Model model : models) {
            for (const int order : orders) {
              row.model = model;
              row.element_order = order;
              for (const std::optional<std::string>& effect : left_out(combination, scene)) {
                row.without = effect;
                rows.push_back(row);
              }
            }
          }
        }
      }
    }
    return rows;
  }

  // `nothing`, the name of an effect, or `each` for all that the scene names, one at a time.
  static std::vector<std::optional<std::string>> left_out(const YamlReader& combination,
                                                          const SceneDescription& scene) {
    if (!combination.has("without")) return {std::nullopt};
    std::vector<std::optional<std::string>> result;
    for (const YamlReader& entry : combination.at("without").entries()) {
      const std::string word = entry.word();
      if (word == "nothing") {
        result.push_back(std::nullopt);
      } else if (word == "each") {
        for (const Effect& effect : scene.effects) result.push_back(effect.name());
      } else {
        const std::vector<std::string> all = effect_names();
        if (std::find(all.begin(), all.end(), word) == all.end()) {
          entry.refuse("'" + word + "' is not nothing, each or an effect");
        }
        result.push_back(word);
      }
    }
    return result;
  }

  // The first row again, in the beginning, in the middle and at the end.
  void add_repeats(std::vector<StudyRow>& rows) const {
    const std::int64_t count = file_.has("repeats") ? file_.at("repeats").whole(0, 100) : 0;
    StudyRow repeat = rows.front();
    repeat.purpose = RowPurpose::kRepeat;
    const std::size_t measured = rows.size();
    for (std::int64_t i = count; i-- > 0;) {
      const auto at = static_cast<std::ptrdiff_t>(
          count == 1 ? 0 : static_cast<std::int64_t>(measured) * i / (count - 1));
      rows.insert(rows.begin() + at, repeat);
    }
  }

  fs::path folder_;
  YamlReader file_;
  Study study_;
  std::string volume_;
  double iso_ = 20.0, smoothing_ = 0.0;
};

}  // namespace

Study read_study(const std::string& path) { return StudyFile(path).read(); }

}  // namespace tissue
