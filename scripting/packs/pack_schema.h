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
  std::string name, asset;
  Vec3 position, rpy_deg;
  double scale = 1;
  std::string on;
  JointKind joint = JointKind::ball;
  Vec3 joint_position, joint_axis{0, 0, 1};
  double stiffness = 0, damping = 0;
  double friction = 0;
  std::optional<double> yield, break_force, break_torque;
  std::optional<NumberPair> limit_deg, travel;
  bool collide = false;
};

// An asset as it is written: paths relative, density and friction only where given.
struct AssetTable {
  std::string name;
  std::vector<std::string> mesh;
  std::vector<LinkTable> links;
  LengthUnit units = LengthUnit::m;
  UpAxis up = UpAxis::z;
  int word = 0;  // of collision: 0: hull, 1: decompose
  std::string parts;
  std::string material = "reinforced_concrete";
  std::optional<double> density, friction;
  std::string look;
  TextMap surface_appearance;
  NumberPair scale{1, 1};
  SizeSpread spread;
  double weight = 1;
  std::vector<std::string> tags;
};

struct PackTable {
  std::string name;
  std::vector<AssetTable> assets;
};

struct MaterialTable {
  std::vector<Material> materials;
};

// The tables must outlive the schemas.
Schema make_pack_schema(PackTable& pack);
Schema make_link_schema(LinkTable& link);
Schema make_material_schema(MaterialTable& table);

}  // namespace rubble
