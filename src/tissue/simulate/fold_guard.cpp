#include "tissue/simulate/fold_guard.h"

#include <limits>

namespace tissue {

FoldGuard::FoldGuard(const Body& body, const PushField<float>& field) {
  std::vector<float> weights(body.rest.size(), 0.0f);
  for (std::size_t i = 0; i < field.vertices.size(); ++i) {
    weights[field.vertices[i]] = field.weights[i];
  }
  for (const Tet& tet : body.tets) {
    const double w0 = static_cast<double>(weights[tet[0]]);
    Vec3 rise;
    for (int i = 0; i < 3; ++i) rise[i] = static_cast<double>(weights[tet[i + 1]]) - w0;
    if (rise.isZero(0.0)) continue;
    Mat3 edges;
    for (int i = 0; i < 3; ++i) {
      edges.row(i) = (body.rest[tet[i + 1]].cast<double>() - body.rest[tet[0]].cast<double>());
    }
    const Vec3 a = edges.row(0), b = edges.row(1), c = edges.row(2);
    gradients_.push_back((rise[0] * b.cross(c) + rise[1] * c.cross(a) + rise[2] * a.cross(b)) /
                         a.dot(b.cross(c)));
  }
}

double FoldGuard::limit(const Vec3& n) const {
  double steepest = 0.0;
  for (const Vec3& gradient : gradients_) steepest = std::min(steepest, n.dot(gradient));
  return steepest < 0.0 ? -1.0 / steepest : std::numeric_limits<double>::infinity();
}

}  // namespace tissue
