#include "tissue/simulate/scene.h"

#include "deformation_model.h"
#include "probe_points.h"
#include "tissue/base/error.h"

#include <cmath>
#include <utility>

namespace tissue {
namespace {

void check_pose(const ToolDescription& tool, const ToolPose& pose) {
  const std::string of_tool = "pose: that of tool " + tool.name;
  if (!pose.position.allFinite() || !pose.orientation.coeffs().allFinite()) {
    throw InputError(ErrorCode::kNonfinite, of_tool + " is not finite");
  }
  if (pose.position.cwiseAbs().maxCoeff() > kFarthestTool) {
    throw InputError(ErrorCode::kParam,
                     of_tool + " is farther than " + to_text(kFarthestTool) + " m away");
  }
}

}  // namespace

class Scene::Implementation {
 public:
  Implementation(SceneDescription scene, std::shared_ptr<const Body> body, int threads)
      : description(std::move(scene)),
        body_(std::move(body)),
        costs(description.effects),
        model(description.model == Model::kClosedForm
                  ? closed_form_model(description, *body_, costs)
                  : solid_model(description, *body_, costs, threads)),
        probes(description.probes, *body_, *model) {}

  StepReport step(const ToolPoses& tools, double dt) {
    if (!(dt >= 0.0 && std::isfinite(dt))) {
      throw InputError(ErrorCode::kDt, "dt: " + to_text(dt) + " s is not a time step");
    }
    if (tools.size() != description.tools.size()) {
      throw InputError(ErrorCode::kParam, "pose: " + std::to_string(tools.size()) + " for " +
                                              std::to_string(description.tools.size()) + " tools");
    }
    bool lost = false;
    for (std::size_t i = 0; i < tools.size(); ++i) {
      if (tools[i]) check_pose(description.tools[i], *tools[i]);
      lost = lost || !tools[i];
    }
    StepReport report = model->step(tools, dt);
    report.tool_lost = lost;
    return report;
  }

  const Body& body() const { return *body_; }

  // Models keep references to these.
  const SceneDescription description;

 private:
  std::shared_ptr<const Body> body_;

 public:
  EffectCosts costs;
  std::unique_ptr<DeformationModel> model;
  ProbePoints probes;
};

Scene::Scene(SceneDescription description, std::shared_ptr<const Body> body, int threads)
    : implementation_(
          std::make_unique<Implementation>(std::move(description), std::move(body), threads)) {}
Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

StepReport Scene::step(const ToolPoses& tools, double dt) {
  return implementation_->step(tools, dt);
}
void Scene::reset() { implementation_->model->reset(); }
const SceneDescription& Scene::description() const { return implementation_->description; }
const State& Scene::state() const { return implementation_->model->state(); }
const Body& Scene::body() const { return implementation_->body(); }
bool Scene::recovering() const { return implementation_->model->recovering(); }
const std::vector<EffectCost>& Scene::effect_costs() const { return implementation_->costs.all(); }
std::map<std::string, std::optional<Vec3>> Scene::probes() const {
  return implementation_->probes.places(*implementation_->model);
}
std::vector<Vec3> Scene::places(const std::vector<TetPlace>& material) const {
  const DeformationModel& model = *implementation_->model;
  std::vector<Vec3> result;
  for (const TetPlace& place : material) result.push_back(model.mean_of(model.shape_at(place)));
  return result;
}
std::vector<std::optional<Vec3>> Scene::tool_forces() const {
  std::vector<std::optional<Vec3>> forces = implementation_->model->tool_forces();
  forces.resize(description().tools.size());
  return forces;
}
std::vector<std::optional<ToolFeedback>> Scene::tool_feedback() const {
  return implementation_->model->tool_feedback();
}
std::vector<Vec3> Scene::anchor_forces() const { return implementation_->model->anchor_forces(); }
std::vector<TetStrain> Scene::strains() const { return implementation_->model->strains(); }

}  // namespace tissue
