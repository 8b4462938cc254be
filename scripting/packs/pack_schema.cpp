#include "scripting/packs/pack_schema.h"

namespace rubble {

double metres_per(LengthUnit unit) {
  switch (unit) {
    case LengthUnit::m:
      return 1;
    case LengthUnit::cm:
      return 0.01;
    case LengthUnit::mm:
      return 0.001;
    case LengthUnit::in:
      return 0.0254;
    case LengthUnit::ft:
      return 0.3048;
  }
  return 1;
}

Schema make_pack_schema(PackTable& pack) {
  Schema k;
  auto& list = pack.assets;
  const auto item = [&k, &list](const char* name, auto member, const char* doc) -> Key& {
    return k.item(std::string("assets[].") + name, list, member, doc);
  };
  k.value("name", pack.name, "Name of the pack.").must();
  k.list("assets", list, "One entry per asset.").must();
  item("name", &AssetTable::name, "Name that missions use.").must();
  k.add("assets[].mesh",
        "Mesh file, or levels of detail from the finest to the coarsest, relative to pack.lua.",
        [&list](std::size_t i) { return Slot(StringOrList{&list[i].mesh}); });
  k.add("assets[].links",
        "Instead of a mesh: a tree of 2 to 256 other assets of the pack, connected by joints.",
        [&list](std::size_t i) { return Schema::table_list(list[i].links, make_link_schema); });
  k.add("assets[].units", "Length unit of the files.", [&list](std::size_t i) {
    return Schema::choice_slot(list[i].units, {"m", "cm", "mm", "in", "ft"});
  });
  k.add("assets[].up", "The axis that points up in the files.",
        [&list](std::size_t i) {
          return Schema::choice_slot(list[i].up, {"y", "z"});
        });
  k.add("assets[].collision",
        "`hull`: the convex hull of the mesh. `decompose`: convex parts of the mesh. A file: its objects are convex "
        "parts.",
        [&list](std::size_t i) {
          return Slot(WordOrFile{{"hull", "decompose"}, &list[i].word, "parts", &list[i].parts});
        });
  item("material", &AssetTable::material, "A name in materials.lua.");
  item("look", &AssetTable::look,
       "Look of surfaces without a known look. Not given: the colours of the file, otherwise the look of the "
       "material.");
  item("looks", &AssetTable::surface_appearance,
       "Look of each surface, by its name in the files.");
  item("density", &AssetTable::density, "Density, instead of that of the material.")
      .between(10, 25000)
      .unit("kg/m3");
  item("friction", &AssetTable::friction,
       "Coulomb coefficient against concrete, instead of that of the material.")
      .between(0, 2);
  item("scale", &AssetTable::scale, "Size, between {min, max}.").between(0.01, 100);
  k.add("assets[].spread", "Distribution of sizes within `scale`, as in pile.mix.", [&list](std::size_t i) {
    return Schema::choice_slot(list[i].spread.kind, {"uniform", "normal", "lognormal"});
  });
  k.add("assets[].typical", "Mean of the normal distribution, median of the lognormal one.",
        [&list](std::size_t i) { return Slot(&list[i].spread.typical); })
      .above(0, 100);
  k.add("assets[].deviation",
        "Standard deviation of the size (normal) or of its natural logarithm (lognormal).",
        [&list](std::size_t i) { return Slot(&list[i].spread.deviation); })
      .above(0, 10);
  item("weight", &AssetTable::weight, "Relative frequency of the asset in a mission without `pile.mix`.")
      .between(0, 1e9);
  item("tags", &AssetTable::tags, "Words that describe the asset.");
  return k;
}

Schema make_link_schema(LinkTable& l) {
  Schema k;
  k.value("asset", l.asset, "The piece: an asset of the pack with a mesh.").must();
  k.value("name", l.name, "Name of the link; not given: that of the asset.");
  k.value("position", l.position, "Position of the piece in the whole asset, as designed, at scale 1.")
      .between(-100, 100)
      .unit("m");
  k.value("rpy_deg", l.rpy_deg, "Roll, pitch and yaw in the whole asset.")
      .between(-360, 360)
      .unit("degree");
  k.value("scale", l.scale, "Size of the piece in the whole asset.").between(0.01, 100);
  k.value("on", l.on, "Name of the parent link, listed before this one; the first link has none.");
  k.choice("joint", l.joint, {std::begin(kJointNames), std::end(kJointNames)},
           "Joint to the parent: a hinge turns about the axis, a slider moves along it.");
  k.value("joint_position", l.joint_position, "Position of the joint in the whole asset.")
      .between(-100, 100)
      .unit("m");
  k.value("joint_axis", l.joint_axis, "Axis of a hinge or slider in the whole asset; any length above 0.")
      .between(-1000, 1000);
  k.value("stiffness", l.stiffness,
          "Stiffness of the spring towards the designed pose: torque per angle; for a slider force per length.")
      .between(0, 1e9)
      .unit("N m/rad, N/m");
  k.value("damping", l.damping, "Damping: torque per angular speed; for a slider force per speed.")
      .between(0, 1e9)
      .unit("N m s/rad, N s/m");
  k.value("friction", l.friction,
          "Dry friction: load up to which the joint holds, and with which it resists motion.")
      .between(0, 1e9)
      .unit("N m, N");
  k.value("yield", l.yield, "Load at which the spring deforms plastically; not given: never.")
      .above(0, 1e12)
      .unit("N m, N");
  k.value("break_force", l.break_force, "Force at which the joint breaks; not given: never.")
      .above(0, 1e12)
      .unit("N");
  k.value("break_torque", l.break_torque, "Torque about the joint at which it breaks; not given: never.")
      .above(0, 1e12)
      .unit("N m");
  k.value("limit_deg", l.limit_deg,
          "Range of a hinge: {least, most}, or one number for both directions. Ball: largest bending angle.")
      .between(-360, 360)
      .unit("degree");
  k.value("travel", l.travel, "Range of a slider: {least, most}, or one number for both directions.")
      .between(-100, 100)
      .unit("m");
  k.value("collide", l.collide, "The link and its parent collide with each other.");
  return k;
}

Schema make_material_schema(MaterialTable& table) {
  Schema k;
  auto& list = table.materials;
  k.list("materials", list, "One entry per material.").must();
  k.item("materials[].name", list, &Material::name, "Name that packs use.").must();
  k.item("materials[].density", list, &Material::density, "Density of the solid.")
      .between(10, 25000)
      .unit("kg/m3")
      .must();
  k.item("materials[].friction", list, &Material::friction, "Coulomb coefficient against concrete.")
      .between(0, 2)
      .must();
  k.item("materials[].look", list, &Material::look, "Look of surfaces without a known look.");
  k.item("materials[].source", list, &Material::source, "Source of the figures.").must();
  return k;
}

}  // namespace rubble
