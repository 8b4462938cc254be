// gallery: draws every picture that docs/gallery.json lists from bundled missions, and writes the page
// that shows them.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "app/assets/asset_library.h"
#include "app/fines/pile_fines.h"
#include "app/scene/build_scene.h"
#include "app/sensors/build_camera.h"
#include "app/surroundings/pile_surroundings.h"
#include "bench/channel_picture.h"
#include "bench/gallery_list.h"
#include "bench/program.h"
#include "io/base/atomic_file.h"
#include "io/image/image_file.h"
#include "kernel/base/system/thread_count.h"
#include "kernel/base/system/disk_cache.h"
#include "kernel/settling/generator.h"
#include "kernel/settling/settle.h"
#include "render/devices/software/software_device.h"
#include "render/sensors/camera.h"
#include "scripting/mission.h"
#include "scripting/trajectory/trajectory.h"

namespace rubble {
namespace {

struct Request {
  std::string list = "docs/gallery.json", page = "docs/gallery.md", only, section;
  int threads = 0;
};

constexpr std::size_t kMostBytes = 145000;  // of a picture

// Piles that were settled already, by all that a pile follows from.
class Piles {
 public:
  explicit Piles(int threads) : threads_(threads) {}

  const PileState& of(const GalleryPicture& picture, const Scenario& scenario,
                      const AssetLibrary& assets) {
    std::string key = picture.mission;
    for (const std::string& change : picture.set)
      if (change.rfind("pile.", 0) == 0 || change.rfind("seed", 0) == 0 || change.rfind("fines.", 0) == 0) key += "\n" + change;
    const auto found = piles_.find(key);
    if (found != piles_.end()) return found->second;
    SettleOptions options = scenario.settle;
    options.threads = threads_;
    PileState& pile = piles_[key] = settle_pile(generate_pile(build_pile_spec(scenario.pile, scenario.seed, assets)), options);
    lay_fines(scenario.fines, scenario.seed, assets, threads_, pile);
    return pile;
  }

 private:
  int threads_;
  std::map<std::string, PileState> piles_;
};

Frame take(Device& device, const GalleryPicture& picture, Piles& piles, int threads) {
  MissionOptions changes;
  changes.overrides = picture.set;
  const Mission mission = load_mission(picture.mission, changes);
  const Scenario& scenario = mission.scenario;
  const AssetLibrary assets = load_assets(mission, {});
  RenderOptions options;
  options.threads = threads;
  options.cache_folder = DiskCache::usual_folder();
  options.colour = scenario.cameras.front().camera.colour;
  PileState pile = piles.of(picture, scenario, assets);
  lay_surroundings(scenario, assets, pile);
  Renderer renderer(device, build_scene(scenario, assets, pile),
                    options);
  const MountedCamera& mounted = scenario.cameras.front();
  CameraSpec spec = build_camera(mounted, scenario.seed, threads);
  ask_for_channel(picture.channel, spec);
  Camera camera(renderer, spec, build_flight(mounted, scenario.start_ns, scenario.trajectory.rate_hz,
                                             std::make_shared<const CameraPath>(scenario.trajectory)));
  if (picture.frame >= camera.frames())
    throw RunError(picture.name + ": frame " + std::to_string(picture.frame) + " of " +
                   std::to_string(camera.frames()));
  Frame frame;
  for (int i = 0; i <= picture.frame; ++i) frame = camera.take(i);
  return frame;
}

void write_jpeg(const std::string& path, const RgbImage& image) {
  std::string bytes;
  for (int quality = 90; quality >= 40; quality -= 5) {
    bytes = encode_jpeg(image.width, image.height, image.rgb.data(), quality);
    if (bytes.size() <= kMostBytes) break;
  }
  write_text_file(path, bytes);
}

ExitCode draw(const Request& request) {
  namespace fs = std::filesystem;
  const int threads =
      request.threads > 0 ? request.threads : default_thread_count();
  const Gallery gallery = load_gallery(request.list);
  const fs::path folder = fs::path(request.page).parent_path() / "pictures/gallery";
  fs::create_directories(folder);
  SoftwareDevice device;
  Piles piles(threads);
  int drawn = 0;
  for (const GallerySection& section : gallery.sections) {
    if (!request.section.empty() && section.title != request.section) continue;
    for (const GalleryPicture& picture : section.pictures) {
      if (picture.name.find(request.only) == std::string::npos) continue;
      ++drawn;
      std::fprintf(stderr, "gallery: %s\n", picture.name.c_str());
      write_jpeg((folder / (picture.name + ".jpg")).string(),
                 channel_picture(picture.channel, take(device, picture, piles, threads)));
    }
  }
  if (drawn == 0) throw RunError(request.list + " has no picture of that name or section");
  write_text_file(request.page, gallery_page(gallery));
  std::printf("%s\n", request.page.c_str());
  return ExitCode::done;
}

ExitCode run(int argc, char** argv) {
  CLI::App app{"Draws the pictures of the gallery from bundled missions, and writes its page."};
  Request request;
  app.add_option("--list", request.list, "What is drawn")->capture_default_str();
  app.add_option("--page", request.page, "The page; pictures go to pictures/gallery beside it")
      ->capture_default_str();
  app.add_option("--only", request.only, "Only pictures whose name has this in it");
  app.add_option("--section", request.section, "Only pictures of the section with this title");
  app.add_option("--threads", request.threads, "0: all processors")->check(CLI::Range(0, 1024));
  return parse_and_run(app, argc, argv, [&] { return draw(request); });
}

}  // namespace
}  // namespace rubble

int main(int argc, char** argv) {
  return rubble::run_program("gallery", [=] { return rubble::run(argc, argv); });
}
