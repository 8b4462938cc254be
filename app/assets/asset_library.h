// The assets of a run, loaded: what the kernel drops and what the renderer draws, by one index.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/provenance/provenance.h"
#include "io/mesh/mesh_file.h"
#include "kernel/model/pile.h"
#include "render/scene/scene.h"
#include "scripting/mission.h"
#include "scripting/packs/asset_pack.h"

namespace rubble {

struct AssetLibrary {
  std::vector<PieceType> types;                          // numbered as the pile's pieces have it
  std::vector<std::shared_ptr<const SceneMesh>> meshes;  // one per type
  std::vector<AssemblyType> assemblies;                  // articulated assets, made of the types
  std::vector<AssetContent> contents;                    // one per type, then one per assembly
  std::vector<MixEntry> mix;                             // what the mission draws from
  std::vector<std::string> warnings;                     // e.g. a mesh that is not closed
  std::vector<std::string> folders;                      // of the packs, absolute
  std::vector<RobotContent> robots;                      // of the mission's URDF files
  std::optional<SnapshotContent> snapshot;               // that settling goes on from; not given: from the start
  std::string snapshot_file;                             // its path
  std::vector<std::string> robot_files;                  // their paths, one per robot; "": a bundled robot
  int building_first_type = 0;                           // of the building's pieces, if there is one
  std::shared_ptr<const BuildingStructures> structures;  // of the building; null: there is none
  std::vector<CutFrom> building_cuts;                    // by piece of the building, in the pile's order
  // What reads the meshes; let go when all are loaded.
  std::shared_ptr<MeshImporter> importer = std::make_shared<MeshImporter>();

  // The type or assembly of that name. Throws RunError.
  PieceKind find(const std::string& name) const;
  bool has(const std::string& name) const;
  PieceKind find(const PlacedItem& item) const;  // likewise, of its asset or its box
  std::vector<int> terrain() const;        // the indices of types that are terrain; one or none
  std::vector<const TriangleMesh*> finest_meshes() const;  // one per type, kept by the library
};

// Loads what the mission uses, from its packs and then `extra_packs`; with neither, from the
// bundled pack `concrete`. Throws InputError with every mistake: an unknown asset, a mesh that
// cannot be read, two packs with an asset of the same name.
AssetLibrary load_assets(const Mission& mission, const std::vector<std::string>& extra_packs);

// Loads the very assets that a run's provenance names, wherever their packs are now: looks in
// `folders` (packs, or folders of packs), then among the bundled ones, and takes what has the same
// content. Throws InputError naming each that is missing, and where it was looked for.
AssetLibrary load_assets(const Provenance& provenance, const std::vector<std::string>& folders);

// The URDF files of a mission's robots, looked for in these folders: their contents and paths go into the library, and
// their folders into library.folders. Throws InputError for one that is missing or no URDF.
void add_robot_files(const std::vector<RobotItem>& robots, const std::vector<std::string>& folders, AssetLibrary& library);
// The same of a provenance. Throws InputError, too, where one has another content than the provenance says. That of an
// older program does not say.
void recall_robots(const Provenance& provenance, const std::vector<std::string>& folders, AssetLibrary& library);
// The same two of the mission's snapshot (pile.snapshot).
void add_snapshot(const PileScenario& pile, const std::vector<std::string>& folders, AssetLibrary& library);
void recall_snapshot(const Provenance& provenance, const std::vector<std::string>& folders, AssetLibrary& library);
// One asset with all that it refers to. Throws InputError for a file that cannot be read.
struct LoadedAsset {
  PieceType type;
  std::shared_ptr<const SceneMesh> mesh;
  bool exact_parts = false;  // cut by decompose() without any error
  double parts_gap = 0;      // largest distance of parts that decompose() made from the mesh; unit: m
  std::vector<std::string> warnings;  // e.g. that the mesh is not closed; each begins with a file
};
LoadedAsset load_asset(const Asset& asset, MeshImporter& importer);

// The folder of a pack: a folder with a pack.lua, else a bundled pack of that name, else `pack`
// itself.
std::string find_pack(const std::string& pack);

// Where the bundled packs and materials.lua are: $RUBBLE_ASSETS; `assets` beside the program, as in a
// build; or ../share/rubble/assets from there, as installed. Throws InputError where there are none.
std::string bundled_assets_folder();

// --sandbox: as enter_sandbox() of kernel/base/system/file_sandbox.h, with the folders of the program itself: bundled packs,
// what is installed in share/rubble, and the cache.
void enter_sandbox_of_missions(const std::string& folder);

}  // namespace rubble
