// How many points a second each LiDAR gives, by number of threads: over a heap of pieces, moving, in clear
// air and in smoke.
//
//   lidar_bench [--threads 1,2] [--scans 10] [--pieces 300]
#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>

#include "render/lidar/lidar.h"
#include "scripting/scenario/lidar_scenario.h"
#include "tests/render/test_scene.h"

namespace rubble {
namespace {

struct Rate {
  double points = 0, seconds = 0;
};

Rate measure(LidarModel model, const Scene& scene, std::shared_ptr<LidarWorld> world, int threads, int scans) {
  LidarScenario scenario;
  scenario.model = model;
  const auto moving = [](std::int64_t stamp_ns) {
    const double t = double(stamp_ns) * 1e-9 - 1;
    return Pose{{}, {-4 + 0.5 * t, 0.2 * t, 1.2}};
  };
  Lidar lidar(scenario.spec(), std::move(world), {moving, 1'000'000'000}, Medium(scene.air, scene.seed), 3, threads);
  lidar.take(0);
  Rate rate;
  const auto start = std::chrono::steady_clock::now();
  for (int i = 1; i <= scans; ++i) rate.points += double(lidar.take(i).points.size());
  rate.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return rate;
}

void run(const std::vector<int>& threads, int scans, int pieces) {
  const std::pair<LidarModel, const char*> models[] = {
      {LidarModel::vlp16, "vlp16"}, {LidarModel::os0, "os0"}, {LidarModel::os1, "os1"}, {LidarModel::os2, "os2"},
      {LidarModel::mid360, "mid360"}, {LidarModel::utm30lx, "utm30lx"}};
  Scene clear = testing::make_heap(pieces, 5), smoke = clear;
  smoke.air.fog_density = 0.1;
  const auto world = std::make_shared<LidarWorld>(clear);
  std::printf("%-8s %7s %9s %14s %16s\n", "model", "threads", "air", "points/scan", "points/s of wall");
  for (const auto& [model, name] : models)
    for (const int count : threads)
      for (const Scene* scene : {&clear, &smoke}) {
        const Rate rate = measure(model, *scene, world, count, scans);
        std::printf("%-8s %7d %9s %14.0f %16.0f\n", name, count, scene == &clear ? "clear" : "0.1 /m",
                    rate.points / scans, rate.points / rate.seconds);
      }
}

}  // namespace
}  // namespace rubble

int main(int argc, char** argv) {
  CLI::App app("Points a second of each LiDAR.");
  std::vector<int> threads{1, 2};
  int scans = 10, pieces = 300;
  app.add_option("--threads", threads, "numbers of threads")->delimiter(',');
  app.add_option("--scans", scans)->check(CLI::Range(1, 100000));
  app.add_option("--pieces", pieces)->check(CLI::Range(1, 100000));
  CLI11_PARSE(app, argc, argv);
  rubble::run(threads, scans, pieces);
}
