#include "app/assets/asset_loading.h"

#include <algorithm>
#include <filesystem>
#include <cstdio>
#include <map>
#include <stdexcept>

#include "app/assets/assemblies.h"
#include "app/assets/asset_materials.h"
#include "app/assets/convex_parts.h"
#include "app/assets/placed_box.h"
#include "app/assets/terrain.h"
#include "io/mesh/mesh_content.h"
#include "io/mesh/mesh_file.h"
#include "io/robot/urdf_reader.h"
#include "kernel/base/hash.h"
#include "kernel/base/mesh_edges.h"
#include "kernel/base/system/file_sandbox.h"
#include "kernel/geometry/hull.h"
#include "kernel/geometry/shape.h"
#include "kernel/geometry/simplify_hull.h"
#include "render/materials/surface_appearance.h"
#include "scripting/schema/schema.h"

namespace rubble {
namespace {

std::string describe_share(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.0f %%", 100 * share);
  return text;
}

std::string describe_length(double metres) {
  char text[32];
  metres < 0.1 ? std::snprintf(text, sizeof text, "%.3g mm", 1000 * metres) : std::snprintf(text, sizeof text, "%.3g m", metres);
  return text;
}

constexpr double kSimplified = 0.0025;  // of the size of a part with too many corners: how much of it is lost, if it can be so little

void simplify_part(const std::string& file, ConvexPart& part, std::vector<std::string>& warnings) {
  Aabb box;
  for (const Vec3& p : part.points) box.include(p);
  const Vec3 extent = box.max - box.min;
  const double size = std::max({extent.x, extent.y, extent.z});
  try {
    if (part.points.size() <= kMostPartCorners) return;
    const std::size_t corners = calc_hull(part.points).points.size();
    if (corners <= kMostPartCorners) return;
    SimpleHull simple = simplify_hull(part.points, kMostPartCorners, kSimplified * size);
    warnings.push_back(file + ": its hull has " + std::to_string(corners) + " corners, more than the " + std::to_string(kMostPartCorners) +
                       " that a part may have: it collides with " + std::to_string(simple.points.size()) +
                       " of them, from which no other stands out by more than " + describe_length(simple.error));
    part.points = std::move(simple.points);
  } catch (const std::invalid_argument&) {
    // Flat: compile_shape() says so.
  }
}

// What of a decomposition is worth a word. A part is at least as thick as collision needs, which a thin sheet is not.
constexpr double kNotedExcess = 0.1;   // of the mesh's volume: of the parts outside it
constexpr double kNotedLack = 0.05;    // likewise: of it outside the parts
constexpr double kFineGap = 0.01;      // of the mesh's size: parts that stand out by less are near enough, however thin it is
constexpr double kNotedGap = 0.03;     // likewise: parts that stand out by more close a hollow, however small
constexpr double kThinPart = 0.006;    // half of what thin parts are widened to; unit: m

void warn_of_misfit(const Asset& asset, const TriangleMesh& mesh, const Decomposition& made,
                    std::vector<std::string>& warnings) {
  if (made.exact || !(made.volume > 0)) return;
  const Vec3 extent = mesh.bounds().max - mesh.bounds().min;
  const double size = std::max({extent.x, extent.y, extent.z});
  const double outside = made.misfit.outside / made.volume, inside = made.misfit.inside / made.volume;
  const bool far = made.misfit.gap > std::max(2 * kThinPart, kNotedGap * size);
  const bool large = outside > kNotedExcess && made.misfit.gap > std::max(kThinPart, kFineGap * size);
  if (!far && !large && inside <= kNotedLack) return;
  std::string text = asset.meshes.front() + ": its " + std::to_string(made.parts.size()) + " convex parts ";
  if (far || large)
    text += "hold " + describe_share(outside) + " more than the mesh and stand out of it by up to " +
            describe_length(made.misfit.gap) + ": pieces will keep apart that would touch";
  else
    text += "lack " + describe_share(inside) + " of the mesh: pieces will sink into it";
  warnings.push_back(text + "; name parts of your own by collision = { parts = FILE }, or make it of several assets");
}

PieceType make_type(const Asset& asset, const TriangleMesh& mesh, const MeshUnits& units,
                    MeshImporter& importer, LoadedAsset& loaded) {
  std::vector<std::string>& warnings = loaded.warnings;
  PieceType type;
  type.name = asset.name;
  type.density = asset.density;
  type.friction = asset.friction;
  if (asset.decompose) {
    Decomposition made = decompose_cached(mesh, DiskCache(DiskCache::usual_folder()));
    warn_of_misfit(asset, mesh, made, warnings);
    type.parts = std::move(made.parts);
    loaded.exact_parts = made.exact, loaded.parts_gap = made.misfit.gap;
  } else if (asset.parts.empty()) {
    type.parts.emplace_back();
    for (const Vec3f& p : mesh.positions) type.parts[0].points.push_back(Vec3(p));
  } else {
    for (std::vector<Vec3>& points : importer.load_convex_parts(asset.parts, units))
      type.parts.push_back({std::move(points)});
  }
  for (ConvexPart& part : type.parts) simplify_part(asset.parts.empty() ? asset.meshes.front() : asset.parts, part, warnings);
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

// Of what decompose() gives: another one is another content. Exact parts have been the same since 2; others: 3.
constexpr double kExactDecomposeVersion = 2, kDecomposeVersion = 3;

std::string hash_content(const Asset& asset, const LoadedAsset& loaded) {
  const PieceType& type = loaded.type;
  Sha256 hash;
  std::vector<std::string> files = asset.meshes;
  if (!asset.parts.empty()) files.push_back(asset.parts);
  for (const std::string& file : files) {
    const std::string content = sha256_of_mesh(file, MeshContent::geometry);
    hash.add(content.data(), content.size());
  }
  const double up = asset.up == UpAxis::y ? 1 : 0, cut = !asset.decompose ? 0 : loaded.exact_parts ? kExactDecomposeVersion : kDecomposeVersion;
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

constexpr double kSmallest = 1e-3, kLargest = 100;  // of a piece that was meant so; unit: m

void warn_of_size(const Asset& asset, const TriangleMesh& mesh, std::vector<std::string>& warnings) {
  const Aabb box = mesh.bounds();
  const Vec3 size = box.max - box.min;
  const double largest = std::max({size.x, size.y, size.z});
  const double off = norm(max(max(box.min, -box.max), Vec3{}));
  if (off > largest)
    warnings.push_back(asset.meshes.front() + ": the mesh lies " + describe_length(off) +
                       " from its origin, which is what the `position` of a placed piece means; move it there when "
                       "it is exported");
  if (largest >= kSmallest && largest <= kLargest) return;
  char text[64];
  std::snprintf(text, sizeof text, ": the mesh is %.3g m large", largest);
  warnings.push_back(asset.meshes.front() + text + ": are its `units` right?");
}

// A surface that `looks` names and no mesh of the asset has.
void warn_of_surface_appearances(const Asset& asset, const std::vector<std::string>& surfaces,
                                 std::vector<std::string>& warnings) {
  if (is_variant(asset)) return;  // which names every look that the other material changes, whoever has it
  for (const auto& [name, look] : asset.surface_appearance) {
    if (std::find(surfaces.begin(), surfaces.end(), name) != surfaces.end()) continue;
    const std::string near = nearest_name(name, surfaces);
    std::string there;
    for (const std::string& surface : surfaces) there += (there.empty() ? "`" : ", `") + surface + "`";
    warnings.push_back(asset.meshes.front() + ": `looks` of `" + asset.name +
                       "` names the surface `" + name + "`, which the mesh does not have: " +
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
    for (const std::string& name : level.surface_names)
      if (std::find(surfaces.begin(), surfaces.end(), name) == surfaces.end()) surfaces.push_back(name);
    choose_surfaces(level, [&asset](const std::string& surface, const SurfacePaint* paint) {
      return choose_surface_appearance(asset, surface, paint);
    });
    for (const std::string& note : importer.notes().shape) loaded.warnings.push_back(path + ": " + note);
    if (!has_paint(level)) continue;
    for (const std::string& note : importer.notes().looks) loaded.warnings.push_back(path + ": " + note);
  }
  warn_of_size(asset, mesh->levels.front(), loaded.warnings);
  warn_of_surface_appearances(asset, surfaces, loaded.warnings);
  loaded.type = make_type(asset, mesh->levels.front(), units, importer, loaded);
  loaded.mesh = std::move(mesh);
  return loaded;
}

void add_asset(const FoundAsset& found, AssetLibrary& library) {
  const std::vector<std::string>& idle = found.asset->idle_keys;
  library.warnings.insert(library.warnings.end(), idle.begin(), idle.end());
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

namespace {

// In one of the folders, under its whole name or its last part. kind: of a file, as "a URDF file".
std::string find_named_file(const std::string& name, const std::vector<std::string>& folders, const std::string& key,
                            const std::string& kind) {
  namespace fs = std::filesystem;
  std::string looked;
  std::error_code failed;
  for (const std::string& folder : folders)
    for (const fs::path& tried : {fs::path(folder) / name, fs::path(folder) / fs::path(name).filename()}) {
      if (fs::is_regular_file(tried, failed)) {
        check_may_read(tried.string(), {"", 0, key, "", "", "", ""});
        return fs::absolute(tried).lexically_normal().string();
      }
      looked += (looked.empty() ? "" : ", ") + tried.string();
    }
  throw InputError({"", 0, key, "no such file", kind, "\"" + name + "\"",
                    looked.empty() ? "its folder is not known: name it with --assets, or `assets` in Python"
                                   : "looked for " + looked});
}

// What the tool made of a xacro file, without what depends on where the files are: comments, and the folders of meshes.
std::string without_places(const std::string& text) {
  std::string kept;
  const std::string_view open = "<!--", close = "-->", name = "filename=";
  for (std::size_t at = 0; at < text.size();) {
    if (text.compare(at, open.size(), open) == 0) {
      const std::size_t end = text.find(close, at);
      at = end == std::string::npos ? text.size() : end + close.size();
    } else if (text.compare(at, name.size(), name) == 0 && at + name.size() < text.size()) {
      const std::size_t from = at + name.size() + 1, end = std::min(text.find(text[from - 1], from), text.size());
      kept += name;
      kept += std::filesystem::path(text.substr(from, end - from)).filename().string();
      at = end;
    } else {
      kept += text[at++];
    }
  }
  return kept;
}

std::string hash_urdf(const std::string& path, const std::vector<std::pair<std::string, std::string>>& arguments) {
  const UrdfFile robot = read_urdf(path, arguments);
  std::string sums = robot.expanded.empty() ? sha256_of_file(path) : sha256(without_places(robot.expanded));
  for (const UrdfLink& link : robot.links)
    for (const auto* list : {&link.collisions, &link.visuals})
      for (const UrdfGeometry& geometry : *list)
        if (!geometry.file.empty()) sums += sha256_of_mesh(geometry.file, MeshContent::all);
  return sha256(sums);
}

}  // namespace

void add_snapshot(const PileScenario& pile, const std::vector<std::string>& folders, AssetLibrary& library) {
  if (!pile.snapshot) return;
  library.snapshot_file = find_named_file(*pile.snapshot, folders, "pile.snapshot", "a file that `rubble inspect` saved");
  library.snapshot = SnapshotContent{*pile.snapshot, sha256_of_file(library.snapshot_file)};
  library.folders.push_back(std::filesystem::path(library.snapshot_file).parent_path().string());
}

void add_robot_files(const std::vector<RobotItem>& robots, const std::vector<std::string>& folders,
                     AssetLibrary& library) {
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const RobotItem& robot = robots[i];
    library.robot_files.emplace_back();
    if (robot.urdf.empty()) continue;
    const std::string path = find_named_file(robot.urdf, folders, "robots[" + std::to_string(i + 1) + "].urdf", "a URDF file");
    library.robot_files.back() = path;
    library.robots.push_back({robot.urdf, hash_urdf(path, robot.urdf_arguments)});
    library.folders.push_back(std::filesystem::path(path).parent_path().string());
  }
}

std::vector<MixEntry> make_mix(const PileScenario& pile, const std::vector<FoundAsset>& all,
                               const AssetLibrary& library) {
  std::map<std::string, const Asset*> by_name;
  for (const FoundAsset& found : all) by_name[found.asset->name] = found.asset;
  std::vector<MixEntry> mix;
  for (const MixItem& item : pile.mix) {
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
      mix.back().kind = library.find(variant_name(item.asset, m.material));
      mix.back().weight = item.weight * m.weight / sum;
    }
  }
  if (!pile.mix.empty()) return mix;
  for (const FoundAsset& found : all)
    if (found.asset->weight > 0 && pile.layers > 0)
      mix.push_back({library.find(found.asset->name), found.asset->weight, found.asset->scale[0],
                     found.asset->scale[1], found.asset->spread});
  return mix;
}

}  // namespace rubble
