#include "mesh_volume_arguments.h"

#include "tissue/base/error.h"

#include <cmath>
#include <sstream>

namespace tissue_tools {
namespace {

namespace po = boost::program_options;
using tissue::ErrorCode;
using tissue::InputError;

// The numbers of a list such as "0.01,0.02,0.03".
std::vector<double> numbers(const std::string& option, const std::string& text, std::size_t count) {
  std::vector<double> values;
  std::stringstream stream(text);
  std::string part;
  while (std::getline(stream, part, ',')) {
    char* end = nullptr;
    values.push_back(std::strtod(part.c_str(), &end));
    if (part.empty() || *end != '\0') values.back() = std::nan("");
  }
  for (const double value : values) {
    if (!std::isfinite(value)) values.clear();
  }
  if (values.size() != count) {
    throw InputError(ErrorCode::kParam, "--" + option + ": '" + text + "' is not a list of " +
                                            std::to_string(count) + " numbers");
  }
  return values;
}

int whole_number(const std::string& option, const std::string& text, double lowest,
                 double highest) {
  const double value = numbers(option, text, 1)[0];
  if (value != std::floor(value) || value < lowest || value > highest) {
    throw InputError(option == "sections"  ? ErrorCode::kN
                     : option == "initial" ? ErrorCode::kNTinit
                                           : ErrorCode::kParam,
                     "--" + option + ": '" + text + "' is not a whole number within " +
                         tissue::to_text(lowest) + " to " + tissue::to_text(highest));
  }
  return static_cast<int>(value);
}

tissue::Tumour tumour_from(const std::string& text) {
  const std::vector<double> v = numbers("tumour", text, 5);
  return {tissue::Vec3(v[0], v[1], v[2]), v[3], v[4]};
}

// The place of `word` among `words`.
std::size_t chosen(const po::variables_map& given, const std::string& option,
                   const std::vector<std::string>& words) {
  const auto& word = given[option].as<std::string>();
  std::string list;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (word == words[i]) return i;
    list += (i == 0 ? "" : i + 1 < words.size() ? ", " : " or ") + words[i];
  }
  throw InputError(ErrorCode::kParam, "--" + option + ": '" + word + "' is not " + list);
}

tissue::Component component_from(const std::string& text) {
  tissue::Component component;
  if (text == "largest") return component;
  if (text == "all") {
    component.choice = tissue::Component::Choice::kAll;
    return component;
  }
  component.choice = tissue::Component::Choice::kNearest;
  try {
    const std::vector<double> place = numbers("component", text, 3);
    component.place = {place[0], place[1], place[2]};
  } catch (const InputError&) {
    throw InputError(ErrorCode::kParam, "--component: '" + text + "' is not largest, all or X,Y,Z");
  }
  return component;
}

// "1:40,2:255": label 1 has density 40, label 2 has 255.
std::map<std::int64_t, double> label_densities_from(const std::string& text) {
  std::map<std::int64_t, double> densities;
  std::stringstream stream(text);
  std::string part;
  while (std::getline(stream, part, ',')) {
    const std::size_t colon = part.find(':');
    if (colon == std::string::npos) {
      throw InputError(ErrorCode::kParam,
                       "--labels: '" + part + "' is not LABEL:DENSITY, such as 1:40,2:255");
    }
    const int label = whole_number("labels", part.substr(0, colon), -2147483647, 2147483647);
    densities[label] = numbers("labels", part.substr(colon + 1), 1)[0];
  }
  return densities;
}

}  // namespace

po::options_description mesh_volume_options() {
  const tissue::MeshOptions defaults;
  const auto text = [](double value) { return tissue::to_text(value); };
  const auto word = [] { return po::value<std::string>(); };
  const auto number = [&](double value) {
    return po::value<std::string>()->default_value(text(value));
  };
  po::options_description options(
      "mesh_volume VOLUME [options] -o OUT.vtu\n"
      "Makes a tetrahedral mesh of an organ in a CT or MR volume.\n"
      "example: mesh_volume data/ch2bet.nii.gz --iso 20 --tetrahedra 100000 -o brain.vtu\n");
  const auto add = [&](const char* name, const po::value_semantic* value, const char* help) {
    options.add_options()(name, value, help);
  };
  options.add_options()("help,h", "this text");
  add("volume", word(), "NIfTI, NRRD or MetaImage file, or folder with a DICOM series");
  add("mask", word(), "volume file on the same grid; the organ is where it is set");
  add("surface", word(), "closed PLY, STL, OBJ or VTP; the organ is inside");
  add("iso", number(defaults.iso_value),
      "without either the organ is where the value is above this");
  add("tumour", po::value<std::vector<std::string>>(),
      "X,Y,Z,R,VALUE: put in a ball of this value [m, world]");
  add("labels", word(), "LABEL:DENSITY,…: the volume holds labels with these densities");
  add("method", word()->default_value("density"),
      "density, uniform, surface, or strain: fine where a scene strains the tissue");
  add("scene", word(), "for strain: scene file");
  add("path", po::value<std::vector<std::string>>()->composing(),
      "for strain: poses of a tool as [TOOL=]POSES.csv, as for run_scene");
  add("spacing", word(), "long edge of the lattice [m]");
  add("tetrahedra", word(), "tets of the whole mesh, met within 2 %");
  add("initial", number(defaults.initial_tetrahedra),
      "without a spacing and a total: tets of the uniform stage, met within 2 %");
  add("sections", number(defaults.levels.sections),
      "N: sections of the density's distribution, so levels");
  add("base-level", number(defaults.levels.base_level), "level of the densest section");
  add("window", word(), "LO,HI: values that map to density 0 and d_max");
  add("smooth-levels", number(defaults.levels.smooth_levels),
      "rounds of averaging before levels are taken; 0 is the paper to the letter");
  options.add_options()("keep-interfaces",
                        "tets that straddle a jump of density are as fine as the softer side");
  add("component", word()->default_value("largest"),
      "largest, all, or the one nearest to X,Y,Z [m]");
  options.add_options()("no-projection", "leave boundary vertices where refinement puts them");
  add("sweeps", number(defaults.projection.sweeps), "rounds of moving boundary vertices");
  add("following-sweeps", number(defaults.projection.sweeps_after_following),
      "more rounds after inner vertices have followed; 0: they stay");
  add("stage", word()->default_value("refined"), "lattice or refined");
  add("threads", number(0), "0: all");
  add("marching-cubes", word(), "PLY, STL or VTP to write the isosurface of marching cubes to");
  add("decimate", number(1.0), "part of its triangles to keep");
  add("output,o", word(), "VTU file to write");
  add("stats", word(), "JSON file to write");
  return options;
}

MeshVolumeArguments mesh_volume_arguments(const po::variables_map& given) {
  const auto text = [&](const char* option) {
    return given.count(option) != 0 ? given[option].as<std::string>() : std::string();
  };
  const auto whole = [&](const char* option, double lowest, double highest) {
    return whole_number(option, text(option), lowest, highest);
  };
  MeshVolumeArguments result;
  result.volume = text("volume");
  result.mask = text("mask");
  result.surface = text("surface");
  result.output = text("output");
  result.stats = text("stats");
  result.marching_cubes = text("marching-cubes");
  if (result.volume.empty()) throw InputError(ErrorCode::kParam, "VOLUME: no file is given");
  if (result.output.empty()) throw InputError(ErrorCode::kParam, "-o: no output file is given");
  if (!result.mask.empty() && !result.surface.empty()) {
    throw InputError(ErrorCode::kParam, "--surface: a mask is given too; one of them is the organ");
  }
  if (given.count("tumour") != 0) {
    for (const auto& tumour : given["tumour"].as<std::vector<std::string>>()) {
      result.tumours.push_back(tumour_from(tumour));
    }
  }
  result.decimate = numbers("decimate", text("decimate"), 1)[0];
  tissue::MeshOptions& mesh = result.mesh;
  const std::optional<tissue::Method> method = tissue::method_named(text("method"));
  if (!method) {
    throw InputError(ErrorCode::kParam,
                     "--method: '" + text("method") + "' is not " + tissue::method_names());
  }
  mesh.method = *method;
  result.scene = text("scene");
  if (given.count("path") != 0) result.paths = given["path"].as<std::vector<std::string>>();
  if ((mesh.method == tissue::Method::kWished) == result.scene.empty()) {
    throw InputError(ErrorCode::kParam, mesh.method == tissue::Method::kWished
                                            ? "--scene: is missing; strain comes from a scene"
                                            : "--scene: is only for the method strain");
  }
  mesh.iso_value = numbers("iso", text("iso"), 1)[0];
  if (given.count("spacing") != 0) {
    mesh.spacing = numbers("spacing", text("spacing"), 1)[0];
    if (!(mesh.spacing > 0.0)) {
      throw InputError(ErrorCode::kParam, "--spacing: " + text("spacing") + " m is not positive");
    }
  }
  if (given.count("tetrahedra") != 0) {
    mesh.target_tetrahedra = static_cast<std::uint64_t>(whole("tetrahedra", 1, 2147483647));
  }
  mesh.initial_tetrahedra = static_cast<std::uint32_t>(whole("initial", 0, 2147483647));
  mesh.levels.sections = whole("sections", 1, 255);
  mesh.levels.base_level = whole("base-level", 0, 20);
  mesh.levels.smooth_levels = whole("smooth-levels", 0, 100);
  mesh.keep_interfaces = given.count("keep-interfaces") != 0;
  mesh.project_boundary = given.count("no-projection") == 0;
  mesh.projection.sweeps = whole("sweeps", 1, 100);
  mesh.projection.sweeps_after_following = whole("following-sweeps", 0, 100);
  result.threads = whole("threads", 0, 1024);
  if (given.count("window") != 0) {
    const std::vector<double> window = numbers("window", text("window"), 2);
    mesh.window = std::array<double, 2>{window[0], window[1]};
  }
  mesh.label_densities = label_densities_from(text("labels"));
  mesh.component = component_from(text("component"));
  mesh.lattice_only = chosen(given, "stage", {"refined", "lattice"}) == 1;
  return result;
}

}  // namespace tissue_tools
