// Articulated assets as `rubble assets` sees them: whole, as designed.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "app/assets/asset_library.h"
#include "scripting/packs/asset_pack.h"

namespace rubble {

struct TreeReport {
  std::string name;                              // of the asset
  std::size_t links = 0, joints = 0, parts = 0;  // counts; parts: convex, of all links
  double mass = 0;                               // of all links; unit: kg
  Vec3 size;                                     // of the box around the whole; unit: m
  std::vector<std::string> errors, warnings;     // a sentence each, for people
};

// Links that are not joined must be apart as designed (an error), and a joint should be where both of
// its links are (a warning). library: with the types of the links.
TreeReport check_tree(const Asset& asset, const AssetLibrary& library);

// The finest meshes of all links as one, in the frame of the whole.
TriangleMesh merge_links(const AssemblyType& assembly, const AssetLibrary& library);
// Of all links; unit: kg
double calc_mass(const AssemblyType& assembly, const AssetLibrary& library);

}  // namespace rubble
