#include "kernel/settling/generator.h"
#include "tests/app/settled_mission.h"

#include <algorithm>

namespace rubble::testing {

PileQueries SettledMission::queries() const {
  const std::vector<TriangleMesh> meshes = make_collision_meshes(assets.types);
  std::vector<const TriangleMesh*> pointers;
  for (const TriangleMesh& mesh : meshes) pointers.push_back(&mesh);
  return PileQueries(state, pointers);
}

double SettledMission::largest_move() const {
  double largest = 0;
  for (std::size_t i = 0; i < pile.placed.size(); ++i)
    largest = std::max(largest, distance(pile.placed[i].world_from_body.translation,
                                         state.pieces[i].world_from_body.translation));
  return largest;
}

SettledMission settle_text(const std::string& script) {
  return settle(load_mission_text(script, "m.lua"));
}

SettledMission settle(const Mission& mission) {
  SettledMission m{mission, {}, {}, {}};
  m.assets = load_assets(m.mission, {});
  m.pile = generate_pile(build_pile_spec(m.mission.scenario.pile, m.mission.scenario.seed, m.assets));
  SettleOptions options = m.mission.scenario.settle;
  options.threads = 1;
  m.state = settle_pile(m.pile, options);
  return m;
}

double calc_free_section(const PileQueries& queries, double x0, double x1, double y,
                         double from_z) {
  constexpr int kRays = 1000;
  constexpr double kCeiling = 20;  // where nothing is above, the section is open
  const double step = (x1 - x0) / kRays;
  double area = 0;
  for (int i = 0; i < kRays; ++i) {
    const Vec3 from{x0 + (i + 0.5) * step, y, from_z};
    const auto hit = queries.cast_ray(from, {0, 0, 1}, kCeiling);
    if (hit && queries.clearance(from, 1e-4) > 0) area += step * (hit->distance + from_z);
  }
  return area;
}

}  // namespace rubble::testing
