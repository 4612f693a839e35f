#include "soft_holds.h"

#include <algorithm>

namespace tissue {
namespace {

// From 1 in the middle of a pad to 0 at its rim, level at both.
double share_at(double distance, double radius) {
  const double part = std::min(distance / radius, 1.0);
  return (1.0 - part * part) * (1.0 - part * part);
}

bool is_pad(const ToolDescription& tool) { return tool.shape == ToolShape::kPad; }

}  // namespace

SoftHolds::SoftHolds(const SceneDescription& scene, const FiniteElements& elements,
                     const Body& body)
    : tools_(scene.tools),
      first_tool_(scene.anchors.size()),
      springs_(elements, body),
      pads_(scene.tools.size()) {
  for (const Bed& bed : beds_of(body, scene.anchors)) {
    springs_.attach(bed.anchor, rest_positions(elements),
                    [&](const Vec3& place) { return bed.reaches(place) ? bed.stiffness : 0.0; });
  }
}

bool SoftHolds::are_in(const SceneDescription& scene) {
  return std::any_of(scene.tools.begin(), scene.tools.end(), is_pad) ||
         std::any_of(scene.anchors.begin(), scene.anchors.end(), is_bed);
}

bool SoftHolds::any_pad() const { return std::any_of(tools_.begin(), tools_.end(), is_pad); }

bool SoftHolds::take(const ToolPoses& tools, const PositionsNow& positions_now) {
  bool changed = false;
  for (std::size_t i = 0; i < tools_.size(); ++i) {
    const ToolDescription& tool = tools_[i];
    if (!is_pad(tool)) continue;
    const std::size_t holder = first_tool_ + i;
    switch (pads_[i].jaw.act(tools[i], !pads_[i].offsets.empty())) {
      case Jaw::Act::kNothing: continue;
      case Jaw::Act::kRelease:
        springs_.detach(holder);
        pads_[i].offsets.clear();
        break;
      case Jaw::Act::kTake:
        springs_.attach(holder, positions_now(), [&](const Vec3& place) {
          return tool.pad_stiffness * share_at((place - tools[i]->position).norm(), tool.radius);
        });
        for (const SurfaceSprings::Spring& spring : springs_.springs()) {
          if (spring.holder != holder) continue;
          pads_[i].offsets.push_back(tools[i]->orientation.normalized().conjugate() *
                                     (spring.target - tools[i]->position));
        }
    }
    changed = true;
  }
  return changed;
}

void SoftHolds::reset() {
  for (std::size_t i = 0; i < pads_.size(); ++i) springs_.detach(first_tool_ + i);
  pads_.assign(tools_.size(), {});
}

Wrench SoftHolds::wrench(std::size_t tool, const Eigen::VectorXd& positions,
                         const Vec3& centre) const {
  Wrench sum;
  for (const SurfaceSprings::Spring& spring : springs_.springs()) {
    if (spring.holder != first_tool_ + tool) continue;
    const Vec3 place = positions.segment<3>(3 * Eigen::Index{spring.node});
    sum.add(spring.target - centre, spring.stiffness * (place - spring.target));
  }
  return sum;
}

void SoftHolds::add_pull(std::size_t tool, const Eigen::VectorXd&, const Vec3& direction,
                         Eigen::VectorXd& gradient) const {
  for (const SurfaceSprings::Spring& spring : springs_.springs()) {
    if (spring.holder != first_tool_ + tool) continue;
    gradient.segment<3>(3 * Eigen::Index{spring.node}) -= spring.stiffness * direction;
  }
}

Vec3 SoftHolds::force_change(std::size_t tool, const Eigen::VectorXd&, const Vec3& direction,
                             const Eigen::VectorXd& response) const {
  Vec3 sum = Vec3::Zero();
  for (const SurfaceSprings::Spring& spring : springs_.springs()) {
    if (spring.holder != first_tool_ + tool) continue;
    const Vec3 moved = response.segment<3>(3 * Eigen::Index{spring.node});
    sum += spring.stiffness * (moved - direction);
  }
  return sum;
}

void SoftHolds::add_anchor_forces(const Eigen::VectorXd& positions,
                                  std::vector<Vec3>& forces) const {
  for (std::size_t i = 0; i < first_tool_; ++i) forces[i] += springs_.force(i, positions);
}

bool SoftHolds::follow(const ToolPoses& tools, const Eigen::VectorXd&) {
  const std::vector<SurfaceSprings::Spring>& springs = springs_.springs();
  Eigen::VectorXd motion = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(3 * springs.size()));
  std::vector<std::size_t> next(tools_.size(), 0);
  for (std::size_t i = 0; i < springs.size(); ++i) {
    if (springs[i].holder < first_tool_) continue;
    const std::size_t tool = springs[i].holder - first_tool_;
    const Vec3& offset = pads_[tool].offsets[next[tool]++];
    if (!tools[tool]) continue;
    const Vec3 place = tools[tool]->position + tools[tool]->orientation.normalized() * offset;
    motion.segment<3>(static_cast<Eigen::Index>(3 * i)) = place - springs[i].target;
  }
  springs_.move(motion);
  return !motion.isZero(0.0);
}

}  // namespace tissue
