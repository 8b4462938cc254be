#include "app/assets/asset_library.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>

#include "app/assets/asset_loading.h"
#include "app/assets/asset_materials.h"
#include "app/assets/building_assets.h"
#include "app/assets/placed_box.h"
#include "kernel/base/system/disk_cache.h"
#include "kernel/base/system/file_sandbox.h"
#include "scripting/packs/asset_pack.h"
#include "scripting/sandbox/script_file.h"
#include "scripting/schema/schema.h"

namespace rubble {
namespace {

namespace fs = std::filesystem;

constexpr const char* kVictimPack = "victims";

// Every asset of the packs, in their order, but articulated ones last.
std::vector<FoundAsset> list_assets(const std::vector<AssetPack>& packs) {
  std::vector<FoundAsset> all;
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
                        [](const FoundAsset& found) { return found.asset->links.empty(); });
  return all;
}

std::set<std::string> names_used(const Scenario& scenario, const std::vector<FoundAsset>& all) {
  std::set<std::string> used;
  for (const PlacedItem& item : scenario.pile.placed)
    if (!item.box) used.insert(item.asset);
  for (const MixItem& item : scenario.pile.mix) used.insert(item.asset);
  for (const FurnitureItem& item : scenario.pile.furniture) used.insert(item.asset);
  for (const FoundAsset& found : all)
    if (scenario.victims.count > 0 && found.pack->name == kVictimPack) used.insert(found.asset->name);
  if (scenario.pile.mix.empty() && scenario.pile.layers > 0)
    for (const FoundAsset& found : all)
      if (found.asset->weight > 0) used.insert(found.asset->name);
  for (const FoundAsset& found : all)
    if (used.count(found.asset->name))
      for (const AssetLink& link : found.asset->links) used.insert(link.asset);
  return used;
}

// Where people are to lie in the voids, their pack is there without being asked for.
void add_victim_pack(const Scenario& scenario, const std::string& bundled, std::vector<std::string>& folders) {
  const std::string folder = bundled + "/" + kVictimPack;
  if (scenario.victims.count > 0 && std::find(folders.begin(), folders.end(), folder) == folders.end())
    folders.push_back(folder);
}

std::vector<std::string> material_names(const std::vector<Material>& materials) {
  std::vector<std::string> names;
  for (const Material& material : materials) names.push_back(material.name);
  return names;
}

// What is made of several pieces has several materials.
void check_variants(const Mission& mission, const std::vector<FoundAsset>& all) {
  std::vector<Diagnostic> mistakes;
  const std::vector<MixItem>& mix = mission.scenario.pile.mix;
  for (std::size_t i = 0; i < mix.size(); ++i)
    for (const FoundAsset& found : all)
      if (found.asset->name == mix[i].asset && !found.asset->links.empty() &&
          !mix[i].materials.empty())
        mistakes.push_back({mission.script.path, 0,
                            "pile.mix[" + std::to_string(i + 1) + "].materials",
                            "an articulated asset keeps its materials", "an asset with a mesh",
                            "`" + mix[i].asset + "`", "leave them out"});
  if (!mistakes.empty()) throw InputError(std::move(mistakes));
}

// The assets of the mix in the materials that they are drawn in.
void add_variants(const Mission& mission, const std::vector<FoundAsset>& all,
                  const std::vector<Material>& materials, AssetLibrary& library) {
  for (const MixItem& item : mission.scenario.pile.mix)
    for (const MixMaterial& drawn : item.materials)
      for (const FoundAsset& found : all)
        for (const Material& material : materials)
          if (found.asset->name == item.asset && material.name == drawn.material &&
              !library.has(variant_name(item.asset, material.name))) {
            const Asset variant = make_variant(*found.asset, material);
            add_asset({found.pack, &variant}, library);
          }
}

std::vector<std::string> bundled_pack_names() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(bundled_assets_folder()))
    if (fs::exists(entry.path() / "pack.lua")) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

Diagnostic unknown_pack(const std::string& key, const std::string& name) {
  const std::vector<std::string> bundled = bundled_pack_names();
  std::string all;
  for (const std::string& pack : bundled) all += (all.empty() ? "" : ", ") + pack;
  const std::string near = nearest_name(name, bundled);
  return {"", 0, key, "unknown pack `" + name + "`", "a bundled pack (" + all + ") or a folder with a pack.lua",
          "", near.empty() ? "" : "did you mean `" + near + "`?"};
}

// The folders of the mission's packs. Beside the script first: a pack of the user's own may have the name
// of a bundled one.
std::vector<std::string> find_mission_packs(const Mission& mission) {
  std::vector<std::string> folders = pack_folders(mission);
  std::vector<Diagnostic> mistakes;
  for (std::size_t i = 0; i < folders.size(); ++i) {
    const std::string& name = mission.scenario.packs[i];
    if (fs::exists(fs::path(folders[i]) / "pack.lua")) {
      auto refused = find_refusal(folders[i] + "/pack.lua", {"", 0, "packs[" + std::to_string(i + 1) + "]", "", "", "", ""});
      if (refused) mistakes.push_back(std::move(*refused));
      continue;
    }
    if (find_pack(name) != name)
      folders[i] = find_pack(name);
    else if (!fs::is_directory(folders[i]))
      mistakes.push_back(unknown_pack("packs[" + std::to_string(i + 1) + "]", name));
  }
  locate(mistakes, mission.script.path, mission.lines);
  if (!mistakes.empty()) throw InputError(std::move(mistakes));
  return folders;
}

// Every make of box that the mission places.
void add_boxes(const Mission& mission, const std::vector<Material>& materials,
               AssetLibrary& library) {
  std::set<std::string> made;
  for (const PlacedItem& item : mission.scenario.pile.placed)
    if (item.box && made.insert(placed_box_name(item)).second) add_box(item, materials, library);
}

}  // namespace

PieceKind AssetLibrary::find(const PlacedItem& item) const {
  return find(item.box ? placed_box_name(item) : item.asset);
}

PieceKind AssetLibrary::find(const std::string& name) const {
  for (std::size_t i = 0; i < types.size(); ++i)
    if (types[i].name == name) return int(i);
  for (std::size_t i = 0; i < assemblies.size(); ++i)
    if (assemblies[i].name == name) return PieceKind::assembly(int(i));
  throw RunError("asset " + name + " was not loaded");
}

std::vector<int> AssetLibrary::terrain() const {
  std::vector<int> found;
  for (std::size_t i = 0; i < types.size(); ++i)
    if (types[i].surface) found.push_back(int(i));
  return found;
}

std::vector<const TriangleMesh*> AssetLibrary::finest_meshes() const {
  std::vector<const TriangleMesh*> finest;
  for (const auto& mesh : meshes) finest.push_back(&mesh->levels.front());
  return finest;
}

bool AssetLibrary::has(const std::string& name) const {
  const auto is_it = [&name](const auto& type) { return type.name == name; };
  return std::any_of(types.begin(), types.end(), is_it) ||
         std::any_of(assemblies.begin(), assemblies.end(), is_it);
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
  std::error_code failed;
  const fs::path beside = fs::read_symlink("/proc/self/exe", failed).parent_path();
  if (failed)
    throw InputError({"/proc/self/exe", 0, "RUBBLE_ASSETS", "cannot find the folder of the program", "",
                      failed.message(), "mount /proc, or set RUBBLE_ASSETS to the folder of the "
                                        "bundled packs"});
  const fs::path places[] = {beside / "assets", beside / "../share/rubble/assets"};
  for (const fs::path& place : places)
    if (fs::exists(place / "materials.lua", failed)) return place.lexically_normal().string();
  throw InputError({"", 0, "RUBBLE_ASSETS", "the bundled packs are not where they belong",
                    places[0].string() + " or " + places[1].lexically_normal().string(), "neither",
                    "install the program with `cmake --install`, or set RUBBLE_ASSETS to their folder"});
}

void enter_sandbox_of_missions(const std::string& folder) {
  const fs::path packs = bundled_assets_folder(), share = packs.parent_path();
  std::vector<std::string> own{packs.string()};
  if (share.filename() == "rubble") own.push_back(share.string());
  enter_sandbox(folder, own, DiskCache::usual_folder());
}

AssetLibrary load_assets(const Mission& mission, const std::vector<std::string>& extra_packs) {
  const std::string bundled = bundled_assets_folder();
  std::vector<std::string> folders = find_mission_packs(mission);
  for (const std::string& pack : extra_packs) folders.push_back(find_pack(pack));
  if (folders.empty()) folders.push_back(bundled + "/concrete");
  add_victim_pack(mission.scenario, bundled, folders);

  const std::vector<Material> materials = load_materials(bundled + "/materials.lua");
  std::vector<AssetPack> packs;
  for (const std::string& folder : folders) packs.push_back(load_asset_pack(folder, materials));
  const std::vector<FoundAsset> all = list_assets(packs);
  std::vector<std::string> names;
  for (const FoundAsset& found : all) names.push_back(found.asset->name);
  check_assets(mission, names);

  AssetLibrary library;
  for (const AssetPack& pack : packs) library.folders.push_back(pack.folder);
  const std::set<std::string> used = names_used(mission.scenario, all);
  const auto load = [&](bool articulated) {
    for (const FoundAsset& found : all)
      if (used.count(found.asset->name) && found.asset->links.empty() != articulated)
        add_asset(found, library);
  };
  load(false);
  check_materials(mission, material_names(materials));
  check_variants(mission, all);
  add_variants(mission, all, materials, library);
  add_boxes(mission, materials, library);
  try {
    add_terrain(mission.scenario.pile.terrain, {fs::path(mission.script.path).parent_path().string()}, library);
    add_robot_files(mission.scenario.robots, {fs::path(mission.script.path).parent_path().string()}, library);
    add_snapshot(mission.scenario.pile, {fs::path(mission.script.path).parent_path().string()}, library);
    add_building(building_of(mission.scenario.pile, mission.scenario.seed), mission.scenario.pile.terrain.position, library);
  } catch (const InputError& error) {
    std::vector<Diagnostic> mistakes = error.diagnostics();
    locate(mistakes, mission.script.path, mission.lines);
    throw InputError(std::move(mistakes));
  }
  load(true);  // made of types, so after all of them
  library.mix = make_mix(mission.scenario.pile, all, library);
  for (std::string& warning : find_suspicious(mission)) library.warnings.push_back(std::move(warning));
  library.importer.reset();
  return library;
}

}  // namespace rubble
