#include "tissue/study/study_table.h"

#include "tissue/base/error.h"
#include "tissue/simulate/scene_run.h"

#include <algorithm>
#include <cmath>

namespace tissue {
namespace {

using Results = std::vector<std::optional<RowResult>>;

double relative(const std::vector<Vec3>& values, const std::vector<Vec3>& reference) {
  double of_difference = 0.0, of_reference = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    of_difference += (values[i] - reference[i]).squaredNorm();
    of_reference += reference[i].squaredNorm();
  }
  return of_difference == 0.0 ? 0.0 : std::sqrt(of_difference / of_reference);
}

// Fields of a line, separated by commas.
class Line {
 public:
  Line& add(const std::string& text) {
    text_ += (text_.empty() ? "" : ",") + quoted(text);
    return *this;
  }
  Line& add(double value) { return add(to_text(value)); }
  Line& add(std::optional<double> value) { return add(value ? to_text(*value) : ""); }
  Line& count(std::uint64_t value) { return add(std::to_string(value)); }
  const std::string& text() const { return text_; }

 private:
  static std::string quoted(const std::string& text) {
    if (text.find_first_of(",\"\n") == std::string::npos) return text;
    std::string result = "\"";
    for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
    return result + '"';
  }
  std::string text_;
};

constexpr const char* kHead =
    "row,purpose,problem,mesh,model,element_order,without,tetrahedra_asked,tetrahedra,vertices,"
    "nodes,status,reason,error_displacement_percent,error_tumour_m,error_force_percent,"
    "error_volume_points,volume_change_percent,tumour_displacement_m,force_n,"
    "reference_displacement_percent,reference_tumour_m,reference_force_percent,resolved,"
    "meshing_seconds,setup_seconds,step_seconds_median,step_seconds_p99,steps,bytes,iterations,"
    "solver,min_det_f,inverted,run_seconds,effect_costs";

// An error is resolved if halving the reference's edges again, which at first order changes it by
// half of what it changed last, a quarter of what it claims, changes it by less than a fifth.
bool resolved(double error, double claimed) { return 0.25 * claimed < 0.2 * error; }

// Such as "gravity 0.0017 s 99192 B; contact 0.0029 s 185216 B".
std::string costs_of(const RowResult& result) {
  std::string text;
  for (const EffectCost& cost : result.effects) {
    if (!text.empty()) text += "; ";
    text += cost.name + " " + to_text(cost.seconds) + " s " + std::to_string(cost.bytes) + " B";
  }
  return text;
}

std::string line_of(const Study& study, const Results& results, std::size_t i) {
  const StudyRow& row = study.rows[i];
  const RowResult& result = *results[i];
  const auto usable = [&](std::size_t k) { return results[k] && results[k]->failure.empty(); };
  const std::size_t reference = reference_of(study, i);
  const std::optional<std::size_t> check = check_of(study, i);
  std::optional<Difference> error, own;
  if (result.failure.empty() && usable(reference)) error = difference(result, *results[reference]);
  if (check && usable(*check) && usable(reference)) {
    own = claimed_error(*results[reference], *results[*check]);
  }
  const auto percent = [](std::optional<double> part) {
    return part ? std::optional<double>(100.0 * *part) : std::nullopt;
  };
  const auto of = [](const std::optional<Difference>& d, auto field) {
    return d ? std::optional<double>((*d).*field) : std::nullopt;
  };
  const char* const status = result.failure.empty()                      ? "ok"
                             : result.failure.find("NOT_CONVERGED") == 0 ? "not_converged"
                                                                         : "failed";
  Line line;
  line.count(i).add(std::string(name(row.purpose))).add(study.problems[row.problem].name);
  line.add(study.meshes[row.mesh].name).add(std::string(name(row.model)));
  line.count(static_cast<std::uint64_t>(row.element_order));
  line.add(row.without.value_or("")).count(row.tetrahedra);
  line.count(result.tetrahedra).count(result.vertices).count(result.nodes);
  line.add(std::string(status)).add(result.failure);
  line.add(percent(of(error, &Difference::displacement))).add(of(error, &Difference::tumour));
  line.add(error ? percent(error->force) : std::nullopt);
  line.add(of(error, &Difference::volume_change)).add(result.volume_change);
  line.add(result.tumour.empty() ? std::nullopt
                                 : std::optional<double>(result.tumour.back().norm()));
  line.add(result.force.empty() ? std::nullopt : std::optional<double>(result.force.back().norm()));
  line.add(percent(of(own, &Difference::displacement))).add(of(own, &Difference::tumour));
  line.add(own ? percent(own->force) : std::nullopt);
  line.add(std::string(!error || !own                                     ? ""
                       : resolved(error->displacement, own->displacement) ? "yes"
                                                                          : "no"));
  line.add(result.meshing_seconds).add(result.setup_seconds).add(result.step_median);
  line.add(result.step_p99).count(result.steps).add(result.bytes);
  line.count(static_cast<std::uint64_t>(result.iterations)).add(result.solver);
  line.add(result.min_det_f).count(result.inverted);
  line.add(result.run_seconds).add(costs_of(result));
  return line.text();
}

}  // namespace

Difference difference(const RowResult& result, const RowResult& reference) {
  if (result.displacements.size() != reference.displacements.size() ||
      result.tumour.size() != reference.tumour.size()) {
    throw InputError(ErrorCode::kSizeMismatch, "row: its " +
                                                   std::to_string(result.displacements.size()) +
                                                   " displacements are not the reference's " +
                                                   std::to_string(reference.displacements.size()));
  }
  Difference found;
  found.displacement = relative(result.displacements, reference.displacements);
  for (std::size_t k = 0; k < result.tumour.size(); ++k) {
    found.tumour = std::max(found.tumour, (result.tumour[k] - reference.tumour[k]).norm());
  }
  if (!result.force.empty() && result.force.size() == reference.force.size()) {
    found.force = relative(result.force, reference.force);
  }
  found.volume_change = std::abs(result.volume_change - reference.volume_change);
  return found;
}

Difference claimed_error(const RowResult& reference, const RowResult& check) {
  Difference claimed = difference(check, reference);
  claimed.displacement *= 2.0;
  claimed.tumour *= 2.0;
  if (claimed.force) *claimed.force *= 2.0;
  claimed.volume_change *= 2.0;
  return claimed;
}

std::string study_table(const Study& study, const Results& results) {
  std::string table = kHead;
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (results[i]) table += '\n' + line_of(study, results, i);
  }
  return table;
}

std::optional<double> noise(const Study& study, const Results& results) {
  std::vector<double> times;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const bool repeated = study.rows[i].purpose == RowPurpose::kRepeat;
    if (repeated && results[i] && results[i]->failure.empty()) {
      times.push_back(results[i]->step_median);
    }
  }
  if (times.size() < 2) return std::nullopt;
  const auto [least, most] = std::minmax_element(times.begin(), times.end());
  return (*most - *least) / percentile(times, 0.5);
}

}  // namespace tissue
