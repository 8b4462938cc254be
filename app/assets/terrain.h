// What a mission's terrain is made into: what pieces lie on, what is drawn, asked and exported.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "io/mesh/mesh_file.h"
#include "kernel/model/pile.h"
#include "render/scene/scene.h"
#include "scripting/scenario/scenario.h"

namespace rubble {

// Its type's name, and the pack that a provenance names for it.
inline constexpr const char* kTerrainName = "terrain";
inline constexpr const char* kTerrainPack = "terrain of the mission";

struct MadeTerrain {
  PieceType type;                         // its surface is the very mesh that is drawn
  std::shared_ptr<const SceneMesh> mesh;  // at full detail, for the renderer
  std::string sha256;                     // over the mesh, its looks and the friction
  std::string folder;                     // absolute, where its file was found; empty: it has none
  std::vector<std::string> warnings;      // e.g. that the mesh is not closed
};

// `folders`: where a file may be, in order. Throws InputError for a file that is not there or cannot
// be read, and for an unknown look. spec: TerrainScenario::given().
MadeTerrain make_terrain(const TerrainScenario& spec, const std::vector<std::string>& folders,
                         MeshImporter& importer);

// Where it lies: fixed.
Placement place_terrain(const TerrainScenario& spec, int type);

}  // namespace rubble
