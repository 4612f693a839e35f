#include "tissue/study/study.h"

#include "tissue/base/error.h"

namespace tissue {
namespace {

std::optional<std::size_t> row_for(const Study& study, RowPurpose purpose, std::size_t problem) {
  for (std::size_t i = 0; i < study.rows.size(); ++i) {
    if (study.rows[i].purpose == purpose && study.rows[i].problem == problem) return i;
  }
  return std::nullopt;
}

bool same_but_for_effects(const StudyRow& a, const StudyRow& b) {
  return a.problem == b.problem && a.mesh == b.mesh && a.tetrahedra == b.tetrahedra &&
         a.model == b.model && a.element_order == b.element_order;
}

}  // namespace

const char* name(RowPurpose purpose) {
  switch (purpose) {
    case RowPurpose::kMeasure: return "measure";
    case RowPurpose::kReference: return "reference";
    case RowPurpose::kCheck: return "check";
    case RowPurpose::kRepeat: return "repeat";
  }
  return "";
}

std::string describe(const Study& study, const StudyRow& row) {
  return std::string(row.purpose == RowPurpose::kMeasure ? ""
                                                         : name(row.purpose) + std::string(": ")) +
         study.problems[row.problem].name + ", " + study.meshes[row.mesh].name + ", " +
         std::to_string(row.tetrahedra) + " tets, " + name(row.model) + " of order " +
         std::to_string(row.element_order) +
         (row.without ? std::string(", without ") + *row.without : "");
}

std::string source_of(const Study& study, const StudyRow& row) {
  const SamplePointOptions& points = study.points;
  return describe(study, row) + '\n' + study.problems[row.problem].source + '\n' +
         study.meshes[row.mesh].source + '\n' + std::to_string(points.organ) + ' ' +
         std::to_string(points.tumour) + ' ' + to_text(points.tumour_above) + ' ' +
         std::to_string(study.threads);
}

std::size_t reference_of(const Study& study, std::size_t row) {
  const StudyRow& asked = study.rows[row];
  if (!study.against_all_effects) {
    return row_for(study, RowPurpose::kReference, asked.problem).value_or(row);
  }
  for (std::size_t i = 0; i < study.rows.size(); ++i) {
    const StudyRow& other = study.rows[i];
    const bool measured = other.purpose == RowPurpose::kMeasure;
    if (measured && !other.without && same_but_for_effects(other, asked)) return i;
  }
  return row;
}

std::optional<std::size_t> check_of(const Study& study, std::size_t row) {
  return row_for(study, RowPurpose::kCheck, study.rows[row].problem);
}

}  // namespace tissue
