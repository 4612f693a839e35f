// From a volume file to a mesh file, without ROS.
#include "statistics_json.h"
#include "tissue/base/error.h"
#include "tissue/base/mesh_file.h"
#include "tissue/base/stage_clock.h"
#include "tissue/field/edit_volume.h"
#include "tissue/field/read_volume.h"
#include "tissue/refine/build_mesh.h"

#include <boost/program_options.hpp>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <sstream>

namespace {

namespace po = boost::program_options;
using tissue::ErrorCode;
using tissue::InputError;

struct Arguments {
  std::string volume, mask, output, stats;
  std::vector<tissue::Tumour> tumours;
  tissue::MeshOptions mesh;
};

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

po::options_description described() {
  const tissue::MeshOptions defaults;
  const auto text = [](double value) { return tissue::to_text(value); };
  po::options_description options("mesh_volume VOLUME [options] -o OUT.vtu");
  options.add_options()("help,h", "this text")("volume", po::value<std::string>(),
                                               "NIfTI, NRRD or MetaImage file")(
      "mask", po::value<std::string>(),
      "volume file on the same grid; the organ is where it is set")(
      "iso", po::value<std::string>()->default_value(text(defaults.iso_value)),
      "without a mask the organ is where the value is above this")(
      "tumour", po::value<std::vector<std::string>>(),
      "X,Y,Z,R,VALUE: put in a ball of this value [m, world]")("spacing", po::value<std::string>(),
                                                               "long edge of the lattice [m]")(
      "initial", po::value<std::string>()->default_value(text(defaults.initial_tetrahedra)),
      "without a spacing: tets of the uniform stage, met within 2 %")(
      "sections", po::value<std::string>()->default_value(text(defaults.levels.sections)),
      "N: sections of the density's distribution, so levels")(
      "base-level", po::value<std::string>()->default_value(text(defaults.levels.base_level)),
      "level of the densest section")("window", po::value<std::string>(),
                                      "LO,HI: values that map to density 0 and d_max")(
      "smooth-levels", po::value<std::string>()->default_value(text(defaults.levels.smooth_levels)),
      "rounds of averaging before levels are taken; 0 is the paper to the letter")(
      "component", po::value<std::string>()->default_value("largest"), "largest or all")(
      "stage", po::value<std::string>()->default_value("refined"), "lattice or refined")(
      "threads", po::value<std::string>()->default_value(text(defaults.threads)), "0: all")(
      "output,o", po::value<std::string>(), "VTU file to write")("stats", po::value<std::string>(),
                                                                 "JSON file to write");
  return options;
}

tissue::Tumour tumour_from(const std::string& text) {
  const std::vector<double> v = numbers("tumour", text, 5);
  return {tissue::Vec3(v[0], v[1], v[2]), v[3], v[4]};
}

bool chosen(const po::variables_map& given, const char* option, const std::string& off,
            const std::string& on) {
  const std::string& word = given[option].as<std::string>();
  if (word != on && word != off) {
    throw InputError(ErrorCode::kParam,
                     std::string("--") + option + ": '" + word + "' is not " + off + " or " + on);
  }
  return word == on;
}

Arguments arguments_from(const po::variables_map& given) {
  const auto text = [&](const char* option) {
    return given.count(option) != 0 ? given[option].as<std::string>() : std::string();
  };
  const auto whole = [&](const char* option, double lowest, double highest) {
    return whole_number(option, text(option), lowest, highest);
  };
  Arguments result;
  result.volume = text("volume");
  result.mask = text("mask");
  result.output = text("output");
  result.stats = text("stats");
  if (result.volume.empty()) throw InputError(ErrorCode::kParam, "VOLUME: no file is given");
  if (result.output.empty()) throw InputError(ErrorCode::kParam, "-o: no output file is given");
  if (given.count("tumour") != 0) {
    for (const auto& tumour : given["tumour"].as<std::vector<std::string>>()) {
      result.tumours.push_back(tumour_from(tumour));
    }
  }
  tissue::MeshOptions& mesh = result.mesh;
  mesh.iso_value = numbers("iso", text("iso"), 1)[0];
  if (given.count("spacing") != 0) {
    mesh.spacing = numbers("spacing", text("spacing"), 1)[0];
    if (!(mesh.spacing > 0.0)) {
      throw InputError(ErrorCode::kParam, "--spacing: " + text("spacing") + " m is not positive");
    }
  }
  mesh.initial_tetrahedra = static_cast<std::uint32_t>(whole("initial", 0, 2147483647));
  mesh.levels.sections = whole("sections", 1, 255);
  mesh.levels.base_level = whole("base-level", 0, 20);
  mesh.levels.smooth_levels = whole("smooth-levels", 0, 100);
  mesh.threads = whole("threads", 0, 1024);
  if (given.count("window") != 0) {
    const std::vector<double> window = numbers("window", text("window"), 2);
    mesh.window = std::array<double, 2>{window[0], window[1]};
  }
  mesh.all_components = chosen(given, "component", "largest", "all");
  mesh.lattice_only = chosen(given, "stage", "refined", "lattice");
  return result;
}

void write_text(const std::string& path, const std::string& text) {
  std::ofstream file(path);
  file << text << '\n';
  file.close();
  if (!file) throw InputError(ErrorCode::kIo, "--stats: '" + path + "' cannot be written");
}

// What a person wants to know at once; `--stats` has it all.
void print_summary(const tissue::MeshStatistics& statistics, double meshing_seconds) {
  constexpr double kDegrees = 180.0 / 3.14159265358979323846;
  const auto tets = static_cast<double>(statistics.tetrahedra);
  const double wished = tets - static_cast<double>(statistics.closure);
  std::printf("%llu tets, %llu vertices, from %llu initial tets (closure %.1f %%)\n",
              static_cast<unsigned long long>(statistics.tetrahedra),
              static_cast<unsigned long long>(statistics.vertices),
              static_cast<unsigned long long>(statistics.initial),
              100.0 * static_cast<double>(statistics.closure) / wished);
  std::printf("dihedral angles %.1f to %.1f deg, boundary to isosurface mean %.2g m, max %.2g m\n",
              statistics.dihedral[0] * kDegrees, statistics.dihedral[1] * kDegrees,
              statistics.surface_error[0], statistics.surface_error[1]);
  std::printf("%.3f CPU s from volume to mesh: %.2f million tets per CPU s, %.0f bytes per tet\n",
              meshing_seconds, 1e-6 * tets / meshing_seconds,
              static_cast<double>(statistics.peak_bytes) / tets);
}

void run(const Arguments& arguments) {
  tissue::StageClock files;
  files.start("read");
  auto volume = std::make_shared<tissue::Volume>(tissue::read_volume(arguments.volume));
  for (const tissue::Tumour& tumour : arguments.tumours) insert_tumour(*volume, tumour);
  std::shared_ptr<tissue::Volume> mask;
  if (!arguments.mask.empty()) {
    mask = std::make_shared<tissue::Volume>(tissue::read_volume(arguments.mask));
    mask->quantity = tissue::Quantity::kLabel;
  }
  files.stop();
  tissue::BuiltMesh built = tissue::build_mesh(volume, mask, arguments.mesh);
  files.start("write");
  std::vector<tissue::TetField> further;
  if (arguments.mesh.lattice_only) {
    further.push_back({"density", built.lattice_densities});
    further.push_back({"level_wish", {built.level_wishes.begin(), built.level_wishes.end()}});
  }
  tissue::write_mesh(built.mesh, arguments.output, further);
  files.stop();

  tissue::MeshStatistics& statistics = built.mesh.statistics;
  double meshing_seconds = 0.0;
  for (const tissue::StageCost& stage : statistics.stages) meshing_seconds += stage.cpu_seconds;
  statistics.stages.insert(statistics.stages.begin(), files.stages()[0]);
  statistics.stages.push_back(files.stages()[1]);
  if (!arguments.stats.empty()) {
    write_text(arguments.stats, tissue::to_json(statistics).dump(2));
  }
  print_summary(statistics, meshing_seconds);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const po::options_description options = described();
    po::positional_options_description positions;
    positions.add("volume", 1);
    po::variables_map given;
    // Negative numbers are values, not options.
    const auto style = po::command_line_style::unix_style ^ po::command_line_style::allow_guessing;
    po::store(po::command_line_parser(argc, argv)
                  .options(options)
                  .positional(positions)
                  .style(style)
                  .run(),
              given);
    if (given.count("help") != 0) {
      std::cout << options;
      return 0;
    }
    run(arguments_from(given));
    return 0;
  } catch (const std::bad_alloc&) {
    std::cerr << "mesh_volume: out of memory\n";
  } catch (const InputError& error) {
    std::cerr << "mesh_volume: " << name(error.code()) << ": " << error.what() << '\n';
  } catch (const std::exception& error) {
    std::cerr << "mesh_volume: " << error.what() << '\n';
  }
  return 2;
}
