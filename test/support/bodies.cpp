#include "support/bodies.h"

#include "support/shapes.h"
#include "tissue/base/tet_mesh.h"
#include "tissue/refine/build_mesh.h"

#include <algorithm>

namespace tissue_test {

using namespace tissue;

Body kuhn_block(const std::array<int, 3>& cells, const Vec3& size, int halvings) {
  Body body;
  const auto at = [&](int x, int y, int z) {
    return static_cast<std::size_t>(x + (cells[0] + 1) * (y + (cells[1] + 1) * z));
  };
  // Vertices of the coarsest block first, then what each halving adds.
  std::vector<std::uint32_t> numbers(at(0, 0, cells[2] + 1), 0xffffffffu);
  for (int halving = 0; halving <= halvings; ++halving) {
    const int step = 1 << (halvings - halving);
    for (int z = 0; z <= cells[2]; z += step) {
      for (int y = 0; y <= cells[1]; y += step) {
        for (int x = 0; x <= cells[0]; x += step) {
          std::uint32_t& number = numbers[at(x, y, z)];
          if (number != 0xffffffffu) continue;
          number = static_cast<std::uint32_t>(body.rest.size());
          body.rest.push_back(
              Vec3(size[0] * x / cells[0], size[1] * y / cells[1], size[2] * z / cells[2])
                  .cast<float>());
          if (halving == 0) continue;
          // Half-way along the edge or diagonal of a cube of the coarser block.
          const int dx = x / step % 2 * step, dy = y / step % 2 * step, dz = z / step % 2 * step;
          body.parents.push_back(
              {numbers[at(x - dx, y - dy, z - dz)], numbers[at(x + dx, y + dy, z + dz)]});
        }
      }
    }
  }
  const auto number = [&](int x, int y, int z) { return numbers[at(x, y, z)]; };
  constexpr int kOrders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  for (int z = 0; z < cells[2]; ++z) {
    for (int y = 0; y < cells[1]; ++y) {
      for (int x = 0; x < cells[0]; ++x) {
        for (const auto& order : kOrders) {
          std::array<int, 3> corner = {x, y, z};
          Tet tet;
          tet[0] = number(corner[0], corner[1], corner[2]);
          for (int step = 0; step < 3; ++step) {
            ++corner[order[step]];
            tet[step + 1] = number(corner[0], corner[1], corner[2]);
          }
          if (determinant(body.rest, tet) < 0.0) {
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

Vec3 centroid(const Body& body, std::size_t tet) {
  Vec3 sum = Vec3::Zero();
  for (const std::uint32_t v : body.tets[tet]) sum += 0.25 * body.rest[v].cast<double>();
  return sum;
}

Body with_core(Body body, const Vec3& centre, double radius, float inside, float outside) {
  body.tet_densities.resize(body.tets.size());
  for (std::size_t t = 0; t < body.tets.size(); ++t) {
    body.tet_densities[t] = (centroid(body, t) - centre).norm() < radius ? inside : outside;
  }
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
  return with_core(body_of(mesh), Vec3::Zero(), radius, inside, outside);
}

std::vector<std::uint8_t> nodes_where(const std::vector<Vec3>& places,
                                      const std::function<bool(const Vec3&)>& chosen) {
  std::vector<std::uint8_t> result;
  for (const Vec3& place : places) result.push_back(chosen(place));
  return result;
}

}  // namespace tissue_test
