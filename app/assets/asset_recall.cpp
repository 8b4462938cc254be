// The assets of a provenance, found again by their content.
#include <filesystem>
#include <set>

#include "app/assets/assemblies.h"
#include "app/assets/asset_loading.h"
#include "app/assets/asset_materials.h"
#include "app/assets/building_assets.h"
#include "app/assets/placed_box.h"
#include "app/assets/terrain.h"
#include "scripting/packs/asset_pack.h"

namespace rubble {
namespace {

namespace fs = std::filesystem;

// The terrain that a provenance names, made again.
void remake_terrain(const AssetContent& wanted, const TerrainScenario& spec,
                    const std::vector<std::string>& folders, const std::string& file,
                    AssetLibrary& library) {
  add_terrain(spec, folders, library);
  if (library.contents.back().sha256 == wanted.sha256) return;
  throw InputError({file, 0, "assets", "the terrain has changed",
                    "the content " + wanted.sha256, library.contents.back().sha256,
                    "name the folder of its file with --assets"});
}

// A box that a provenance names, made again.
void remake_box(const AssetContent& wanted, const std::vector<PlacedItem>& placed,
                const std::vector<Material>& materials, const std::string& file,
                AssetLibrary& library) {
  Diagnostic lost{file, 0, "assets", "the box `" + wanted.name + "` cannot be made again", "", "",
                  ""};
  for (const PlacedItem& item : placed) {
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

// The pieces of the building that a provenance names: all of them with the first.
void remake_building(const AssetContent& wanted, const Scenario& scenario, const std::string& file,
                     AssetLibrary& library) {
  if (!library.has(wanted.name)) add_building(building_of(scenario.pile, scenario.seed), scenario.pile.terrain.position, library);
  for (const AssetContent& made : library.contents) {
    if (made.name == wanted.name && made.sha256 == wanted.sha256) return;
  }
  throw InputError({file, 0, "assets", "the building's piece `" + wanted.name + "` cannot be made again",
                    "the content " + wanted.sha256, "another", "use the program that the run was made with"});
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

// One asset with the content that was asked for, as the provenance weights it.
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
        one.importer = library.importer;
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
  static bool take_assembly(const FoundAsset& found, const AssetContent& wanted,
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

// As make_mix, from what a provenance says of its assets.
std::vector<MixEntry> make_mix(const PileScenario& pile, const AssetLibrary& library) {
  AssetPack pack;
  for (const AssetContent& content : library.contents) {
    Asset asset;
    asset.name = content.name;
    asset.weight = content.weight;
    asset.scale = content.scale;
    asset.spread = content.spread;
    pack.assets.push_back(asset);
  }
  std::vector<FoundAsset> all;
  for (const Asset& asset : pack.assets) all.push_back({&pack, &asset});
  return make_mix(pile, all, library);
}

}  // namespace

AssetLibrary load_assets(const Provenance& provenance, const std::vector<std::string>& folders) {
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
  const Provenance& pile = provenance.pile_from ? *provenance.pile_from : provenance;
  const Scenario scenario = stated_scenario(pile);
  for (const AssetContent& wanted : pile.assets) {
    if (wanted.pack == kMadeToMeasure)
      remake_box(wanted, scenario.pile.placed, materials, provenance.script.path, library);
    else if (wanted.pack == kBuildingPack)
      remake_building(wanted, scenario, provenance.script.path, library);
    else if (wanted.pack == kTerrainPack)
      remake_terrain(wanted, scenario.pile.terrain, folders, provenance.script.path, library);
    else
      search.find(wanted, provenance.script.path, library);
  }
  if (!search.missing.empty()) throw InputError(std::move(search.missing));
  library.mix = make_mix(scenario.pile, library);
  library.importer.reset();
  return library;
}

void recall_snapshot(const Provenance& provenance, const std::vector<std::string>& folders, AssetLibrary& library) {
  const Provenance& pile = provenance.pile_from ? *provenance.pile_from : provenance;
  if (!pile.snapshot) return;
  add_snapshot(stated_scenario(pile).pile, folders, library);
  const std::string found = library.snapshot ? library.snapshot->sha256 : "none";
  if (found != pile.snapshot->sha256)
    throw InputError({pile.script.path, 0, "pile.snapshot", "the file \"" + pile.snapshot->file + "\" has changed",
                      "the content " + pile.snapshot->sha256, found, "name the folder of the file as it was with --assets"});
}

void recall_robots(const Provenance& provenance, const std::vector<std::string>& folders, AssetLibrary& library) {
  add_robot_files(stated_scenario(provenance).robots, folders, library);
  for (std::size_t i = 0; i < provenance.robots.size(); ++i) {
    const RobotContent& wanted = provenance.robots[i];
    const std::string found = i < library.robots.size() ? library.robots[i].sha256 : "no such robot";
    if (found != wanted.sha256)
      throw InputError({provenance.script.path, 0, "robots", "the URDF file \"" + wanted.urdf + "\" or one of its meshes has changed",
                        "the content " + wanted.sha256, found, "name the folder of the file as it was with --assets"});
  }
}

}  // namespace rubble
