#include "app/assets/asset_loading.h"

#include <algorithm>
#include <filesystem>
#include <cstdio>
#include <map>

#include "app/assets/assemblies.h"
#include "app/assets/decompose_cache.h"
#include "app/assets/hull_error.h"
#include "app/assets/material_variant.h"
#include "app/assets/placed_box.h"
#include "app/assets/surface_choice.h"
#include "app/assets/terrain.h"
#include "io/mesh/mesh_file.h"
#include "kernel/base/hash.h"
#include "kernel/base/mesh_edges.h"
#include "render/materials/surface_appearance.h"
#include "scripting/schema/schema.h"

namespace rubble {
namespace {

PieceType make_type(const Asset& asset, const TriangleMesh& mesh, const MeshUnits& units,
                    MeshImporter& importer, std::vector<std::string>& warnings) {
  PieceType type;
  type.name = asset.name;
  type.density = asset.density;
  type.friction = asset.friction;
  if (asset.decompose) {
    type.parts = decompose_cached(mesh, DiskCache(DiskCache::usual_folder()));
  } else if (asset.parts.empty()) {
    type.parts.emplace_back();
    for (const Vec3f& p : mesh.positions) type.parts[0].points.push_back(Vec3(p));
  } else {
    for (std::vector<Vec3>& points : importer.load_convex_parts(asset.parts, units))
      type.parts.push_back({std::move(points)});
  }
  const bool closed = is_closed(mesh);
  if (closed && calc_volume_properties(mesh).volume > 0)
    type.volume = calc_volume_properties(mesh);
  else
    warnings.push_back(asset.meshes.front() + ": the mesh is " +
                       (closed ? "inside out: its triangles face inwards"
                               : "not closed: " + describe(find_open_edges(mesh))) +
                       ". Mass and inertia come from its convex parts");
  return type;
}

// Of what decompose() gives: another one is another content. 2: meshes of boxes are cut without error.
constexpr double kDecomposeVersion = 2;

std::string hash_content(const Asset& asset, const LoadedAsset& loaded) {
  const PieceType& type = loaded.type;
  Sha256 hash;
  std::vector<std::string> files = asset.meshes;
  if (!asset.parts.empty()) files.push_back(asset.parts);
  for (const std::string& file : files) {
    const std::string content = sha256_of_file(file);
    hash.add(content.data(), content.size());
  }
  const double up = asset.up == UpAxis::y ? 1 : 0, cut = asset.decompose ? kDecomposeVersion : 0;
  for (const double number : {type.density, type.friction, asset.metres_per_unit, up, cut})
    hash.add(&number, sizeof number);
  // Images and an OBJ's materials lie in files of their own.
  for (const TriangleMesh& level : loaded.mesh->levels)
    for (const auto& paint : level.paints)
      if (paint) hash.add(paint->sha256.data(), paint->sha256.size());
  return hash.hex();
}

// The pack's word for it, else the file's image, else a name that is a look, else the file's colours, else that of the
// asset or its material.
std::string choose_surface_appearance(const Asset& asset, const std::string& surface, const SurfacePaint* paint) {
  for (const auto& [name, look] : asset.surface_appearance)
    if (name == surface) return look;
  const std::vector<std::string> known = known_surface_appearances();
  const bool named = std::find(known.begin(), known.end(), surface) != known.end();
  if (outdoes_name(paint) && !asset.look_given) return "";
  if (named) return surface;
  if (paint && !asset.look_given) return "";
  return asset.look.empty() ? surface : asset.look;
}

// Of what a mesh is cut into, the share beyond the mesh that is worth a word.
constexpr double kNotedExcess = 0.1;

// The sum of the parts' volumes is quick to tell; it counts twice where parts overlap.
void warn_of_excess(const Asset& asset, const TriangleMesh& mesh, const PieceType& type,
                    std::vector<std::string>& warnings) {
  if (!asset.decompose || !type.volume) return;
  double sum = 0;
  for (const ConvexPart& part : type.parts) sum += calc_volume_properties(part).volume;
  if (sum <= (1 + kNotedExcess) * type.volume->volume) return;
  const HullError error = calc_hull_error(mesh, compile_shape(type, type.name));
  if (error.outside <= kNotedExcess * error.mesh) return;
  char text[160];
  std::snprintf(text, sizeof text,
                ": its %zu convex parts hold %.0f %% more than the mesh: pieces will keep apart that would "
                "touch; name parts of your own by collision = { parts = FILE }",
                type.parts.size(), 100 * error.outside / error.mesh);
  warnings.push_back(asset.meshes.front() + text);
}

constexpr double kSmallest = 1e-3, kLargest = 1e3;  // of a piece that was meant so; unit: m

void warn_of_size(const Asset& asset, const TriangleMesh& mesh, std::vector<std::string>& warnings) {
  const Vec3 size = mesh.bounds().max - mesh.bounds().min;
  const double largest = std::max({size.x, size.y, size.z});
  if (largest >= kSmallest && largest <= kLargest) return;
  char text[64];
  std::snprintf(text, sizeof text, ": the mesh is %.3g m large", largest);
  warnings.push_back(asset.meshes.front() + text + ": are its `units` right?");
}

// A surface that `looks` names and no mesh of the asset has.
void warn_of_surface_appearances(const Asset& asset, const std::vector<std::string>& surfaces,
                                 std::vector<std::string>& warnings) {
  for (const auto& [name, look] : asset.surface_appearance) {
    if (std::find(surfaces.begin(), surfaces.end(), name) != surfaces.end()) continue;
    const std::string near = nearest_name(name, surfaces);
    std::string there;
    for (const std::string& surface : surfaces) there += (there.empty() ? "`" : ", `") + surface + "`";
    warnings.push_back(asset.meshes.front() + ": `looks` of `" + asset.name +
                       "` names the surface `" + name + "`, which the mesh has not: " +
                       (near.empty() ? "it has " + there : "did you mean `" + near + "`?"));
  }
}

}  // namespace

LoadedAsset load_asset(const Asset& asset, MeshImporter& importer) {
  const MeshUnits units{asset.metres_per_unit, asset.up};
  auto mesh = std::make_shared<SceneMesh>();
  LoadedAsset loaded;
  std::vector<std::string> surfaces;
  for (const std::string& path : asset.meshes) {
    mesh->levels.push_back(importer.load_mesh(path, units));
    TriangleMesh& level = mesh->levels.back();
    surfaces.insert(surfaces.end(), level.surface_names.begin(), level.surface_names.end());
    choose_surfaces(level, [&asset](const std::string& surface, const SurfacePaint* paint) {
      return choose_surface_appearance(asset, surface, paint);
    });
    for (const std::string& note : importer.notes().shape) loaded.warnings.push_back(path + ": " + note);
    if (!has_paint(level)) continue;
    for (const std::string& note : importer.notes().looks) loaded.warnings.push_back(path + ": " + note);
  }
  warn_of_size(asset, mesh->levels.front(), loaded.warnings);
  warn_of_surface_appearances(asset, surfaces, loaded.warnings);
  loaded.type = make_type(asset, mesh->levels.front(), units, importer, loaded.warnings);
  warn_of_excess(asset, mesh->levels.front(), loaded.type, loaded.warnings);
  loaded.mesh = std::move(mesh);
  return loaded;
}

void add_asset(const FoundAsset& found, AssetLibrary& library) {
  if (!found.asset->links.empty()) {
    library.assemblies.push_back(make_assembly(*found.asset, library));
    library.contents.push_back({found.asset->name, found.pack->name,
                                hash_content(*found.asset, library.assemblies.back(), library),
                                found.asset->weight, found.asset->scale, found.asset->spread});
    return;
  }
  LoadedAsset loaded = load_asset(*found.asset, *library.importer);
  library.warnings.insert(library.warnings.end(), loaded.warnings.begin(), loaded.warnings.end());
  library.contents.push_back({loaded.type.name, found.pack->name,
                              hash_content(*found.asset, loaded), found.asset->weight,
                              found.asset->scale, found.asset->spread});
  library.types.push_back(std::move(loaded.type));
  library.meshes.push_back(std::move(loaded.mesh));
}

void add_box(const PlacedItem& item, const std::vector<Material>& materials,
             AssetLibrary& library) {
  MadeBox box = make_placed_box(item, materials);
  library.contents.push_back({box.type.name, kMadeToMeasure, std::move(box.sha256), 0, {1, 1}, {}});
  library.types.push_back(std::move(box.type));
  library.meshes.push_back(std::move(box.mesh));
}

void add_terrain(const TerrainScenario& spec, const std::vector<std::string>& folders,
                 AssetLibrary& library) {
  if (!spec.given()) return;
  MadeTerrain terrain = make_terrain(spec, folders, *library.importer);
  library.warnings.insert(library.warnings.end(), terrain.warnings.begin(), terrain.warnings.end());
  if (!terrain.folder.empty()) library.folders.push_back(terrain.folder);
  library.contents.push_back({kTerrainName, kTerrainPack, terrain.sha256, 0, {1, 1}, {}});
  library.types.push_back(std::move(terrain.type));
  library.meshes.push_back(std::move(terrain.mesh));
}

void add_robot_folders(const Scenario& scenario, const std::vector<std::string>& folders,
                       AssetLibrary& library) {
  namespace fs = std::filesystem;
  std::error_code failed;
  for (const RobotItem& robot : scenario.robots) {
    if (robot.urdf.empty()) continue;
    for (const std::string& folder : folders)
      for (const fs::path& tried :
           {fs::path(folder) / robot.urdf, fs::path(folder) / fs::path(robot.urdf).filename()})
        if (fs::is_regular_file(tried, failed))
          library.folders.push_back(fs::absolute(tried).parent_path().lexically_normal().string());
  }
}

std::vector<MixEntry> make_mix(const Scenario& scenario, const std::vector<FoundAsset>& all,
                               const AssetLibrary& library) {
  std::map<std::string, const Asset*> by_name;
  for (const FoundAsset& found : all) by_name[found.asset->name] = found.asset;
  std::vector<MixEntry> mix;
  for (const MixItem& item : scenario.pile.mix) {
    const Asset& asset = *by_name.at(item.asset);
    const auto scale = item.scale.value_or(asset.scale);
    const bool own = !item.scale && item.spread.kind == Spread::uniform;
    const MixEntry entry{library.find(item.asset), item.weight, scale[0], scale[1],
                         own ? asset.spread : item.spread};
    if (item.materials.empty()) mix.push_back(entry);
    double sum = 0;
    for (const MixMaterial& m : item.materials) sum += m.weight;
    for (const MixMaterial& m : item.materials) {
      mix.push_back(entry);
      mix.back().type = library.find(variant_name(item.asset, m.material));
      mix.back().weight = item.weight * m.weight / sum;
    }
  }
  if (!scenario.pile.mix.empty()) return mix;
  for (const FoundAsset& found : all)
    if (found.asset->weight > 0 && scenario.pile.layers > 0)
      mix.push_back({library.find(found.asset->name), found.asset->weight, found.asset->scale[0],
                     found.asset->scale[1], found.asset->spread});
  return mix;
}

}  // namespace rubble
