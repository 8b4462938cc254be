// judge_scenes: traces the views of a list with surfaces that every renderer has, and writes them for another
// renderer to draw; cycles_judge.py lets Cycles draw them and compares.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/gallery_list.h"
#include "bench/images/gallery_piles.h"
#include "bench/images/judged_view.h"
#include "bench/program.h"
#include "kernel/base/system/thread_count.h"

namespace rubble {
namespace {

struct Request {
  std::string list = "bench/images/judge_views.json", only, out = "out/judge";
  std::vector<std::string> set;
  JudgeOptions options;
};

void judge(const GalleryPicture& picture, GalleryPiles& piles, const Request& request) {
  MissionOptions changes;
  changes.overrides = picture.set;
  changes.overrides.insert(changes.overrides.end(), request.set.begin(), request.set.end());
  const Mission mission = load_mission(picture.mission, changes);
  const AssetLibrary assets = load_assets(mission, {});
  const PileState& pile = piles.of(picture, mission.scenario, assets, request.options.threads);
  const JudgedView view(mission.scenario, assets, pile, request.options);
  const auto start = std::chrono::steady_clock::now();
  const TracedImage image = view.trace();
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const std::string name = picture.name + (request.options.mirror > 0 ? "_mirror" : "");
  view.write(request.out, name, image, seconds);
  std::printf("%s\n", name.c_str());
  std::fflush(stdout);
}

ExitCode bench(Request request) {
  int& threads = request.options.threads;
  if (threads == 0) threads = default_thread_count();
  std::filesystem::create_directories(request.out);
  GalleryPiles piles;
  for (const GallerySection& section : load_gallery(request.list).sections)
    for (const GalleryPicture& picture : section.pictures)
      if (picture.name.find(request.only) != std::string::npos) judge(picture, piles, request);
  return ExitCode::done;
}

ExitCode run(int argc, char** argv) {
  CLI::App app{
      "Traces the views of a list with matt surfaces of one colour each, and writes them, with meshes, sky, "
      "lights and camera, for another renderer. Prints the name of each view that it wrote."};
  Request request;
  request.options.threads = 0;
  app.add_option("--list", request.list, "The views, as docs/gallery.json lists pictures")
      ->capture_default_str();
  app.add_option("--only", request.only, "Only views whose name has this in it");
  app.add_option("--set", request.set, "Another key for every view, as `rubble run --set`");
  app.add_option("--out", request.out, "The folder")->capture_default_str();
  app.add_option("--size", request.options.size, "Side of the square images")->check(CLI::Range(16, 4096))
      ->capture_default_str();
  app.add_option("--samples", request.options.samples, "Paths a pixel")->check(CLI::Range(1, 65536))
      ->capture_default_str();
  app.add_option("--colour", request.options.colour, "How far from grey, of what colours are exported with")
      ->check(CLI::Range(0.0, 10.0))->capture_default_str();
  app.add_option("--mirror", request.options.mirror,
                 "All surfaces are grey mirrors of this roughness, and views are called NAME_mirror; 0: matt")
      ->check(CLI::Range(0.0, 1.0))->capture_default_str();
  app.add_option("--threads", request.options.threads, "0: all processors")->check(CLI::Range(0, 1024));
  return parse_and_run(app, argc, argv, [&] { return bench(request); });
}

}  // namespace
}  // namespace rubble

int main(int argc, char** argv) {
  return rubble::run_program("judge_scenes", [=] { return rubble::run(argc, argv); });
}
