// The keys of pack.lua and of materials.lua.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scripting/packs/asset_pack.h"
#include "scripting/schema/schema.h"

namespace rubble {

enum class LengthUnit { m, cm, mm, in, ft };
double metres_per(LengthUnit unit);

// A link of an articulated asset as it is written.
struct LinkTable {
  std::string name, asset;  // of the link; of the asset that it is a copy of
  Vec3 position, rpy_deg;  // of the link in the whole; unit: m, degree
  double scale = 1;  // of the asset's lengths
  std::string on;  // name of the link it hangs on; empty: it is the first
  JointKind joint = JointKind::ball;  // to that link
  Vec3 joint_position, joint_axis{0, 0, 1};  // in the whole; unit: m; a direction
  double stiffness = 0, damping = 0;  // units as JointType
  double friction = 0;  // unit as JointType
  std::optional<double> yield, break_force, break_torque;  // units as JointType; none: never
  std::optional<NumberPair> limit_deg, travel;  // of a hinge (degree), of a slider (m); none: free
  bool collide = false;  // as JointType
};

// An asset as it is written: paths relative, density and friction only where given.
struct AssetTable {
  std::string name;                  // unique in the pack
  std::vector<std::string> mesh;     // files, finest level first
  std::vector<LinkTable> links;      // of an articulated asset, in place of a mesh
  LengthUnit units = LengthUnit::m;  // of the numbers in the files
  UpAxis up = UpAxis::z;             // of the files
  int word = 0;                      // of collision: 0: hull, 1: decompose
  std::string parts;                 // file of convex parts
  std::string material = "reinforced_concrete";  // name in materials.lua
  std::optional<double> density, friction;  // unit: kg/m3, 1; none: the material's
  std::string look;                         // of surfaces without one of their own
  TextMap surface_appearance;               // looks by the names of surfaces
  NumberPair scale{1, 1};                   // least and most
  SizeDistribution spread;                  // between these two
  double weight = 1;                        // in a mission without a mix; range: 0 and up
  std::vector<std::string> tags;            // that a mix may choose by
};

struct PackTable {
  std::string name;                // of the pack
  std::vector<AssetTable> assets;  // in the order of the file
};

struct MaterialTable {
  std::vector<Material> materials;  // in the order of the file
};

// The tables must outlive the schemas.
Schema make_pack_schema(PackTable& pack);
Schema make_link_schema(LinkTable& link);
Schema make_material_schema(MaterialTable& table);

// Keys that nothing reads, which are allowed and hardly meant. stated: whole paths, as in "assets[1].links[2].travel".
// Diagnostics without file and line, in that order.
std::vector<Diagnostic> find_idle_pack_keys(const PackTable& pack, const std::vector<std::string>& stated);

}  // namespace rubble
