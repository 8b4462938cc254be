// bake_bench: how long it takes to light a scene, and how noisy the light is.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "bench/process_times.h"
#include "bench/program.h"
#include "bench/render_views.h"
#include "kernel/base/system/thread_count.h"
#include "kernel/base/system/disk_cache.h"
#include "render/lighting/bake.h"
#include "render/lighting/light_packing.h"
#include "render/materials/textures.h"
#include "render/transport/drawn_albedo.h"
#include "render/view/render_options.h"

namespace rubble {
namespace {

struct Request {
  std::vector<std::string> missions = {"scripts/first_pile.lua", "bench/render_views.lua"};
  int threads = 0, rays = RenderOptions().bake_rays, against = 0;
};

std::size_t point_count(const PreparedScene& scene) {
  std::size_t sum = 0;
  for (const PlacedMesh& placed : scene.placed) sum += scene.meshes[placed.mesh].bake_points.size();
  return sum;
}

// Root mean square of the differences of light at nodes, each as a share of the mean of the two, in percent.
// Nodes that both bakes leave dark do not count.
double difference(const LightTable& a, const LightTable& b) {
  const auto strength = [](const BakedLight& l) {
    const Vec3f v(from_half(l.x), from_half(l.y), from_half(l.z));
    return double(norm(v));
  };
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double x = strength(a[i]), y = strength(b[i]), mean = 0.5 * (x + y);
    if (mean <= 0) continue;
    sum += (x - y) * (x - y) / (mean * mean), ++count;
  }
  return 100 * std::sqrt(sum / std::max(count, 1.0));
}

void bench(const Request& request, const std::string& mission, int threads) {
  const Scene given = load_bench_scene(
      mission, threads, [](const char* line) { std::fprintf(stderr, "bake_bench: %s\n", line); });
  const PreparedScene scene = prepare_scene(given, threads);
  const GroundMap ground = make_ground_map(scene);
  const RenderOptions drawn;
  const auto patterns = make_patterns_once(DiskCache(DiskCache::usual_folder()), drawn.texture_size, threads);
  const LookSurfaces surfaces(scene, patterns, ground, given.wetness);
  const LightSet light = make_lights(given);
  BakeOptions options;
  options.threads = threads, options.seed = given.seed;
  Times solved;
  const auto bake = [&](int rays) {
    options.rays = rays;
    SceneRays scene_rays(scene);
    LightBake baked(scene, scene_rays, light, drawn_albedo(surfaces), options);
    solved = read_times();
    baked.light_all();
    return baked.nodes();
  };
  const Times start = read_times();
  const LightTable nodes = bake(request.rays);
  const Times took = read_times() - start, first = solved - start;
  std::printf("| %s | %zu | %zu | %zu | %.2f | %.2f | %.2f | %.2f |", mission.c_str(), given.instances.size(),
              point_count(scene), scene.light_nodes, first.wall, first.cpu, took.wall, took.cpu);
  if (request.against > 0) {
    options.seed = given.seed + 1;  // other directions
    std::printf(" %.2f |", difference(nodes, bake(request.against)));
  }
  std::printf("\n");
  std::fflush(stdout);
}

ExitCode bench_all(const Request& request) {
  const int threads =
      request.threads > 0 ? request.threads : default_thread_count();
  std::printf("| mission | pieces | points | nodes | first s | CPU s | all pieces s | CPU s |%s\n|---|---|---|---|---|---|---|---|%s\n",
              request.against ? " apart % |" : "", request.against ? "---|" : "");
  for (const std::string& mission : request.missions) bench(request, mission, threads);
  return ExitCode::done;
}

ExitCode run(int argc, char** argv) {
  CLI::App app{
      "Lights the settled pile of each mission, from nothing, and prints how long that took; settled piles are kept "
      "in the cache. Run it in the root of the sources."};
  Request request;
  app.add_option("missions", request.missions, "Lua missions")->capture_default_str();
  app.add_option("--rays", request.rays, "Of a point at most")->check(CLI::Range(8, 1024))->capture_default_str();
  app.add_option("--against", request.against,
                 "Bake once more by that many rays in other directions, and print how far the light of nodes is apart")
      ->check(CLI::Range(8, 1024));
  app.add_option("--threads", request.threads, "0: all processors")->check(CLI::Range(0, 1024));
  return parse_and_run(app, argc, argv, [&] { return bench_all(request); });
}

}  // namespace
}  // namespace rubble

int main(int argc, char** argv) {
  return rubble::run_program("bake_bench", [=] { return rubble::run(argc, argv); });
}
