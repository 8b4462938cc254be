#include "app/assets/terrain.h"

#include <algorithm>
#include <filesystem>

#include "app/assets/asset_materials.h"
#include "kernel/base/hash.h"
#include "kernel/base/mesh_edges.h"
#include "kernel/base/number_text.h"
#include "kernel/base/system/file_sandbox.h"
#include "kernel/geometry/height_field.h"
#include "render/materials/surface_appearance.h"

namespace rubble {
namespace {

namespace fs = std::filesystem;

constexpr double kDepth = 0.5;  // of a height field's bottom under the ground; unit: m
constexpr double kLargestMeant = 2e4;  // of a terrain whose units are right; unit: m
constexpr const char* kGroundAppearance = "ground";

bool is_surface_appearance(const std::string& name) {
  const std::vector<std::string> known = known_surface_appearances();
  return name == kGroundAppearance || std::find(known.begin(), known.end(), name) != known.end();
}

void check_surface_appearance(const std::string& name) {
  if (name.empty() || is_surface_appearance(name)) return;
  Diagnostic d;
  d.key = "pile.terrain.look";
  d.message = "no such look";
  for (const std::string& known : known_surface_appearances()) d.expected += known + ", ";
  d.expected += kGroundAppearance;
  d.found = "\"" + name + "\"";
  throw InputError(d);
}

// About the middle of the grid: single precision is finest there.
TriangleMesh make_heights(const TerrainScenario& spec) {
  HeightField field;
  field.columns = spec.columns;
  field.rows = spec.rows;
  field.spacing = spec.spacing;
  field.origin = {-0.5 * (spec.columns - 1) * spec.spacing, -0.5 * (spec.rows - 1) * spec.spacing,
                  0};
  field.heights = spec.heights;
  const double lowest = *std::min_element(spec.heights.begin(), spec.heights.end());
  return make_height_field_mesh(field, lowest + spec.position.z + kDepth,
                                spec.look.empty() ? kGroundAppearance : spec.look);
}

std::string find_file(const std::string& name, const std::vector<std::string>& folders) {
  std::string looked;
  for (const std::string& folder : folders) {
    const fs::path path = fs::path(folder) / name;
    std::error_code failed;
    if (fs::is_regular_file(path, failed)) {
      check_may_read(path.string(), {"", 0, "pile.terrain.file", "", "", "", ""});
      return path.lexically_normal().string();
    }
    looked += (looked.empty() ? "" : ", ") + path.string();
  }
  throw InputError({"", 0, "pile.terrain.file", "no such file", "a mesh", "\"" + name + "\"",
                    looked.empty() ? "its folder is not known: name it with --assets, or `assets` in Python"
                                   : "looked for " + looked + "; --assets, or `assets` in Python, names further folders"});
}

std::string hash_mesh(const TriangleMesh& mesh, double friction) {
  Sha256 hash;
  hash.add(&friction, sizeof friction);
  hash.add(mesh.positions.data(), mesh.positions.size() * sizeof mesh.positions[0]);
  hash.add(mesh.triangles.data(), mesh.triangles.size() * sizeof mesh.triangles[0]);
  for (const std::string& name : mesh.surface_names) hash.add(name.c_str(), name.size() + 1);
  hash.add(mesh.surfaces.data(), mesh.surfaces.size());
  for (const auto& paint : mesh.paints)
    if (paint) hash.add(paint->sha256.data(), paint->sha256.size());
  for (const auto& corners : mesh.paint_corners)
    for (const PaintCorner& c : corners)
      for (const float x : {c.u, c.v, c.colour.x, c.colour.y, c.colour.z}) hash.add(&x, sizeof x);
  return hash.hex();
}

}  // namespace

MadeTerrain make_terrain(const TerrainScenario& spec, const std::vector<std::string>& folders,
                         MeshImporter& importer) {
  check_surface_appearance(spec.look);
  MadeTerrain terrain;
  auto scene = std::make_shared<SceneMesh>();
  if (spec.file.empty()) {
    scene->levels.push_back(make_heights(spec));
  } else {
    const std::string path = find_file(spec.file, folders);
    scene->levels.push_back(importer.load_mesh(path, {spec.metres_per_unit, spec.up}));
    TriangleMesh& mesh = scene->levels.back();
    choose_surfaces(mesh, [&spec](const std::string& surface, const SurfacePaint* paint) {
      if (is_surface_appearance(surface) && !outdoes_name(paint)) return surface;
      if (paint && spec.look.empty()) return std::string();
      return spec.look.empty() ? std::string(kGroundAppearance) : spec.look;
    });
    terrain.folder = fs::absolute(path).parent_path().lexically_normal().string();
    if (!is_closed(mesh))
      terrain.warnings.push_back(path + ": the mesh is not closed: " + describe(find_open_edges(mesh)) +
                                 ". It has no inside for maps of voids");
    const Vec3 size = mesh.bounds().max - mesh.bounds().min;
    if (const double largest = std::max(size.x, size.y); largest > kLargestMeant)
      terrain.warnings.push_back(path + ": the terrain is " + brief_text(largest) + " m large: are its `units` right?");
    for (const std::string& note : importer.notes().shape) terrain.warnings.push_back(path + ": " + note);
    if (has_paint(mesh))
      for (const std::string& note : importer.notes().looks) terrain.warnings.push_back(path + ": " + note);
  }
  const TriangleMesh& mesh = scene->levels.front();
  terrain.sha256 = hash_mesh(mesh, spec.friction);
  terrain.type.name = kTerrainName;
  terrain.type.friction = spec.friction;
  terrain.type.surface = std::shared_ptr<const TriangleMesh>(scene, &mesh);
  terrain.mesh = std::move(scene);
  return terrain;
}

Placement place_terrain(const TerrainScenario& spec, int type) {
  Placement placement;
  placement.kind = type;
  placement.world_from_body.translation = spec.position;
  placement.fixed = true;
  return placement;
}

}  // namespace rubble
