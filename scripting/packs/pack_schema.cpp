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
  k.value("name", pack.name, "Of the pack.").must();
  k.list("assets", list, "One entry an asset.").must();
  item("name", &AssetTable::name, "How missions call it.").must();
  k.add("assets[].mesh",
        "File, or files from the finest to the coarsest level of detail, beside pack.lua.",
        [&list](std::size_t i) { return Slot(StringOrList{&list[i].mesh}); });
  k.add("assets[].links",
        "Instead of a mesh: a tree of other assets of the pack, held together by joints; 2 to 256.",
        [&list](std::size_t i) { return Schema::table_list(list[i].links, make_link_schema); });
  k.add("assets[].units", "Of lengths in the files.", [&list](std::size_t i) {
    return Schema::choice_slot(list[i].units, {"m", "cm", "mm", "in", "ft"});
  });
  k.add("assets[].up", "The axis that points up in the files; the product's is Z.",
        [&list](std::size_t i) {
          return Schema::choice_slot(list[i].up, {"y", "z"});
        });
  k.add("assets[].collision",
        "The convex hull of the mesh; the mesh cut into convex parts; or a file each of whose objects "
        "is a convex part.",
        [&list](std::size_t i) {
          return Slot(WordOrFile{{"hull", "decompose"}, &list[i].word, "parts", &list[i].parts});
        });
  item("material", &AssetTable::material, "A name in materials.lua.");
  item("look", &AssetTable::look, "Of surfaces without a known look; none: the material's.");
  item("looks", &AssetTable::surface_appearance,
       "The looks of surfaces, by their names in the files.");
  item("density", &AssetTable::density, "Instead of the material's.")
      .between(10, 25000)
      .unit("kg/m3");
  item("friction", &AssetTable::friction, "Instead of the material's, against concrete.")
      .between(0, 2);
  item("scale", &AssetTable::scale, "Size, between {min, max}.").between(0.01, 100);
  k.add("assets[].spread", "As in pile.mix: how sizes lie in `scale`.", [&list](std::size_t i) {
    return Schema::choice_slot(list[i].spread.kind, {"uniform", "normal", "lognormal"});
  });
  k.add("assets[].typical", "Mean of the normal, median of the lognormal spread.",
        [&list](std::size_t i) { return Slot(&list[i].spread.typical); })
      .above(0, 100);
  k.add("assets[].deviation",
        "Standard deviation of the size (normal) or of its natural logarithm (lognormal).",
        [&list](std::size_t i) { return Slot(&list[i].spread.deviation); })
      .above(0, 10);
  item("weight", &AssetTable::weight, "How often, in a mission without a mix.").between(0, 1e9);
  item("tags", &AssetTable::tags, "Words to find it by.");
  return k;
}

Schema make_link_schema(LinkTable& l) {
  Schema k;
  k.value("asset", l.asset, "The piece: an asset of the pack with a mesh.").must();
  k.value("name", l.name, "By which others hang on it; not given: the asset's name.");
  k.value("position", l.position, "Of the piece's origin in the whole, as designed, at scale 1.")
      .between(-100, 100)
      .unit("m");
  k.value("rpy_deg", l.rpy_deg, "Roll, pitch and yaw in the whole.")
      .between(-360, 360)
      .unit("degree");
  k.value("scale", l.scale, "Of the piece in the whole.").between(0.01, 100);
  k.value("on", l.on, "Name of the link that it hangs on, listed before it; the first has none.");
  k.choice("joint", l.joint, {std::begin(kJointNames), std::end(kJointNames)},
           "What holds it: a hinge turns about the axis, a slider moves along it.");
  k.value("joint_position", l.joint_position, "Of the joint in the whole.")
      .between(-100, 100)
      .unit("m");
  k.value("joint_axis", l.joint_axis, "Of a hinge or slider, in the whole; any length above 0.")
      .between(-1000, 1000);
  k.value("stiffness", l.stiffness,
          "Of the spring towards the designed pose; torque per angle, a slider's force per length.")
      .between(0, 1e9)
      .unit("N m/rad, N/m");
  k.value("damping", l.damping, "Torque per rate, a slider's force per speed.")
      .between(0, 1e9)
      .unit("N m s/rad, N s/m");
  k.value("friction", l.friction,
          "Dry friction in the joint: it holds up to this load and resists with it when it moves.")
      .between(0, 1e9)
      .unit("N m, N");
  k.value("yield", l.yield, "Load at which the spring bends for good; not given: never.")
      .above(0, 1e12)
      .unit("N m, N");
  k.value("break_force", l.break_force, "Force at which the joint lets go; not given: never.")
      .above(0, 1e12)
      .unit("N");
  k.value("break_torque", l.break_torque, "Moment about the joint at which it lets go.")
      .above(0, 1e12)
      .unit("N m");
  k.value("limit_deg", l.limit_deg,
          "How far a hinge turns, {least, most}, or that far to either side; a ball's largest bend.")
      .between(-360, 360)
      .unit("degree");
  k.value("travel", l.travel, "How far a slider moves, {least, most}, or that far either way.")
      .between(-100, 100)
      .unit("m");
  k.value("collide", l.collide, "Whether it and the link it hangs on touch each other.");
  return k;
}

Schema make_material_schema(MaterialTable& table) {
  Schema k;
  auto& list = table.materials;
  k.list("materials", list, "One entry a material.").must();
  k.item("materials[].name", list, &Material::name, "How packs call it.").must();
  k.item("materials[].density", list, &Material::density, "Of the solid.")
      .between(10, 25000)
      .unit("kg/m3")
      .must();
  k.item("materials[].friction", list, &Material::friction, "Coulomb, against concrete.")
      .between(0, 2)
      .must();
  k.item("materials[].look", list, &Material::look, "Of surfaces that name no known look.");
  k.item("materials[].source", list, &Material::source, "Where the figures come from.").must();
  return k;
}

}  // namespace rubble
