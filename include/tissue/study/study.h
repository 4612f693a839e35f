#pragma once

#include "tissue/field/edit_volume.h"
#include "tissue/study/sample_points.h"
#include "tissue/study/strain_mesh.h"

namespace tissue {

/// An organ with a tumour in it, and what moves it.
struct StudyProblem {
  std::string name;
  /// File, and the value above which it is organ.
  std::string volume;
  double iso_value = 20.0;
  /// The organ is where the volume exceeds the value, smoothed by a Gaussian of so many voxels:
  /// folds narrower than tets would otherwise open and close from mesh to mesh. 0: as it is.
  double smoothing = 0.0;
  /// If given, the value of all tissue but the tumours, in place of the image's.
  std::optional<double> tissue;
  std::vector<Tumour> tumours;
  SceneMotion motion;
  /// Everything that it was read from: a result made from another text is stale.
  std::string source;
};

/// What wishes levels, for meshes of method `kWished`: where the problem's scene strains the
/// tissue, or one of the experiments of tumour_wishes.h.
enum class Wishes { kStrain, kBorder, kTissue };

/// A way to mesh an organ, for any number of tets.
struct StudyMesh {
  std::string name;
  MeshOptions options;
  Wishes wishes = Wishes::kStrain;
  std::string source;
};

/// What a row is there for.
enum class RowPurpose {
  /// Of which the errors are reported.
  kMeasure,
  /// Against which errors are measured: stable neo-Hookean, quadratic, on the finest mesh.
  kReference,
  /// The same with an eighth of its tets: how far that is off says how good the reference is.
  kCheck,
  /// A row run again, to see how noisy the machine is.
  kRepeat,
};
const char* name(RowPurpose purpose);

/// One mesh, one model, one choice of effects on one problem.
struct StudyRow {
  RowPurpose purpose = RowPurpose::kMeasure;
  std::size_t problem = 0, mesh = 0;
  std::uint64_t tetrahedra = 0;
  Model model = Model::kNeoHookean;
  int element_order = 1;
  /// An effect of the scene that is left out.
  std::optional<std::string> without;
};

/// What is to be compared: a list of rows.
struct Study {
  std::string name = "study";
  std::vector<StudyProblem> problems;
  std::vector<StudyMesh> meshes;
  std::vector<StudyRow> rows;
  SamplePointOptions points;
  /// Errors are measured against the row of the same mesh and model with all effects, not against
  /// references.
  bool against_all_effects = false;
  int threads = 1;
};

/// Such as "palpate, density, 20000 tets, corotational of order 1, without gravity".
std::string describe(const Study& study, const StudyRow& row);

/// Everything on which the result of a row depends, as text.
std::string source_of(const Study& study, const StudyRow& row);

/// The number of the row against which errors of another are measured; itself where there is none.
std::size_t reference_of(const Study& study, std::size_t row);
/// Of the row whose difference from the reference says how exact that is, if there is one.
std::optional<std::size_t> check_of(const Study& study, std::size_t row);

}  // namespace tissue
