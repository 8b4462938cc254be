#include "render/media/air_matter.h"

namespace rubble {

AirMatter turning_matter(const Air& air, const AirGrid& grid) {
  AirMatter out;
  const double fog_g = air.fog_asymmetry(), drops_g = Precipitation::kAsymmetry;
  for (std::size_t i = 0; i < grid.count(); ++i) {
    const double fog = air.fog(Vec3(grid.point(i))), drops = air.drops();
    const double all = fog * air.turned_share(fog_g) + drops * air.turned_share(drops_g);
    out.extinction.push_back(float(all));
    std::array<float, kOrders>& scattered = out.scattered.emplace_back();
    if (all <= 0) continue;
    double of_fog = air.albedo() * fog * (1 - forward_share(fog_g)) / all;
    double of_drops = air.albedo() * drops * (1 - forward_share(drops_g)) / all;
    for (float& order : scattered) {
      order = float(of_fog + of_drops);
      of_fog *= turned_cosine(fog_g), of_drops *= turned_cosine(drops_g);
    }
  }
  return out;
}

}  // namespace rubble
