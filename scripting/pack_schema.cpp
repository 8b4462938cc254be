#include "scripting/pack_schema.h"

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
        [&list](std::size_t i) { return Slot(StringOrList{&list[i].mesh}); })
      .must();
  k.add("assets[].units", "Of lengths in the files.", [&list](std::size_t i) {
    return Schema::choice_slot(list[i].units, {"m", "cm", "mm", "in", "ft"});
  });
  k.add("assets[].up", "The axis that points up in the files; the product's is Z.",
        [&list](std::size_t i) {
          return Schema::choice_slot(list[i].up, {"y", "z"});
        });
  k.add("assets[].collision",
        "The convex hull of the mesh, or a file whose connected components are convex parts.",
        [&list](std::size_t i) {
          return Slot(WordOrFile{"hull", "parts", &list[i].parts});
        });
  item("material", &AssetTable::material, "A name in materials.lua.");
  item("density", &AssetTable::density, "Instead of the material's.")
      .between(10, 25000)
      .unit("kg/m3");
  item("friction", &AssetTable::friction, "Instead of the material's, against concrete.")
      .between(0, 2);
  item("scale", &AssetTable::scale, "Size, uniform in {min, max}.").between(0.01, 100);
  item("weight", &AssetTable::weight, "How often, in a mission without a mix.").between(0, 1e9);
  item("tags", &AssetTable::tags, "Words to find it by.");
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
  k.item("materials[].source", list, &Material::source, "Where the figures come from.").must();
  return k;
}

}  // namespace rubble
