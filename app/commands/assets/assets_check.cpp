// `rubble assets check`: what is sound in a pack and what is not.
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/assets/asset_library.h"
#include "app/assets/assets_tree.h"
#include "app/assets/convex_parts.h"
#include "app/command_line/command.h"
#include "app/support/print.h"
#include "render/materials/surface_appearance.h"

namespace rubble {
namespace {

// Thinner parts can be passed through at usual speeds; unit: m
constexpr double kThin = 0.01;
// Contact costs grow with the corners.
constexpr std::size_t kManyCorners = 64;
// Pieces that look far apart where they touch, or far sunk: the mean gap over the surface that a
// volume amounts to, beyond what thin sheet needs for its parts' least thickness. unit: m
constexpr double kLooseHull = 0.016;

struct AssetReport {
  std::string name;
  bool closed = false;
  Vec3 size;                           // of the box around the mesh; unit: m
  double volume = 0, mass = 0;         // unit: m3, kg
  std::size_t parts = 0, corners = 0;  // corners: of the part that has most
  double thinnest = 0;                 // unit: m
  HullError error;                     // of closed meshes
  double gap = -1;                     // of parts that are cut from the mesh, from it; unit: m
  std::vector<std::size_t> triangles;
  std::vector<std::string> errors, warnings;
};

std::string millimetres(double length) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f mm", 1000 * length);
  return text;
}

void check_levels(const SceneMesh& mesh, AssetReport& report) {
  for (std::size_t i = 0; i < mesh.levels.size(); ++i) {
    const TriangleMesh& level = mesh.levels[i];
    report.triangles.push_back(level.triangles.size());
    if (i && is_closed(level) != report.closed)
      report.warnings.push_back(
          "level of detail " + std::to_string(i) +
          (report.closed ? " is not closed" : " is closed, the finest is not"));
    if (i && level.triangles.size() >= mesh.levels[i - 1].triangles.size())
      report.warnings.push_back("level of detail " + std::to_string(i) +
                                " is no coarser than the one before");
    for (std::size_t s = 0; s < level.surface_names.size(); ++s) {
      if (level.paint_of(s)) continue;
      try {
        find_surface_appearance(level.surface_names[s]);
      } catch (const RunError& error) {
        if (i == 0) report.errors.push_back(error.what());
      }
    }
  }
}

void check_parts(const Shape& shape, AssetReport& report) {
  report.parts = shape.parts.size();
  report.thinnest = 1e9;
  for (std::size_t i = 0; i < shape.parts.size(); ++i) {
    const double thickness = calc_thickness(shape.parts[i]);
    report.thinnest = std::min(report.thinnest, thickness);
    report.corners = std::max(report.corners, shape.parts[i].corners.size());
    if (thickness < kThin - 1e-6)
      report.warnings.push_back("part " + std::to_string(i + 1) + " is " + millimetres(thickness) +
                                " thin; below " + millimetres(kThin) +
                                " pieces can pass through each other");
    if (shape.parts[i].corners.size() > kManyCorners)
      report.warnings.push_back("part " + std::to_string(i + 1) + " has " +
                                std::to_string(shape.parts[i].corners.size()) +
                                " corners; contact is slow above " + std::to_string(kManyCorners));
  }
}

void check_hull(const Asset& asset, const TriangleMesh& mesh, const Shape& shape, AssetReport& report) {
  report.error = calc_hull_error(mesh, shape);
  if (asset.decompose) return;  // load_asset() says where its parts do not fit
  double area = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3 a(mesh.positions[t[0]]), b(mesh.positions[t[1]]), c(mesh.positions[t[2]]);
    area += 0.5 * norm(cross(b - a, c - a));
  }
  const double out = report.error.outside / area, in = report.error.inside / area;
  if (out > kLooseHull)
    report.warnings.push_back(
        "the parts exceed the mesh by " + millimetres(out) +
        " in the mean: pieces will seem to float; " +
        (asset.parts.empty() ? "try collision = \"decompose\"" : "bring the parts of " + asset.parts + " nearer to it"));
  if (in > kLooseHull)
    report.warnings.push_back("the parts lie inside the mesh by " + millimetres(in) +
                              " on average: other pieces will sink into it");
}

// A sound one goes into the library, for what is made of it.
AssetReport check_asset(const Asset& asset, AssetLibrary& library) {
  AssetReport report;
  report.name = asset.name;
  report.warnings = asset.idle_keys;
  try {
    const LoadedAsset loaded = load_asset(asset, *library.importer);
    const TriangleMesh& mesh = loaded.mesh->levels.front();
    report.size = mesh.bounds().max - mesh.bounds().min;
    report.closed = is_closed(mesh);
    report.warnings.insert(report.warnings.end(), loaded.warnings.begin(), loaded.warnings.end());
    if (asset.decompose) report.gap = loaded.parts_gap;
    check_levels(*loaded.mesh, report);
    const Shape shape = compile_shape(loaded.type, asset.name);
    report.volume = shape.volume.volume;
    report.mass = report.volume * loaded.type.density;
    check_parts(shape, report);
    if (report.closed) check_hull(asset, mesh, shape, report);
    library.types.push_back(loaded.type);
    library.meshes.push_back(loaded.mesh);
  } catch (const InputError& error) {
    for (const Diagnostic& d : error.diagnostics()) report.errors.push_back(d.text());
  }
  return report;
}

// Of what is made of others: false where one of them could not be loaded, which was said of it.
bool add_tree(const Asset& asset, const AssetLibrary& library, std::vector<TreeReport>& trees) {
  for (const AssetLink& link : asset.links)
    if (!library.has(link.asset)) return false;
  trees.push_back(check_tree(asset, library));
  trees.back().warnings.insert(trees.back().warnings.end(), asset.idle_keys.begin(), asset.idle_keys.end());
  return trees.back().errors.empty();
}

template <typename Report>
void print_remarks(const std::vector<Report>& reports) {
  for (const Report& r : reports) {
    for (const std::string& text : r.errors)
      print_out("error: %s: %s\n", r.name.c_str(), text.c_str());
    for (const std::string& text : r.warnings)
      print_out("warning: %s: %s\n", r.name.c_str(), text.c_str());
  }
}

void print_trees(const std::vector<TreeReport>& trees) {
  if (trees.empty()) return;
  print_out("\n%-24s %6s %6s %10s %5s  %s\n", "articulated", "links", "joints", "mass (kg)",
            "parts", "size (m)");
  for (const TreeReport& t : trees)
    print_out("%-24s %6zu %6zu %10.2f %5zu  %.2f x %.2f x %.2f\n", t.name.c_str(), t.links,
              t.joints, t.mass, t.parts, t.size.x, t.size.y, t.size.z);
}

void print_table(const AssetPack& pack, const std::vector<AssetReport>& reports,
                 const std::vector<TreeReport>& trees) {
  print_out("%-24s %6s %12s %10s %5s %7s %8s %8s %8s  %s\n", "asset", "closed", "volume (m3)",
            "mass (kg)", "parts", "corners", "thin(mm)", "out (%)", "in (%)", "triangles");
  for (const AssetReport& r : reports) {
    std::string triangles;
    for (const std::size_t n : r.triangles)
      triangles += (triangles.empty() ? "" : ", ") + std::to_string(n);
    const double scale = r.closed && r.error.mesh > 0 ? 100 / r.error.mesh : 0;
    print_out("%-24s %6s %12.5f %10.2f %5zu %7zu %8.1f ", r.name.c_str(), r.closed ? "yes" : "no",
              r.volume, r.mass, r.parts, r.corners, 1000 * r.thinnest);
    if (scale > 0)
      print_out("%8.1f %8.1f", scale * r.error.outside, scale * r.error.inside);
    else
      print_out("%8s %8s", "-", "-");
    print_out("  %s\n", triangles.c_str());
  }
  print_trees(trees);
  print_remarks(reports);
  print_remarks(trees);
  const std::size_t count = reports.size() + trees.size();
  print_out("%s: %zu %s, %zu articulated\n", pack.name.c_str(), count, count == 1 ? "asset" : "assets", trees.size());
}

nlohmann::ordered_json json_of(const TreeReport& t) {
  return {{"name", t.name},     {"links", t.links},
          {"joints", t.joints}, {"size_m", {t.size.x, t.size.y, t.size.z}},
          {"mass_kg", t.mass},  {"parts", t.parts},
          {"errors", t.errors}, {"warnings", t.warnings}};
}

void print_report_json(const AssetPack& pack, const std::vector<AssetReport>& reports,
                const std::vector<TreeReport>& trees) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const AssetReport& r : reports) {
    nlohmann::ordered_json entry{{"name", r.name},
                                 {"closed", r.closed},
                                 {"size_m", {r.size.x, r.size.y, r.size.z}},
                                 {"volume_m3", r.volume},
                                 {"mass_kg", r.mass},
                                 {"parts", r.parts},
                                 {"most_corners", r.corners},
                                 {"thinnest_m", r.thinnest},
                                 {"triangles", r.triangles}};
    if (r.closed) {
      entry["parts_outside_mesh_m3"] = r.error.outside;
      entry["mesh_outside_parts_m3"] = r.error.inside;
    }
    if (r.gap >= 0) entry["parts_farthest_from_mesh_m"] = r.gap;
    entry["errors"] = r.errors;
    entry["warnings"] = r.warnings;
    list.push_back(std::move(entry));
  }
  nlohmann::ordered_json articulated = nlohmann::ordered_json::array();
  for (const TreeReport& tree : trees) articulated.push_back(json_of(tree));
  const nlohmann::ordered_json whole{
      {"pack", pack.name}, {"folder", pack.folder}, {"assets", list}, {"articulated", articulated}};
  print_json(whole.dump(2) + "\n");
}

// `bad_input` when something is not sound.
ExitCode check_pack(const std::string& pack_name, bool json) {
  const std::vector<Material> materials =
      load_materials(bundled_assets_folder() + "/materials.lua");
  const AssetPack pack = load_asset_pack(find_pack(pack_name), materials);
  std::vector<AssetReport> reports;
  std::vector<TreeReport> trees;
  AssetLibrary library;
  bool sound = true;
  for (const Asset& asset : pack.assets) {
    if (!asset.links.empty()) continue;
    reports.push_back(check_asset(asset, library));
    sound = sound && reports.back().errors.empty();
  }
  for (const Asset& asset : pack.assets)
    if (!asset.links.empty()) sound = add_tree(asset, library, trees) && sound;
  json ? print_report_json(pack, reports, trees) : print_table(pack, reports, trees);
  return sound ? ExitCode::done : ExitCode::bad_input;
}

struct AssetsCheckRequest {
  std::string pack;   // a folder with a pack.lua, or the name of a bundled one
  bool json = false;  // --json
};

Action declare_assets_check(CommandLine& line) {
  const auto request = std::make_shared<AssetsCheckRequest>();
  line.add("pack", request->pack, "A folder with a pack.lua, or the name of a bundled pack").required().metavar("PACK");
  line.add_flag("--json", request->json, "Print JSON instead of a table");
  return [request] { return check_pack(request->pack, request->json); };
}

}  // namespace

Command assets_check_command() {
  return {"assets", "check", "Check a pack: closed meshes, masses, fit of the collision parts",
          declare_assets_check};
}

}  // namespace rubble
