#include "bench/render_views.h"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>

#include "app/assets/asset_library.h"
#include "app/fines/pile_fines.h"
#include "app/scene/build_scene.h"
#include "app/surroundings/pile_surroundings.h"
#include "io/state/pile_state_file.h"
#include "kernel/base/error.h"
#include "kernel/base/portable_math.h"
#include "kernel/base/system/disk_cache.h"
#include "kernel/settling/generator.h"
#include "kernel/settling/settle.h"
#include "scripting/mission.h"
#include "scripting/scenario/scenario.h"

namespace rubble {
namespace {

Pose look_at(const Vec3& eye, const Vec3& target) {
  const Vec3 forward = normalized(target - eye);
  return {portable::quat_from_rpy(0, -portable::asin(forward.z),
                                  portable::atan2(forward.y, forward.x)),
          eye};
}

// From one eye and target to another, 15 mm a frame at most.
std::vector<Pose> fly(const Vec3& from, const Vec3& to, const Vec3& target, const Vec3& end,
                      int frames) {
  std::vector<Pose> poses;
  for (int i = 0; i < frames; ++i) {
    const double t = std::min(1.0, i * 0.015 / distance(from, to));
    poses.push_back(look_at(from + (to - from) * t, target + (end - target) * t));
  }
  return poses;
}

std::vector<Pose> fly_void(int frames) {
  return fly({-2.9, -0.75, 0.6}, {1.2, -0.75, 0.55}, {1.5, -0.6, 0.4}, {4, -0.5, 0.4}, frames);
}

std::vector<Pose> fly_outside(int frames) {
  return fly({-7.5, -5.0, 2.6}, {-7.0, 3.0, 2.2}, {0.6, 0, 0.9}, {0.6, 0.5, 0.9}, frames);
}

// By mission and assets alone: any pile that they once settled to will do.
PileState settle_once(const Pile& pile, SettleOptions options, const std::string& mission,
                      const AssetLibrary& assets, void (*report)(const char*)) {
  const std::string folder = DiskCache::usual_folder();
  CacheKey key("render_bench", 1);
  key.add_text(sha256_of_file(mission));
  for (const AssetContent& content : assets.contents) key.add_text(content.sha256);
  const std::string path = folder + "/bench/" + key.hex() + ".cache";
  if (!folder.empty() && std::filesystem::exists(path)) {
    try {
      return load_pile_state(path);
    } catch (const InputError&) {
      report("the cached pile is damaged");
    }
  }
  report("settling the pile, which takes a minute the first time ...");
  PileState state = settle_pile(pile, options);
  if (folder.empty()) return state;
  std::filesystem::create_directories(folder + "/bench");
  save_pile_state(state, path);
  return state;
}

void strew_timed(const Scenario& scenario, const AssetLibrary& assets, int threads, PileState& state,
                 void (*report)(const char*)) {
  const auto start = std::chrono::steady_clock::now();
  const std::clock_t processor = std::clock();
  lay_fines(scenario.fines, scenario.seed, assets, threads, state);
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  char line[120];
  std::snprintf(line, sizeof line, "%zu fines strewn in %.2f s, %.2f CPU s",
                state.fines.pieces.size() + state.fines.sheets.size(), wall,
                double(std::clock() - processor) / CLOCKS_PER_SEC);
  report(line);
}

}  // namespace

Scene load_bench_scene(const std::string& mission_path, int threads, void (*report)(const char*), int fines,
                       bool surrounded) {
  Mission mission = load_mission(mission_path, {});
  mission.scenario.settle.threads = threads;
  const AssetLibrary assets = load_assets(mission, {});
  const Pile pile = generate_pile(build_pile_spec(mission.scenario.pile, mission.scenario.seed, assets));
  PileState state = settle_once(pile, mission.scenario.settle, mission_path, assets, report);
  mission.scenario.fines.amount = fines;
  if (fines > 0) strew_timed(mission.scenario, assets, threads, state, report);
  if (surrounded) mission.scenario.surroundings.type = SurroundingsType::street;
  lay_surroundings(mission.scenario, assets, state);
  return build_scene(mission.scenario, assets, state);
}

const std::vector<BenchView>& bench_views() {
  static const std::vector<BenchView> views = {{"void_lamp", fly_void},
                                               {"exterior_sun", fly_outside}};
  return views;
}

Intrinsics bench_camera(int size) {
  Intrinsics k;
  k.width = k.height = size;
  k.fx = k.fy = 0.5 * size / std::tan(40 * portable::kPi / 180);
  k.cx = k.cy = 0.5 * (size - 1);
  return k;
}

}  // namespace rubble
