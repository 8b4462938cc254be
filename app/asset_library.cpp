#include "app/asset_library.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>

#include "app/assemblies.h"
#include "app/decompose_cache.h"
#include "app/material_variant.h"
#include "app/placed_box.h"
#include "app/terrain.h"
#include "io/mesh_file.h"
#include "kernel/base/hash.h"
#include "render/looks.h"
#include "scripting/asset_pack.h"

namespace rubble {
namespace {

namespace fs = std::filesystem;

struct Found {
  const AssetPack* pack;
  const Asset* asset;
};

// Every asset of the packs, in their order, but articulated ones last.
std::vector<Found> list_assets(const std::vector<AssetPack>& packs) {
  std::vector<Found> all;
  std::map<std::string, const AssetPack*> first;
  std::vector<Diagnostic> mistakes;
  for (const AssetPack& pack : packs)
    for (const Asset& asset : pack.assets) {
      const auto [it, is_new] = first.emplace(asset.name, &pack);
      if (is_new)
        all.push_back({&pack, &asset});
      else
        mistakes.push_back({pack.script, asset.line, asset.name, "asset defined in two packs", "",
                            "", "the other one is in " + it->second->script + "; rename one"});
    }
  if (!mistakes.empty()) throw InputError(std::move(mistakes));
  // Pieces before what is made of them.
  std::stable_partition(all.begin(), all.end(),
                        [](const Found& found) { return found.asset->links.empty(); });
  return all;
}

std::set<std::string> names_used(const Scenario& scenario, const std::vector<Found>& all) {
  std::set<std::string> used;
  for (const PlacedItem& item : scenario.pile.placed)
    if (!item.box) used.insert(item.asset);
  for (const MixItem& item : scenario.pile.mix) used.insert(item.asset);
  if (scenario.pile.mix.empty() && scenario.pile.layers > 0)
    for (const Found& found : all)
      if (found.asset->weight > 0) used.insert(found.asset->name);
  for (const Found& found : all)
    if (used.count(found.asset->name))
      for (const AssetLink& link : found.asset->links) used.insert(link.asset);
  return used;
}

PieceType make_type(const Asset& asset, const TriangleMesh& mesh, const MeshUnits& units,
                    std::string& warning) {
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
    for (std::vector<Vec3>& points : load_convex_parts(asset.parts, units))
      type.parts.push_back({std::move(points)});
  }
  if (is_closed(mesh) && calc_volume_properties(mesh).volume > 0)
    type.volume = calc_volume_properties(mesh);
  else
    warning = asset.meshes.front() +
              ": the mesh is not closed: mass and inertia come from its convex parts";
  return type;
}

std::string hash_content(const Asset& asset, const PieceType& type) {
  Sha256 hash;
  std::vector<std::string> files = asset.meshes;
  if (!asset.parts.empty()) files.push_back(asset.parts);
  for (const std::string& file : files) {
    const std::string content = sha256_of_file(file);
    hash.add(content.data(), content.size());
  }
  const double up = asset.up == UpAxis::y ? 1 : 0, cut = asset.decompose ? 1 : 0;
  for (const double number : {type.density, type.friction, asset.metres_per_unit, up, cut})
    hash.add(&number, sizeof number);
  return hash.hex();
}

// The pack's word for it, else a name that is a look, else that of the asset or its material.
std::string choose_look(const Asset& asset, const std::string& surface) {
  for (const auto& [name, look] : asset.looks)
    if (name == surface) return look;
  const std::vector<std::string> known = known_looks();
  const bool is_look = std::find(known.begin(), known.end(), surface) != known.end();
  return is_look || asset.look.empty() ? surface : asset.look;
}

void add_asset(const Found& found, AssetLibrary& library) {
  if (!found.asset->links.empty()) {
    library.assemblies.push_back(make_assembly(*found.asset, library));
    library.contents.push_back(
        {found.asset->name, found.pack->name,
         hash_content(*found.asset, library.assemblies.back(), library), found.asset->weight,
         found.asset->scale, found.asset->spread});
    return;
  }
  LoadedAsset loaded = load_asset(*found.asset);
  if (!loaded.warning.empty()) library.warnings.push_back(loaded.warning);
  library.contents.push_back(
      {loaded.type.name, found.pack->name, hash_content(*found.asset, loaded.type),
       found.asset->weight, found.asset->scale, found.asset->spread});
  library.types.push_back(std::move(loaded.type));
  library.meshes.push_back(std::move(loaded.mesh));
}

std::vector<std::string> material_names(const std::vector<Material>& materials) {
  std::vector<std::string> names;
  for (const Material& material : materials) names.push_back(material.name);
  return names;
}

// What is made of several pieces has several materials.
void check_variants(const Mission& mission, const std::vector<Found>& all) {
  std::vector<Diagnostic> mistakes;
  const std::vector<MixItem>& mix = mission.scenario.pile.mix;
  for (std::size_t i = 0; i < mix.size(); ++i)
    for (const Found& found : all)
      if (found.asset->name == mix[i].asset && !found.asset->links.empty() &&
          !mix[i].materials.empty())
        mistakes.push_back({mission.script.path, 0,
                            "pile.mix[" + std::to_string(i + 1) + "].materials",
                            "an articulated asset keeps its materials", "an asset with a mesh",
                            "`" + mix[i].asset + "`", "leave them out"});
  if (!mistakes.empty()) throw InputError(std::move(mistakes));
}

// The assets of the mix in the materials that they are drawn in.
void add_variants(const Mission& mission, const std::vector<Found>& all,
                  const std::vector<Material>& materials, AssetLibrary& library) {
  for (const MixItem& item : mission.scenario.pile.mix)
    for (const MixMaterial& drawn : item.materials)
      for (const Found& found : all)
        for (const Material& material : materials)
          if (found.asset->name == item.asset && material.name == drawn.material &&
              !library.has(variant_name(item.asset, material.name))) {
            const Asset variant = make_variant(*found.asset, material);
            add_asset({found.pack, &variant}, library);
          }
}

void add_box(const PlacedItem& item, const std::vector<Material>& materials,
             AssetLibrary& library) {
  MadeBox box = make_placed_box(item, materials);
  library.contents.push_back(
      {box.type.name, kMadeToMeasure, std::move(box.sha256), 0, {1, 1}, {}});
  library.types.push_back(std::move(box.type));
  library.meshes.push_back(std::move(box.mesh));
}

// Every make of box that the mission places.
void add_boxes(const Mission& mission, const std::vector<Material>& materials,
               AssetLibrary& library) {
  std::set<std::string> made;
  for (const PlacedItem& item : mission.scenario.pile.placed)
    if (item.box && made.insert(placed_box_name(item)).second) add_box(item, materials, library);
}

void add_terrain(const TerrainScenario& spec, std::vector<std::string> folders,
                 AssetLibrary& library) {
  if (!spec.given()) return;
  MadeTerrain terrain = make_terrain(spec, folders);
  if (!terrain.warning.empty()) library.warnings.push_back(terrain.warning);
  if (!terrain.folder.empty()) library.folders.push_back(terrain.folder);
  library.contents.push_back({kTerrainName, kTerrainPack, terrain.sha256, 0, {1, 1}, {}});
  library.types.push_back(std::move(terrain.type));
  library.meshes.push_back(std::move(terrain.mesh));
}

// Likewise, the terrain.
void remake_terrain(const AssetContent& wanted, const TerrainScenario& spec,
                    const std::vector<std::string>& folders, const std::string& file,
                    AssetLibrary& library) {
  add_terrain(spec, folders, library);
  if (library.contents.back().sha256 == wanted.sha256) return;
  throw InputError({file, 0, "assets", "the terrain is another one now",
                    "the content " + wanted.sha256, library.contents.back().sha256,
                    "name the folder of its file with --assets"});
}

// A box that a recipe names, made again.
void remake_box(const AssetContent& wanted, const Scenario& scenario,
                const std::vector<Material>& materials, const std::string& file,
                AssetLibrary& library) {
  Diagnostic lost{file, 0, "assets", "the box `" + wanted.name + "` cannot be made again", "", "",
                  ""};
  for (const PlacedItem& item : scenario.pile.placed) {
    if (!item.box || placed_box_name(item) != wanted.name) continue;
    add_box(item, materials, library);
    if (library.contents.back().sha256 == wanted.sha256) return;
    lost.expected = "the content " + wanted.sha256;
    lost.found = library.contents.back().sha256;
    break;
  }
  lost.hint = "use the program that the run was made with";
  throw InputError(lost);
}

// What layers are drawn from: the mission's mix, or every asset by its own weight.
std::vector<MixEntry> make_mix(const Scenario& scenario, const std::vector<Found>& all,
                               const AssetLibrary& library) {
  std::map<std::string, const Asset*> by_name;
  for (const Found& found : all) by_name[found.asset->name] = found.asset;
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
  for (const Found& found : all)
    if (found.asset->weight > 0 && scenario.pile.layers > 0)
      mix.push_back({library.find(found.asset->name), found.asset->weight, found.asset->scale[0],
                     found.asset->scale[1], found.asset->spread});
  return mix;
}

// A folder of packs stands for all of them.
void add_packs(const std::string& folder, std::set<std::string>& seen,
               std::vector<std::string>& packs) {
  std::error_code failed;
  const std::string path = fs::absolute(folder).lexically_normal().string();
  if (fs::is_regular_file(path + "/pack.lua", failed)) {
    if (seen.insert(path).second) packs.push_back(path);
    return;
  }
  std::set<std::string> inside;  // sorted: the order in which a file system lists is its own
  for (const auto& entry : fs::directory_iterator(path, failed))
    if (fs::is_regular_file(entry.path() / "pack.lua", failed))
      inside.insert(entry.path().string());
  for (const std::string& pack : inside)
    if (seen.insert(pack).second) packs.push_back(pack);
}

// One asset with the content that was asked for, as the recipe weights it.
struct Search {
  const std::vector<AssetPack>& packs;
  const std::vector<Material>& materials;
  std::vector<Diagnostic> missing;
  std::vector<std::string> looked_in;

  void find(const AssetContent& wanted, const std::string& file, AssetLibrary& library) {
    std::string other;
    for (const AssetPack& pack : packs)
      for (const Asset& candidate : pack.assets) {
        const std::optional<Asset> named = find_variant(candidate, wanted.name, materials);
        if (!named) continue;
        Asset asset = *named;
        asset.weight = wanted.weight;
        asset.scale = wanted.scale;
        asset.spread = wanted.spread;
        if (!asset.links.empty()) {
          if (take_assembly({&pack, &asset}, wanted, library)) return;
          other = "in " + pack.folder + " it has another content";
          continue;
        }
        AssetLibrary one;
        add_asset({&pack, &asset}, one);
        if (one.contents.back().sha256 == wanted.sha256) return keep(one, wanted, library);
        other = "in " + pack.folder + " it has the content " + one.contents.back().sha256;
      }
    std::string places;
    for (const std::string& folder : looked_in) places += (places.empty() ? "" : ", ") + folder;
    missing.push_back({file, 0, "assets",
                       "the asset `" + wanted.name + "` of pack `" + wanted.pack + "` is missing",
                       "the content " + wanted.sha256, other,
                       "looked in " + places + "; name its folder with --assets"});
  }

  // Its pieces were found before it, or it is not the one.
  static bool take_assembly(const Found& found, const AssetContent& wanted,
                            AssetLibrary& library) {
    for (const AssetLink& link : found.asset->links)
      if (!library.has(link.asset)) return false;
    const AssemblyType assembly = make_assembly(*found.asset, library);
    if (hash_content(*found.asset, assembly, library) != wanted.sha256) return false;
    library.assemblies.push_back(assembly);
    library.contents.push_back(wanted);
    return true;
  }

  static void keep(AssetLibrary& one, const AssetContent& wanted, AssetLibrary& library) {
    library.types.push_back(std::move(one.types.back()));
    library.meshes.push_back(std::move(one.meshes.back()));
    library.contents.push_back(wanted);
    for (std::string& warning : one.warnings) library.warnings.push_back(std::move(warning));
  }
};

// As make_mix, from what a recipe says of its assets.
std::vector<MixEntry> make_mix(const Scenario& scenario, const AssetLibrary& library) {
  AssetPack pack;
  for (const AssetContent& content : library.contents) {
    Asset asset;
    asset.name = content.name;
    asset.weight = content.weight;
    asset.scale = content.scale;
    asset.spread = content.spread;
    pack.assets.push_back(asset);
  }
  std::vector<Found> all;
  for (const Asset& asset : pack.assets) all.push_back({&pack, &asset});
  return make_mix(scenario, all, library);
}

}  // namespace

int AssetLibrary::find(const PlacedItem& item) const {
  return find(item.box ? placed_box_name(item) : item.asset);
}

int AssetLibrary::find(const std::string& name) const {
  for (std::size_t i = 0; i < types.size(); ++i)
    if (types[i].name == name) return int(i);
  for (std::size_t i = 0; i < assemblies.size(); ++i)
    if (assemblies[i].name == name) return int(types.size() + i);
  throw RunError("asset " + name + " was not loaded");
}

std::vector<int> AssetLibrary::terrain() const {
  std::vector<int> found;
  for (std::size_t i = 0; i < types.size(); ++i)
    if (types[i].surface) found.push_back(int(i));
  return found;
}

bool AssetLibrary::has(const std::string& name) const {
  const auto is_it = [&name](const auto& type) { return type.name == name; };
  return std::any_of(types.begin(), types.end(), is_it) ||
         std::any_of(assemblies.begin(), assemblies.end(), is_it);
}

LoadedAsset load_asset(const Asset& asset) {
  const MeshUnits units{asset.metres_per_unit, asset.up};
  auto mesh = std::make_shared<SceneMesh>();
  for (const std::string& path : asset.meshes) {
    mesh->levels.push_back(load_mesh(path, units));
    for (std::string& surface : mesh->levels.back().surface_names)
      surface = choose_look(asset, surface);
  }
  LoadedAsset loaded;
  loaded.type = make_type(asset, mesh->levels.front(), units, loaded.warning);
  loaded.mesh = std::move(mesh);
  return loaded;
}

std::string find_pack(const std::string& pack) {
  std::error_code failed;
  const fs::path bundled = fs::path(bundled_assets_folder()) / pack;
  if (fs::exists(fs::path(pack) / "pack.lua", failed)) return pack;
  const bool is_name = !pack.empty() && pack.find_first_of("/.") == std::string::npos;
  return is_name && fs::exists(bundled / "pack.lua", failed) ? bundled.string() : pack;
}

std::string bundled_assets_folder() {
  if (const char* folder = std::getenv("RUBBLE_ASSETS")) return folder;
  return (fs::read_symlink("/proc/self/exe").parent_path() / "assets").string();
}

AssetLibrary load_assets(const Mission& mission, const std::vector<std::string>& extra_packs) {
  const std::string bundled = bundled_assets_folder();
  // Beside the script first: a pack of the user's own may have the name of a bundled one.
  std::vector<std::string> folders = pack_folders(mission);
  for (std::size_t i = 0; i < folders.size(); ++i) {
    const std::string& name = mission.scenario.packs[i];
    if (!fs::exists(fs::path(folders[i]) / "pack.lua") && find_pack(name) != name)
      folders[i] = find_pack(name);
  }
  for (const std::string& pack : extra_packs) folders.push_back(find_pack(pack));
  if (folders.empty()) folders.push_back(bundled + "/concrete");

  const std::vector<Material> materials = load_materials(bundled + "/materials.lua");
  std::vector<AssetPack> packs;
  for (const std::string& folder : folders) packs.push_back(load_asset_pack(folder, materials));
  const std::vector<Found> all = list_assets(packs);
  std::vector<std::string> names;
  for (const Found& found : all) names.push_back(found.asset->name);
  check_assets(mission, names);

  AssetLibrary library;
  for (const AssetPack& pack : packs) library.folders.push_back(pack.folder);
  const std::set<std::string> used = names_used(mission.scenario, all);
  const auto load = [&](bool articulated) {
    for (const Found& found : all)
      if (used.count(found.asset->name) && found.asset->links.empty() != articulated)
        add_asset(found, library);
  };
  load(false);
  check_materials(mission, material_names(materials));
  check_variants(mission, all);
  add_variants(mission, all, materials, library);
  add_boxes(mission, materials, library);
  add_terrain(mission.scenario.pile.terrain,
              {fs::path(mission.script.path).parent_path().string()}, library);
  load(true);  // made of types, so after all of them
  library.mix = make_mix(mission.scenario, all, library);
  return library;
}

AssetLibrary load_assets(const Recipe& recipe, const std::vector<std::string>& folders) {
  const std::string bundled = bundled_assets_folder();
  std::set<std::string> seen;
  AssetLibrary library;
  for (const std::string& folder : folders) add_packs(folder, seen, library.folders);
  add_packs(bundled, seen, library.folders);
  const std::vector<Material> materials = load_materials(bundled + "/materials.lua");
  std::vector<AssetPack> packs;
  for (const std::string& folder : library.folders)
    packs.push_back(load_asset_pack(folder, materials));
  Search search{packs, materials, {}, library.folders};
  const Recipe& pile = recipe.pile_from ? *recipe.pile_from : recipe;
  const Scenario scenario = stated_scenario(pile);
  for (const AssetContent& wanted : pile.assets) {
    if (wanted.pack == kMadeToMeasure)
      remake_box(wanted, scenario, materials, recipe.script.path, library);
    else if (wanted.pack == kTerrainPack)
      remake_terrain(wanted, scenario.pile.terrain, folders, recipe.script.path, library);
    else
      search.find(wanted, recipe.script.path, library);
  }
  if (!search.missing.empty()) throw InputError(std::move(search.missing));
  library.mix = make_mix(scenario, library);
  return library;
}

}  // namespace rubble
