#include "support/bodies.h"

#include "support/shapes.h"
#include "tissue/base/tet_mesh.h"
#include "tissue/refine/build_mesh.h"

#include <algorithm>

namespace tissue_test {

using namespace tissue;

Body kuhn_block(const std::array<int, 3>& cells, const Vec3& size) {
  Body body;
  const auto number = [&](int x, int y, int z) {
    return static_cast<std::uint32_t>(x + (cells[0] + 1) * (y + (cells[1] + 1) * z));
  };
  for (int z = 0; z <= cells[2]; ++z) {
    for (int y = 0; y <= cells[1]; ++y) {
      for (int x = 0; x <= cells[0]; ++x) {
        const Vec3 place(size[0] * x / cells[0], size[1] * y / cells[1], size[2] * z / cells[2]);
        body.rest.push_back(place.cast<float>());
      }
    }
  }
  constexpr int kOrders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  for (int z = 0; z < cells[2]; ++z) {
    for (int y = 0; y < cells[1]; ++y) {
      for (int x = 0; x < cells[0]; ++x) {
        for (const auto& order : kOrders) {
          std::array<int, 3> at = {x, y, z};
          Tet tet;
          tet[0] = number(at[0], at[1], at[2]);
          for (int step = 0; step < 3; ++step) {
            ++at[order[step]];
            tet[step + 1] = number(at[0], at[1], at[2]);
          }
          if (determinant(body.rest[tet[0]], body.rest[tet[1]], body.rest[tet[2]],
                          body.rest[tet[3]]) < 0.0) {
            std::swap(tet[2], tet[3]);
          }
          body.tets.push_back(tet);
        }
      }
    }
  }
  body.surface = boundary_of(body.tets, body.rest.size());
  body.densities.assign(body.rest.size(), 1.0f);
  body.tet_densities.assign(body.tets.size(), 1.0f);
  return body;
}

TetMesh refined_ball(double spacing, int sections) {
  constexpr std::uint32_t kSize = 72;
  constexpr double kCentre = 0.5 * (kSize - 1);
  auto volume = std::make_shared<Volume>(*float_volume(kSize, [](double x, double y, double z) {
    const double distance = Vec3(x - kCentre, y - kCentre, z - kCentre).norm();
    // Half-way at 30 mm; the ball inside has no influence on the surface.
    if (distance < 10.0) return 255.0;
    return std::clamp(60.0 * (30.5 - distance), 0.0, 60.0);
  }));
  volume->grid.origin = Vec3::Constant(-1e-3 * kCentre);
  MeshOptions options;
  options.iso_value = 30.0;
  options.spacing = spacing;
  options.levels.sections = sections;
  return build_mesh(volume, nullptr, options).mesh;
}

Body ball_body(const TetMesh& mesh, double radius, float inside, float outside) {
  Body body = body_of(mesh);
  for (std::size_t t = 0; t < body.tets.size(); ++t) {
    Vec3 centroid = Vec3::Zero();
    for (const std::uint32_t v : body.tets[t]) centroid += 0.25 * body.rest[v].cast<double>();
    body.tet_densities[t] = centroid.norm() < radius ? inside : outside;
  }
  return body;
}

std::vector<std::uint8_t> nodes_where(const std::vector<Vec3>& places,
                                      const std::function<bool(const Vec3&)>& chosen) {
  std::vector<std::uint8_t> result;
  for (const Vec3& place : places) result.push_back(chosen(place));
  return result;
}

}  // namespace tissue_test
