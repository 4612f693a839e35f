// What a scene does not name is neither called nor given memory. The files that effects are made of
// are compiled into this program once more, with a call at the head and the end of each function.
#include "support/pressing_scenes.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>

#define PLAIN __attribute__((no_instrument_function))

namespace {

// Where a source file's code lies in this program, and what happened in there.
struct CodeRange {
  std::size_t begin, end;
  std::string file;
};
std::vector<CodeRange> code;
struct Counts {
  long calls = 0, allocations = 0;
};
std::vector<Counts> counts;
// Functions that are running, by their files, while counting.
int running[256];
int depth = 0;
bool is_counting = false;

PLAIN int file_of(const void* function) {
  const auto address = reinterpret_cast<std::size_t>(function);
  for (std::size_t i = 0; i < code.size(); ++i) {
    if (code[i].begin <= address && address < code[i].end) return static_cast<int>(i);
  }
  return -1;
}

PLAIN void count_allocation() {
  if (is_counting && depth > 0) ++counts[static_cast<std::size_t>(running[depth - 1])].allocations;
}

}  // namespace

// Called by what is compiled with -finstrument-functions; the C library's own allocation.
extern "C" {
PLAIN void __cyg_profile_func_enter(void* function, void*) {
  if (!is_counting) return;
  const int file = file_of(function);
  if (file < 0 || depth == 256) std::abort();
  ++counts[static_cast<std::size_t>(file)].calls;
  running[depth++] = file;
}
PLAIN void __cyg_profile_func_exit(void*, void*) {
  if (is_counting && depth > 0) --depth;
}
void* __libc_malloc(std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
PLAIN void* malloc(std::size_t size) {
  count_allocation();
  return __libc_malloc(size);
}
PLAIN void* realloc(void* old, std::size_t size) {
  count_allocation();
  return __libc_realloc(old, size);
}
PLAIN void* calloc(std::size_t count, std::size_t size) {
  count_allocation();
  return __libc_calloc(count, size);
}
}

namespace {

// The linker says where each object file's code went.
void read_map() {
  const std::string folder = "src/tissue/simulate/";
  std::ifstream map(TISSUE_LINK_MAP);
  std::string line, long_name;
  while (std::getline(map, line)) {
    // A section's name, if that is long alone in its line, address, size, file.
    std::istringstream words(std::exchange(long_name, "") + line);
    std::string section, address, size, file;
    if (!(words >> section) || section.rfind(".text", 0) != 0) continue;
    if (!(words >> address)) long_name = line;
    words >> size;
    std::getline(words, file);
    const std::size_t at = file.find(folder), end = file.rfind(".cpp.o");
    if (at == std::string::npos || end == std::string::npos) continue;
    const std::size_t begin = std::stoull(address, nullptr, 16);
    if (begin == 0) continue;
    code.push_back({begin, begin + std::stoull(size, nullptr, 16),
                    file.substr(at + folder.size(), end - at - folder.size())});
  }
}

// What an effect is made of besides its own file.
const std::map<std::string, std::vector<std::string>> kMore = {
    {"fold_guard", {"fold_guard"}},
    {"gravity", {"gravity"}},
    {"inertia", {"inertia", "dynamics"}},
    {"damping", {"damping"}},
    {"near_incompressibility", {"averaged_volume", "squared_system"}},
    {"rigid_inclusions", {"rigid_inclusions", "rigid_system"}},
    {"contact", {"contact_energy"}}};

Counts counts_of(const std::string& effect) {
  std::vector<std::string> files = {"effects/" + effect};
  const auto more = kMore.find(effect);
  if (more != kMore.end()) files.insert(files.end(), more->second.begin(), more->second.end());
  Counts sum;
  for (const std::string& file : files) {
    bool is_there = false;
    for (std::size_t i = 0; i < code.size(); ++i) {
      if (code[i].file != file) continue;
      is_there = true;
      sum.calls += counts[i].calls;
      sum.allocations += counts[i].allocations;
    }
    EXPECT_TRUE(is_there) << file;
  }
  return sum;
}

// Reads a scene, makes it, moves a tool into the organ and out again, and counts.
std::vector<tissue::EffectCost> run(const std::string& model, int order,
                                    const std::vector<std::string>& effects) {
  const auto names = [&](const char* effect) {
    return std::find(effects.begin(), effects.end(), effect) != effects.end();
  };
  std::string text =
      "model: " + model + "\nelement_order: " + std::to_string(order) + "\nmaterial: {young: " +
      (names("density_response") ? "[[60, 3e3], [255, 60e3]]" : "[[0, 5e3]]") +
      ", poisson: 0.45}\ntools: [{name: tool, shape: {sphere: 0.006}, mode: " +
      (names("contact") || model == "closed_form" ? "press" : "grasp") + "}]\n" +
      (model == "closed_form" ? "" : "anchors: [{plane: {axis: z, below: 20%}}]\n") + "effects: [";
  for (const std::string& effect : effects) {
    text +=
        effect == "rigid_inclusions" ? "{rigid_inclusions: {density_above: 75}}, " : effect + ", ";
  }
  text += "]\n";
  const auto body = tissue_test::organ();
  counts.assign(code.size(), {});
  depth = 0;
  is_counting = true;
  tissue::Scene scene(tissue::parse_scene(text), body);
  for (const double height : {0.0005, -0.0015, 0.003}) {
    scene.step(tissue_test::above(height), 0.02);
  }
  scene.reset();
  std::vector<tissue::EffectCost> costs = scene.effect_costs();
  is_counting = false;
  return costs;
}

class EffectCosts : public testing::Test {
 protected:
  static void SetUpTestSuite() { read_map(); }
};

std::vector<std::string> all_of(tissue::Model model) {
  std::vector<std::string> names;
  for (const std::string& name : tissue::effect_names()) {
    if (tissue::can_have(model, name)) names.push_back(name);
  }
  return names;
}

TEST_F(EffectCosts, WhatASceneDoesNotNameIsNeitherCalledNorGivenMemory) {
  for (const tissue::Model model : tissue::all_models()) {
    for (const int order : {1, 2}) {
      const bool has_orders =
          model != tissue::Model::kClosedForm && model != tissue::Model::kMassSpring;
      if (order == 2 && !has_orders) continue;
      const std::vector<std::string> all = all_of(model);
      for (const std::string& absent : all) {
        std::vector<std::string> others;
        for (const std::string& name : all) {
          // Damping is of what has inertia.
          if (name != absent && (name != "damping" || absent != "inertia")) others.push_back(name);
        }
        run(name(model), order, others);
        const Counts none = counts_of(absent);
        EXPECT_EQ(none.calls, 0) << name(model) << order << " without " << absent;
        EXPECT_EQ(none.allocations, 0) << name(model) << order << " without " << absent;
      }
    }
  }
}

TEST_F(EffectCosts, WhatASceneNamesIsCalledAndItsCostReported) {
  // What is no more than a question of another part has no time of its own.
  const std::vector<std::string> heavy = {"gravity",          "inertia",
                                          "damping",          "contact",
                                          "rigid_inclusions", "near_incompressibility",
                                          "force_feedback"};
  for (const tissue::Model model : tissue::all_models()) {
    const std::vector<std::string> all = all_of(model);
    const std::vector<tissue::EffectCost> costs = run(name(model), 1, all);
    ASSERT_EQ(costs.size(), all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      EXPECT_EQ(costs[i].name, all[i]);
      EXPECT_GT(counts_of(all[i]).calls, 0) << name(model) << all[i];
      if (std::find(heavy.begin(), heavy.end(), all[i]) == heavy.end()) continue;
      EXPECT_GT(costs[i].seconds, 0.0) << name(model) << all[i];
      EXPECT_GT(costs[i].bytes, 0u) << name(model) << all[i];
    }
  }
}

}  // namespace
