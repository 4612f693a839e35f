#include "tissue/study/tumour_wishes.h"

#include "tet_samples.h"
#include "tissue/field/density_window.h"
#include "tissue/field/sample.h"

namespace tissue {
namespace {

// Calls body(any_tumour, any_other) for each tet and keeps the levels that it gives.
template <class Body>
LevelWishes by_tumour(const Volume& volume, const ImplicitSurface& surface, double above,
                      const Body& body) {
  const DensityWindow window = default_window(volume, surface, LevelOptions().d_max);
  return [&volume, window, above, body](const std::vector<Vec3>& vertices,
                                        const std::vector<Tet>& tets) {
    std::vector<std::uint8_t> levels;
    with_sampler(volume, [&](const auto& value) {
      const auto is_tumour = [&](const Vec3& place) {
        return window.density(value(volume.grid.to_grid(place))) > above;
      };
      for (const Tet& tet : tets) {
        bool any_tumour = false, any_other = false;
        const auto look_at = [&](const Vec3& place) {
          (is_tumour(place) ? any_tumour : any_other) = true;
        };
        for (const std::uint32_t v : tet) look_at(vertices[v]);
        for (const Vec3& place : tet_samples(vertices, tet)) look_at(place);
        levels.push_back(static_cast<std::uint8_t>(body(any_tumour, any_other)));
      }
    });
    return levels;
  };
}

}  // namespace

LevelWishes border_wishes(const Volume& volume, const ImplicitSurface& surface, double above,
                          int finest) {
  return by_tumour(volume, surface, above, [finest](bool any_tumour, bool any_other) {
    return any_tumour && any_other ? finest : 0;
  });
}

LevelWishes tissue_wishes(const Volume& volume, const ImplicitSurface& surface, double above,
                          int finest) {
  return by_tumour(volume, surface, above,
                   [finest](bool, bool any_other) { return any_other ? finest : 0; });
}

}  // namespace tissue
