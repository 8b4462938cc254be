// Asset packs and materials as plain records. Meshes are read elsewhere; here is what a pack says
// of them.
//
//   return pack {
//     name = "concrete",
//     assets = {
//       { name = "brick", mesh = "brick.obj", collision = "hull", material = "brick" },
//     },
//   }
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "kernel/base/mesh.h"
#include "kernel/model/pile.h"

namespace rubble {

struct Material {
  std::string name;     // as packs name it: "brick"
  double density = 0;   // unit: kg/m3; range: 10 to 25000
  double friction = 0;  // Coulomb, against concrete; range: 0 to 2
  std::string source;   // where the figures come from
  std::string look{};   // of surfaces whose own name is no look; one that the renderer knows
};

// A link of an articulated asset, and the joint by which it hangs on another: see JointType, whose
// members have the same names.
struct AssetLink {
  std::string asset;          // with a mesh, of the same pack
  Pose whole_from_link;       // as designed; unit: m
  double scale = 1;           // of the linked asset; range: above 0
  int on = -1;                // index of a link before it; -1: the first link
  JointType joint;            // parent and child are those of `on` and of this link
};

struct Asset {
  std::string name;                 // unique in its pack
  std::vector<AssetLink> links;     // of an articulated asset, which has no mesh; otherwise empty
  std::vector<std::string> meshes;  // whole paths, finest level of detail first; at least one
  double metres_per_unit = 1;       // of the mesh and the parts
  UpAxis up = UpAxis::z;            // of the files
  // A mesh each of whose objects is one convex part (whole path); empty: the hull of the finest mesh
  // is the only part or, with `decompose`, that mesh is cut into convex parts.
  std::string parts;
  bool decompose = false;  // cut into convex parts when it is loaded
  std::string material = "reinforced_concrete";  // gives density and friction where those are 0
  // How surfaces look that the files call otherwise than the renderer: by their names (an OBJ's
  // usemtl, a glTF's materials), and `look` for the rest; default: the file's own colours, else the material's.
  std::vector<std::pair<std::string, std::string>> surface_appearance;
  std::string look;                   // of surfaces without one of their own
  bool look_given = false;            // by the pack, so that it replaces the colours of the file; not the material's
  double density = 0;                 // the pack's, otherwise the material's; unit: kg/m3
  double friction = 0;                // likewise
  std::array<double, 2> scale{1, 1};  // from first to second
  SizeDistribution spread;                  // between them
  double weight = 1;                  // in a mission without a mix
  std::vector<std::string> tags;      // that a mix may choose by
  std::vector<std::string> idle_keys;  // sentences on keys that nothing reads
  int line = 0;  // of its table in pack.lua, for error messages
};

struct AssetPack {
  std::string name;           // of the pack
  std::string folder;         // with the pack.lua
  std::string script;         // path of its pack.lua
  std::vector<Asset> assets;  // in the order of the file
};

// Reads FOLDER/pack.lua. Throws InputError with every mistake, missing files and unknown materials
// among them.
AssetPack load_asset_pack(const std::string& folder, const std::vector<Material>& materials);

// Reads a file such as assets/materials.lua. Throws InputError with every mistake.
std::vector<Material> load_materials(const std::string& path);

}  // namespace rubble
