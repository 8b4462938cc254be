// depth_bench: the fast renderer beside the reference along the way into ruins, from the entrance of a void to its end.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "app/assets/asset_library.h"
#include "app/planning/flight.h"
#include "app/scene/build_scene.h"
#include "bench/images/compared_view.h"
#include "bench/images/gallery_piles.h"
#include "bench/program.h"
#include "io/image/image_file.h"
#include "kernel/base/error.h"
#include "kernel/base/system/disk_cache.h"
#include "kernel/base/system/thread_count.h"
#include "render/colour/frame_light.h"
#include "render/devices/software/software_device.h"
#include "scripting/mission.h"

namespace rubble {
namespace {

struct Request {
  std::string mission = "bench/images/depth_ruins.lua", pictures;
  // STRUCTURE:SEED
  std::vector<std::string> ruins = {"lean_to:21", "cantilever:22", "v_shape:23",  "a_frame:24",    "pancake:25",  "inclined:26",
                                    "lean_over:27", "culvert:28",  "frame:29", "frame:30", "inclined:31", "cantilever:32"};
  std::vector<double> depths = {0, 0.33, 0.67, 1};
  std::vector<std::string> set;
  int size = 96, samples = 1024, bake_rays = RenderOptions().bake_rays, threads = 0, regions = 12;
  bool raw = false, twice = false;
};

struct Sum {
  double mean_error = 0, worst_error = 0, bias = 0, similarity = 0, least_similarity = 1, noise = 0;
  int count = 0;

  void add(const ViewComparison& c, double noise_of_reference) {
    noise += noise_of_reference;
    mean_error += c.mean_error, worst_error = std::max(worst_error, c.mean_error), bias += c.bias;
    similarity += c.similarity, least_similarity = std::min(least_similarity, c.similarity), ++count;
  }
};

Mission mission_of(const Request& request, const std::string& ruin) {
  const std::size_t colon = ruin.find(':');
  if (colon == std::string::npos) throw RunError("--ruins takes STRUCTURE:SEED, not `" + ruin + "`");
  MissionOptions changes;
  changes.overrides = {"structure=" + ruin.substr(0, colon), "seed=" + ruin.substr(colon + 1)};
  changes.overrides.insert(changes.overrides.end(), request.set.begin(), request.set.end());
  return load_mission(request.mission, changes);
}

ViewRays view_at(const FlightPlan& flight, double share, const Scenario& scenario, int size) {
  CameraScenario sized = scenario.cameras.front().camera;
  sized.width = sized.height = size;
  return {scenario.start_ns, sized.intrinsics(), flight.path->at(share * flight.path->duration())};
}

void save(const Request& request, const std::string& name, const Picture& picture) {
  if (!request.pictures.empty())
    write_png(request.pictures + name + ".png", {picture.width, picture.height, picture.rgb}, 6);
}

std::string noise_text(const Request& request, double noise) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f %%", 100 * noise);
  return request.twice ? text : "-";
}

struct Expected {
  LinearFrame frame;
  double noise = 0;  // of one of the two that it is the mean of, against the other, as a mean error; 0: it is one alone
};

Expected draw_reference(Renderer& renderer, const ViewRays& view, const Vec3f& gains, const Request& request, int threads) {
  Expected out{draw_view(renderer, view).frame, 0};
  if (!request.twice) return out;
  ViewRays again = view;
  ++again.stamp_ns;  // other random numbers
  const LinearFrame other = draw_view(renderer, again).frame;
  out.noise = compare_views(out.frame, other, gains, request.regions, threads).mean_error;
  for (std::size_t i = 0; i < out.frame.rgb.size(); ++i) out.frame.rgb[i] = (out.frame.rgb[i] + other.rgb[i]) / 2;
  return out;
}

void measure(const std::string& ruin, const Request& request, GalleryPiles& piles, int threads,
             std::map<double, Sum>& sums) {
  const Mission mission = mission_of(request, ruin);
  const Scenario& scenario = mission.scenario;
  const AssetLibrary assets = load_assets(mission, {});
  const PileState& pile = piles.of({ruin, ruin, {}, 0, "", ""}, scenario, assets, threads);
  PileSurvey survey(assets, pile, threads);
  const FlightPlan flight = resolve_flight(scenario, survey, {}, DiskCache(DiskCache::usual_folder()));
  const Scene scene = build_scene(scenario, assets, pile);
  const Vec3f gains = white_balance(make_lights(scene));
  SoftwareDevice device;
  RenderOptions options;
  options.threads = threads, options.cache_folder = DiskCache::usual_folder(), options.bake_rays = request.bake_rays;
  Renderer fast(device, scene, options);
  options.colour = {RenderQuality::reference, request.samples, !request.raw};
  Renderer reference(device, scene, options);
  for (const double depth : request.depths) {
    const ViewRays view = view_at(flight, depth, scenario, request.size);
    const Expected expected = draw_reference(reference, view, gains, request, threads);
    const ViewComparison c = compare_views(expected.frame, draw_view(fast, view).frame, gains, request.regions, threads);
    char name[80];
    std::snprintf(name, sizeof name, "%s_%03.0f", ruin.c_str(), 100 * depth);
    save(request, std::string(name) + "_reference", c.expected), save(request, std::string(name) + "_fast", c.found);
    std::printf("| %s | %.0f %% | %.1f %% | %+.1f %% | %.3f | %s |\n", ruin.c_str(), 100 * depth, 100 * c.mean_error,
                100 * c.bias, c.similarity, noise_text(request, expected.noise).c_str());
    std::fflush(stdout);
    sums[depth].add(c, expected.noise);
  }
}

ExitCode bench(const Request& request) {
  const int threads = request.threads > 0 ? request.threads : default_thread_count();
  GalleryPiles piles;
  std::map<double, Sum> sums;
  std::printf("| ruin | depth | mean error | bias | SSIM | noise |\n|---|---|---|---|---|---|\n");
  for (const std::string& ruin : request.ruins) measure(ruin, request, piles, threads, sums);
  std::printf("\n| depth | mean error | largest | bias | SSIM | least | noise |\n|---|---|---|---|---|---|---|\n");
  for (const auto& [depth, s] : sums)
    std::printf("| %.0f %% | %.1f %% | %.1f %% | %+.1f %% | %.3f | %.3f | %s |\n", 100 * depth, 100 * s.mean_error / s.count,
                100 * s.worst_error, 100 * s.bias / s.count, s.similarity / s.count, s.least_similarity,
                noise_text(request, s.noise / s.count).c_str());
  return ExitCode::done;
}

ExitCode run(int argc, char** argv) {
  CLI::App app{
      "Draws views along the way into the deepest void of ruins with the fast renderer and by path tracing, and prints how "
      "far they are apart, by depth. References are kept in the cache."};
  Request request;
  app.add_option("--mission", request.mission, "With a parameter `structure`")->capture_default_str();
  app.add_option("--ruins", request.ruins, "STRUCTURE:SEED ...")->delimiter(',')->capture_default_str();
  app.add_option("--depths", request.depths, "Shares of the way, 0 to 1")->delimiter(',')->capture_default_str();
  app.add_option("--size", request.size, "Side of the square images")->check(CLI::Range(32, 8192))->capture_default_str();
  app.add_option("--samples", request.samples, "Paths a pixel")->check(CLI::Range(1, 65536))->capture_default_str();
  app.add_option("--bake-rays", request.bake_rays, "Rays of a bake point of the fast renderer at most")
      ->check(CLI::Range(8, 1024))
      ->capture_default_str();
  app.add_option("--regions", request.regions, "Regions across and down")->check(CLI::Range(1, 64))->capture_default_str();
  app.add_option("--set", request.set, "Another key, as `rubble run --set`");
  app.add_flag("--raw", request.raw, "Without the filter of the reference's noise");
  app.add_flag("--twice", request.twice, "Draw each reference twice, compare with the mean of both, and print as noise how far they are apart");
  app.add_option("--pictures", request.pictures, "Also write PREFIXruin_depth_reference.png and _fast.png");
  app.add_option("--threads", request.threads, "0: all processors")->check(CLI::Range(0, 1024));
  return parse_and_run(app, argc, argv, [&] { return bench(request); });
}

}  // namespace
}  // namespace rubble

int main(int argc, char** argv) {
  return rubble::run_program("depth_bench", [=] { return rubble::run(argc, argv); });
}
