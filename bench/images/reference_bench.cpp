// reference_bench: the fast renderer beside the reference, on a list of views.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <string>
#include <vector>

#include "app/assets/asset_library.h"
#include "app/scene/build_scene.h"
#include "bench/gallery_list.h"
#include "bench/images/compared_view.h"
#include "bench/images/gallery_piles.h"
#include "bench/images/image_measures.h"
#include "bench/program.h"
#include "io/image/image_file.h"
#include "kernel/base/system/thread_count.h"
#include "kernel/base/system/disk_cache.h"
#include "render/colour/frame_light.h"
#include "render/devices/software/software_device.h"
#include "scripting/mission.h"

namespace rubble {
namespace {

struct Request {
  std::string list = "bench/images/reference_views.json", only, pictures;
  std::vector<std::string> set;
  int size = 512, samples = 64, bake_rays = RenderOptions().bake_rays, threads = 0, regions = 16;
  bool denoise = false, reference_only = false, reuse = false;
};

void save(const Request& request, const std::string& name, const Picture& picture) {
  if (!request.pictures.empty())
    write_png(request.pictures + name + ".png", {picture.width, picture.height, picture.rgb}, 6);
}

void print_statistics(const char* name, const char* quality, const Picture& picture, const DrawnPicture& drawn) {
  const ImageStatistics s = measure_image(luma_of(picture.rgb.data(), picture.width, picture.height));
  const double megapixels = 1e-6 * picture.width * picture.height;
  std::printf("| %s | %s | %.1f | %.2f | %.0f | %.2f | %.1f | %.1f |", name, quality, s.gradient_kurtosis,
              s.flat_share, count_keypoints(picture) / megapixels, s.spectral_slope, drawn.seconds,
              drawn.processor);
}

void compare(Device& device, const GalleryPicture& picture, GalleryPiles& piles, const Request& request,
             int threads) {
  MissionOptions changes;
  changes.overrides = picture.set;
  changes.overrides.insert(changes.overrides.end(), request.set.begin(), request.set.end());
  const Mission mission = load_mission(picture.mission, changes);
  const Scenario& scenario = mission.scenario;
  const AssetLibrary assets = load_assets(mission, {});
  const Scene scene = build_scene(scenario, assets, piles.of(picture, scenario, assets, threads));
  const ViewRays view = view_of(scenario, request.size);
  RenderOptions options;
  options.threads = threads;
  const Vec3f gains = white_balance(make_lights(scene));
  options.colour = {RenderQuality::reference, request.samples, request.denoise};
  // Without a cache unless asked, for its time.
  options.cache_folder = request.reuse ? DiskCache::usual_folder() : "";
  const auto draw = [&] {
    Renderer renderer(device, scene, options);
    return draw_view(renderer, view);
  };
  const DrawnPicture slow = draw();
  const Picture expected = develop_reference(slow.frame, gains);
  save(request, picture.name + "_reference", expected);
  print_statistics(picture.name.c_str(), "reference", expected, slow);
  std::printf(" | | |\n");
  std::fflush(stdout);
  if (request.reference_only) return;
  options.colour = {};
  options.bake_rays = request.bake_rays;
  options.cache_folder = DiskCache::usual_folder();
  const DrawnPicture fast = draw();
  const ViewComparison d = compare_views(slow.frame, fast.frame, gains, request.regions, threads);
  save(request, picture.name + "_fast", d.found);
  print_statistics(picture.name.c_str(), "fast", d.found, fast);
  std::printf(" %.1f | %.1f | %.3f |\n", 100 * d.mean_error, 100 * d.bias, d.similarity);
  std::fflush(stdout);
}

ExitCode bench(const Request& request) {
  const int threads =
      request.threads > 0 ? request.threads : default_thread_count();
  const Gallery list = load_gallery(request.list);
  SoftwareDevice device;
  GalleryPiles piles;
  std::printf("| view | renderer | gradient kurtosis | flat share | SIFT/MP | slope | s | CPU s | "
              "mean error %% | bias %% | SSIM |\n|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const GallerySection& section : list.sections)
    for (const GalleryPicture& picture : section.pictures)
      if (picture.name.find(request.only) != std::string::npos)
        compare(device, picture, piles, request, threads);
  return ExitCode::done;
}

ExitCode run(int argc, char** argv) {
  CLI::App app{
      "Draws each view of a list with the fast renderer and by path tracing, and prints a table: figures "
      "of both pictures, the time of each image, and how far they are apart."};
  Request request;
  app.add_option("--list", request.list, "The views, as docs/gallery.json lists pictures")
      ->capture_default_str();
  app.add_option("--only", request.only, "Only views whose name has this in it");
  app.add_option("--size", request.size, "Side of the square images")->check(CLI::Range(32, 8192))
      ->capture_default_str();
  app.add_option("--samples", request.samples, "Paths a pixel")->check(CLI::Range(1, 65536))
      ->capture_default_str();
  app.add_option("--bake-rays", request.bake_rays, "Rays of a bake point of the fast renderer at most")
      ->check(CLI::Range(8, 1024))
      ->capture_default_str();
  app.add_flag("--denoise", request.denoise, "Filter the noise of the reference");
  app.add_option("--regions", request.regions, "Regions across and down")->check(CLI::Range(1, 64))
      ->capture_default_str();
  app.add_option("--set", request.set, "Another key for every view, as `rubble run --set`");
  app.add_flag("--reference-only", request.reference_only, "Without the fast renderer");
  app.add_flag("--reuse", request.reuse,
               "Take references that the cache holds, and keep new ones: their times then say nothing");
  app.add_option("--pictures", request.pictures, "Also write PREFIXview_reference.png and _fast.png");
  app.add_option("--threads", request.threads, "0: all processors")->check(CLI::Range(0, 1024));
  return parse_and_run(app, argc, argv, [&] { return bench(request); });
}

}  // namespace
}  // namespace rubble

int main(int argc, char** argv) {
  return rubble::run_program("reference_bench", [=] { return rubble::run(argc, argv); });
}
