#include "check_options.h"

#include "tissue/base/error.h"
#include "tissue/base/machine_memory.h"

#include <cmath>

namespace tissue {
namespace {

// More than any method holds at its peak, which benchmarks print, with room for what an allocator
// keeps to itself.
constexpr double kBytesPerTet = 44.0;

// A mesh needs at least the tets around one lattice point.
constexpr std::uint32_t kFewestTets = 24;

[[noreturn]] void refuse(ErrorCode code, const std::string& sentence) {
  throw InputError(code, sentence);
}

}  // namespace

std::optional<Method> method_named(const std::string& name) {
  if (name == "density") return Method::kDensity;
  if (name == "uniform") return Method::kUniform;
  if (name == "surface") return Method::kSurface;
  if (name == "strain") return Method::kWished;
  return std::nullopt;
}

const char* method_names() { return "density, uniform, surface or strain"; }

void check_options(const MeshOptions& options) {
  const LevelOptions& levels = options.levels;
  if (levels.sections < 1 || levels.sections > 255) {
    refuse(ErrorCode::kN,
           "level_sections: " + std::to_string(levels.sections) + " is not within 1 to 255");
  }
  if (levels.base_level < 0 || levels.base_level > 20) {
    refuse(ErrorCode::kParam,
           "base_level: " + std::to_string(levels.base_level) + " is not within 0 to 20");
  }
  if (levels.smooth_levels < 0 || levels.smooth_levels > 100) {
    refuse(ErrorCode::kParam,
           "smooth_levels: " + std::to_string(levels.smooth_levels) + " is not within 0 to 100");
  }
  if (!(levels.d_max >= 1.0 && levels.d_max <= 65535.0 &&
        std::floor(levels.d_max) == levels.d_max)) {
    refuse(ErrorCode::kParam,
           "d_max: " + to_text(levels.d_max) + " is not a whole number within 1 to 65535");
  }
  if (!(options.spacing >= 0.0 && std::isfinite(options.spacing))) {
    refuse(ErrorCode::kParam, "spacing: " + to_text(options.spacing) + " m is not positive");
  }
  if (options.spacing > 0.0 && options.target_tetrahedra > 0) {
    refuse(ErrorCode::kParam, "target_tetrahedra: " + std::to_string(options.target_tetrahedra) +
                                  " and spacing " + to_text(options.spacing) +
                                  " m are both given; one decides the other");
  }
  if (options.target_tetrahedra > 0 && options.target_tetrahedra < kFewestTets) {
    refuse(ErrorCode::kNTinit, "target_tetrahedra: " + std::to_string(options.target_tetrahedra) +
                                   " is below " + std::to_string(kFewestTets));
  }
  if (options.target_tetrahedra > options.max_tetrahedra) {
    refuse(ErrorCode::kTooManyTets,
           "target_tetrahedra: " + std::to_string(options.target_tetrahedra) +
               " is over the limit of " + std::to_string(options.max_tetrahedra));
  }
  const bool by_initial = options.spacing == 0.0 && options.target_tetrahedra == 0;
  if (by_initial && options.initial_tetrahedra < kFewestTets) {
    refuse(ErrorCode::kNTinit, "initial_tetrahedra: " + std::to_string(options.initial_tetrahedra) +
                                   " is below " + std::to_string(kFewestTets));
  }
  if (by_initial && options.initial_tetrahedra > options.max_tetrahedra) {
    refuse(ErrorCode::kTooManyTets,
           "initial_tetrahedra: " + std::to_string(options.initial_tetrahedra) +
               " is over the limit of " + std::to_string(options.max_tetrahedra));
  }
  if (options.projection.sweeps < 1 || options.projection.sweeps > 100 ||
      options.projection.sweeps_after_following < 0 ||
      options.projection.sweeps_after_following > 100) {
    refuse(ErrorCode::kParam, "projection: " + std::to_string(options.projection.sweeps) + " and " +
                                  std::to_string(options.projection.sweeps_after_following) +
                                  " sweeps are not within 1 to 100 and 0 to 100");
  }
  if (options.method == Method::kWished && !options.wishes) {
    refuse(ErrorCode::kParam, "method: strain needs a scene");
  }
  if (!options.component.place.allFinite()) {
    refuse(ErrorCode::kParam, "component: its place is not finite");
  }
  for (const auto& [label, density] : options.label_densities) {
    if (!(density > 0.0 && density <= levels.d_max)) {
      refuse(ErrorCode::kParam, "label_densities: " + to_text(density) + " for label " +
                                    std::to_string(label) + " is not within 0 to " +
                                    to_text(levels.d_max));
    }
  }
  if (options.window) {
    const auto& [low, high] = *options.window;
    if (!std::isfinite(low) || !std::isfinite(high) || !(high > low)) {
      refuse(ErrorCode::kParam,
             "window: " + to_text(low) + " to " + to_text(high) + " is not a finite, rising range");
    }
  }
}

void check_total(const MeshOptions& options, double tetrahedra, const std::string& what) {
  if (tetrahedra > static_cast<double>(options.max_tetrahedra)) {
    refuse(ErrorCode::kTooManyTets, what + " would make about " + to_text(tetrahedra) +
                                        " tets, the limit is " +
                                        std::to_string(options.max_tetrahedra));
  }
  const double needed = kBytesPerTet * tetrahedra;
  const auto available = static_cast<double>(available_memory());
  if (needed > available) {
    refuse(ErrorCode::kNomem, what + " would make about " + to_text(tetrahedra) +
                                  " tets, which need about " + to_text(std::ceil(needed * 1e-6)) +
                                  " MB; " + to_text(std::floor(available * 1e-6)) +
                                  " MB are available");
  }
}

}  // namespace tissue
