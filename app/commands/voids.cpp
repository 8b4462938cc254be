// `rubble voids`: from a settled pile to the map of its voids.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <set>
#include <string_view>

#include "app/command_line/command.h"
#include "app/command_line/common_options.h"
#include "app/mission/finished_run.h"
#include "app/support/freed_memory.h"
#include "app/support/print.h"
#include "app/support/progress.h"
#include "app/support/stop.h"
#include "io/base/atomic_file.h"
#include "io/voids/void_files.h"
#include "kernel/base/number_text.h"
#include "kernel/base/parallel.h"
#include "kernel/voids/solid_voxels.h"
#include "kernel/voids/void_map.h"

namespace rubble {
namespace {

struct VoidRequest {
  SpaceRequest space;
  int surfaces = 20;   // --surfaces: the largest voids of each radius, as PLY
  std::string out;     // --out; empty: `voids` in the folder of the run
  bool force = false;  // --force
};

constexpr double kShownAround = 0.2;  // of the outside, in pictures; unit: m

std::string millimetres(double radius) { return std::to_string(int(std::lround(radius * 1000))); }

std::string surface_name(double radius, std::size_t rank) {
  return "void_r" + millimetres(radius) + "_" + std::to_string(rank) + ".ply";
}

bool is_number(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

// Whether this command writes files of this name, with whatever options.
bool is_name_of_map(const std::string& name) {
  for (const char* whole : {"voids.json", "voids.vdb", "voids.bt"})
    if (name == whole) return true;
  const auto between = [&name](std::string_view head, std::string_view tail) {
    const bool fits = name.size() > head.size() + tail.size() && name.compare(0, head.size(), head) == 0 &&
                      name.compare(name.size() - tail.size(), tail.size(), tail) == 0;
    return fits ? name.substr(head.size(), name.size() - head.size() - tail.size()) : std::string();
  };
  for (const char* picture : {"plan_r", "cut_x_r", "cut_y_r"})
    if (is_number(between(picture, ".png"))) return true;
  const std::string surface = between("void_r", ".ply");
  const std::size_t dash = surface.find('_');
  return dash != std::string::npos && is_number(surface.substr(0, dash)) && is_number(surface.substr(dash + 1));
}

// What an earlier map left, which is replaced whole: files of two maps together would describe neither.
std::vector<std::string> list_earlier_map(const std::string& out) {
  std::vector<std::string> names;
  std::error_code failed;
  for (std::filesystem::directory_iterator at(out, failed), end; !failed && at != end; at.increment(failed)) {
    std::string name = at->path().filename().string();
    if (at->path().extension() == ".part") name = at->path().stem().string();
    if (is_name_of_map(name)) names.push_back(name);
  }
  return names;
}

void check_radii(const std::vector<double>& radii) {
  std::set<std::string> names;
  for (const double radius : radii) {
    if (!names.insert(millimetres(radius)).second)
      throw InputError({"", 0, "--radius", "is given twice", "radii that differ by a millimetre",
                        plain_text(radius), ""});
  }
}

// terrain: the indices of types that are terrain.
Solids place_solids_of(const FolderRequest& request, std::vector<int>& terrain) {
  const FinishedRun saved = open_finished_run(request.folder);
  const AssetLibrary assets = load_assets_of(saved, request.asset_packs);
  terrain = assets.terrain();
  return place_solids(load_pile_of(saved), assets.finest_meshes());
}

VoidSpace make_space(const FolderRequest& request, const VoidRequest& voids, const VoidProgress& progress) {
  VoidSpaceOptions options;
  options.voxel = voids.space.voxel;
  double largest = 0;
  for (const double radius : voids.space.radii) largest = std::max(largest, radius);
  options.rolling_radius = outside_radius_for(voids.space.outside_radius, largest);
  options.memory_limit = voids.space.memory_gib * (1 << 30);
  options.threads = request.options.threads;
  options.margin = kShownAround;
  Solids solids = place_solids_of(request, options.scenery);
  return_freed_memory();  // of the assets
  return calc_void_space(std::move(solids), options, progress);
}

VoidMap make_map(const FolderRequest& request, const VoidRequest& voids, Progress& progress) {
  const auto report = [&progress](const char* what, double from, double share) {
    return [&progress, what, from, share](double done) {
      throw_if_stopped("");
      progress.update(from + share * done, what);
      return true;
    };
  };
  VoidSpace space = make_space(request, voids, report("clearance", 0, 0.6));
  return_freed_memory();  // of the solids
  VoidMap map = find_voids(std::move(space), voids.space.radii, report("voids", 0.6, 0.4));
  return_freed_memory();
  return map;
}

// Through the deepest place of the largest void, both ways.
void write_pictures(const VoidMap& map, const std::string& title, const std::string& folder) {
  for (std::size_t r = 0; r < map.robots.size(); ++r) {
    const RobotVoids& robot = map.robots[r];
    VoidPictureOptions options;
    options.title = title;
    const std::string end = "_r" + millimetres(robot.radius) + ".png";
    write_png(folder + "/plan" + end, draw_void_plan(map, r, options), 6);
    if (robot.voids.empty()) continue;
    const Vec3 through = robot.voids.front().deepest;
    write_png(folder + "/cut_x" + end, draw_void_cut(map, r, 0, through, options), 6);
    write_png(folder + "/cut_y" + end, draw_void_cut(map, r, 1, through, options), 6);
  }
}

using Jobs = std::vector<std::function<void()>>;  // for several threads; what takes long comes first

Jobs list_map_jobs(const VoidMap& map, const std::string& title, const std::string& folder) {
  return {[&map, folder] { write_vdb(folder + "/voids.vdb", map); },
          [&map, folder] { write_octomap(folder + "/voids.bt", map.space); },
          [&map, folder] { write_text_file(folder + "/voids.json", make_void_json(map)); },
          [&map, title, folder] { write_pictures(map, title, folder); }};
}

Jobs list_surface_jobs(const VoidMap& map, int surfaces, const std::string& folder) {
  Jobs jobs;
  for (const RobotVoids& robot : map.robots) {
    const std::size_t shown = std::min(robot.voids.size(), std::size_t(surfaces));
    for (std::size_t i = 0; i < shown; ++i)
      jobs.push_back([&map, &robot, i, folder] {
        write_void_surface(folder + "/" + surface_name(robot.radius, i + 1),
                           make_void_surface(map.space, robot.voids[i]), map.space.pile_state);
      });
  }
  return jobs;
}

void print_summary(const VoidMap& map) {
  print_out("%-8s %6s %11s %11s %9s %9s %9s\n", "radius", "voids", "volume", "reachable",
            "entrances", "longest", "deepest");
  for (const RobotVoids& robot : map.robots) {
    std::size_t entrances = 0;
    double longest = 0, deepest = 0;
    for (const Void& v : robot.voids) {
      entrances += v.entrances.size();
      longest = std::max(longest, v.path_length);
      deepest = std::max(deepest, v.depth);
    }
    print_out("%6.3f m %6zu %8.3f m3 %8.3f m3 %9zu %7.2f m %7.2f m\n", robot.radius,
              robot.voids.size(), robot.volume, robot.reachable_volume, entrances, longest,
              deepest);
    if (robot.voids.empty())
      print_err("no void has room for a robot of radius %g m\n", robot.radius);
  }
}

ExitCode map_voids(const FolderRequest& request, const VoidRequest& voids) {
  stop_on_signals();
  check_radii(voids.space.radii);
  Progress progress(choose_progress_style(request.options.quiet));
  progress.start("voids");
  VoidMap map = make_map(request, voids, progress);
  char text[160];
  std::snprintf(text, sizeof text,
                "%d x %d x %d voxels, %.2f m3 solid, %.2f m3 void, %.2f m3 under a roof",
                map.space.grid.size[0], map.space.grid.size[1], map.space.grid.size[2],
                map.solid_volume, map.void_volume, map.covered_volume);
  progress.finish(text);

  progress.start("files");
  const std::string folder = output_folder_of(voids.out, request.folder, "voids");
  prepare_output_folder(folder, voids.force, list_earlier_map(folder));
  const std::string title = std::filesystem::path(request.folder).filename().string();
  const auto run = [&](const Jobs& jobs) {
    parallel_for(jobs.size(), ThreadPool(request.options.threads).threads(), [&](std::size_t i) { jobs[i](); });
  };
  run(list_map_jobs(map, title, folder));
  // The surface of a large void takes as much memory as these, which it does not need.
  map.widest = {}, map.space.clearance = {}, map.space.kind = {};
  run(list_surface_jobs(map, voids.surfaces, folder));
  progress.finish(folder);
  print_summary(map);
  print_out("%s\n", folder.c_str());
  return ExitCode::done;
}

Action declare_voids(CommandLine& line) {
  const auto of = std::make_shared<FolderRequest>();
  const auto request = std::make_shared<VoidRequest>();
  add_folder_options(line, *of);
  add_threads_option(line, of->options.threads);
  add_quiet_option(line, of->options.quiet);
  add_space_options(line, request->space);
  line.add("--surfaces", request->surfaces,
           "Number of voids for each radius whose surfaces are written, largest first")
      .shows_default()
      .between(0, 100000);
  line.add("--out", request->out, "Output folder")
      .shows_default_text("FOLDER/voids")
      .metavar("DIR");
  line.add_flag("--force", request->force, "Replace the files of an earlier map");
  return [of, request] { return map_voids(*of, *request); };
}

}  // namespace

Command voids_command() {
  return {"", "voids", "Map the voids of the pile of a run: entrances, volumes, widest paths",
          declare_voids};
}

}  // namespace rubble
