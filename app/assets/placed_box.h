// The boxes that a mission places, made to measure: what the kernel settles, what is drawn.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "kernel/model/pile.h"
#include "render/scene/scene.h"
#include "scripting/packs/asset_pack.h"
#include "scripting/scenario/scenario.h"

namespace rubble {

// The pack that a provenance names for them.
inline constexpr const char* kMadeToMeasure = "made to measure";

struct MadeBox {
  PieceType type;  // one convex part, exact; its mass is that of the exact box
  std::shared_ptr<const SceneMesh> mesh;  // worn edges, nowhere outside the box
  std::string sha256;                     // over its mesh and the material's figures
};

// Boxes of one make are one type, whose name says all of it: "box 4x0.2x6 brick +x".
std::string placed_box_name(const PlacedItem& item);

// item.box is set, and item.material is one of the materials.
MadeBox make_placed_box(const PlacedItem& item, const std::vector<Material>& materials);

}  // namespace rubble
