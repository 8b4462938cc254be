// How many points a second each LiDAR gives, by number of threads: over a field of stones of 784 triangles
// each, moving, in clear air and in smoke.
//
//   lidar_bench [--threads 1,2] [--scans 10] [--stones 300]
#include <CLI/CLI.hpp>
#include <chrono>
#include <ctime>
#include <cstdio>

#include "kernel/base/portable_math.h"
#include "kernel/base/random.h"
#include "render/lidar/lidar.h"
#include "scripting/sensors/lidar.h"

namespace rubble {
namespace {

// A lump about 1 m across.
std::shared_ptr<const SceneMesh> make_stone(RandomStream& random) {
  constexpr int kRings = 14, kSteps = 2 * kRings;
  TriangleMesh mesh;
  mesh.surface_names = {"concrete_fracture"};
  for (int r = 0; r <= kRings; ++r)
    for (int s = 0; s < kSteps; ++s) {
      const portable::SinCos a = portable::sincos(portable::kPi * r / kRings);
      const portable::SinCos b = portable::sincos(2 * portable::kPi * s / kSteps);
      mesh.positions.push_back(Vec3f(Vec3(a.sin * b.cos, a.sin * b.sin, a.cos) * random.uniform(0.4, 0.5)));
    }
  const auto at = [](int r, int s) { return std::uint32_t(r * kSteps + s % kSteps); };
  for (int r = 0; r < kRings; ++r)
    for (int s = 0; s < kSteps; ++s) {
      mesh.triangles.push_back({at(r, s), at(r + 1, s), at(r + 1, s + 1)});
      mesh.triangles.push_back({at(r, s), at(r + 1, s + 1), at(r, s + 1)});
    }
  mesh.surfaces.assign(mesh.triangles.size(), 0);
  return std::make_shared<const SceneMesh>(SceneMesh{{mesh}});
}

Scene make_field(int stones) {
  RandomStream random(5, "bench.lidar");
  Scene scene;
  for (int i = 0; i < 10; ++i) scene.meshes.push_back(make_stone(random));
  for (int i = 0; i < stones; ++i) {
    SceneInstance stone;
    stone.mesh = std::uint32_t(random.below(10));
    stone.scale = float(random.uniform(0.2, 1.2));
    stone.world_from_body = {random.rotation(),
                             {random.uniform(-3, 6), random.uniform(-4, 4), random.uniform(0, 1.2)}};
    stone.id = std::uint32_t(i);
    scene.instances.push_back(stone);
  }
  return scene;
}

struct Rate {
  double points = 0, seconds = 0;
  double processor = 0;  // of all threads: where other programs share the processors it alone means something; unit: s
};

Rate measure(LidarModel model, const Scene& scene, std::shared_ptr<RayWorld> world, int threads, int scans) {
  LidarFigures figures;
  figures.model = model;
  const auto moving = [](std::int64_t stamp_ns) {
    const double t = double(stamp_ns) * 1e-9 - 1;
    return Pose{{}, {-4 + 0.5 * t, 0.2 * t, 1.2}};
  };
  Lidar lidar(figures.spec(), std::move(world), {moving, 1'000'000'000}, Medium(scene.air, scene.seed), 3, threads);
  lidar.take(0);
  Rate rate;
  const auto start = std::chrono::steady_clock::now();
  const std::clock_t begun = std::clock();
  for (int i = 1; i <= scans; ++i) rate.points += double(lidar.take(i).points.size());
  rate.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  rate.processor = double(std::clock() - begun) / CLOCKS_PER_SEC;
  return rate;
}

void run(const std::vector<int>& threads, int scans, int stones) {
  Scene clear = make_field(stones), smoke = clear;
  smoke.air.fog_density = 0.1;
  const auto world = std::make_shared<RayWorld>(clear);
  std::printf("%-8s %7s %9s %14s %16s %22s\n", "model", "threads", "air", "points/scan", "points/s of wall",
              "points/s of processor");
  for (std::size_t model = 0; model < lidar_model_names().size(); ++model)
    for (const int count : threads)
      for (const Scene* scene : {&clear, &smoke}) {
        const Rate rate = measure(LidarModel(model), *scene, world, count, scans);
        std::printf("%-8s %7d %9s %14.0f %16.0f %22.0f\n", lidar_model_names()[model].c_str(), count, scene == &clear ? "clear" : "0.1 /m",
                    rate.points / scans, rate.points / rate.seconds, rate.points / rate.processor);
      }
}

}  // namespace
}  // namespace rubble

int main(int argc, char** argv) {
  CLI::App app("Points a second of each LiDAR.");
  std::vector<int> threads{1, 2};
  int scans = 10, stones = 300;
  app.add_option("--threads", threads, "numbers of threads")->delimiter(',');
  app.add_option("--scans", scans)->check(CLI::Range(1, 100000));
  app.add_option("--stones", stones)->check(CLI::Range(1, 100000));
  CLI11_PARSE(app, argc, argv);
  rubble::run(threads, scans, stones);
}
