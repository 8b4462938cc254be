#include "app/assets/placed_box.h"

#include <algorithm>

#include "assets/generator/box.h"
#include "kernel/base/hash.h"
#include "kernel/base/number_text.h"
#include "kernel/base/random.h"
#include "scripting/values/value.h"

namespace rubble {
namespace {

generator::BoxRecipe box_recipe(const PlacedItem& item, const Material& material) {
  static const char* const kFaces[] = {"+x", "-x", "+y", "-y", "+z", "-z"};
  generator::BoxRecipe recipe;
  recipe.size = *item.box;
  recipe.surface = generator::surface_of_look(material.look);
  for (std::size_t i = 0; i < 6; ++i)
    recipe.broken[i] = std::count(item.broken.begin(), item.broken.end(), kFaces[i]) > 0;
  recipe.seed = std::uint32_t(RandomStream(0, placed_box_name(item)).next() >> 40);
  return recipe;
}

PieceType box_type(const PlacedItem& item, const Material& material) {
  PieceType type;
  type.name = placed_box_name(item);
  type.density = material.density;
  type.friction = material.friction;
  type.parts.emplace_back();
  const Vec3 half = *item.box * 0.5;
  for (int i = 0; i < 8; ++i)
    type.parts[0].points.push_back(
        {i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y, i & 4 ? half.z : -half.z});
  return type;
}

std::string hash_box(const TriangleMesh& mesh, const Material& material) {
  Sha256 hash;
  for (const double number : {material.density, material.friction})
    hash.add(&number, sizeof number);
  hash.add(mesh.positions.data(), mesh.positions.size() * sizeof mesh.positions[0]);
  hash.add(mesh.triangles.data(), mesh.triangles.size() * sizeof mesh.triangles[0]);
  return hash.hex();
}

}  // namespace

std::string placed_box_name(const PlacedItem& item) {
  std::string name = "box";
  for (int i = 0; i < 3; ++i) name += (i ? "x" : " ") + exact_text((*item.box)[i]);
  name += " " + item.material;
  for (const std::string& face : item.broken) name += " " + face;
  return name;
}

MadeBox make_placed_box(const PlacedItem& item, const std::vector<Material>& materials) {
  const auto material = std::find_if(materials.begin(), materials.end(), [&](const Material& m) {
    return m.name == item.material;
  });
  auto mesh = std::make_shared<SceneMesh>();
  mesh->levels = generator::make_box(box_recipe(item, *material));
  return {box_type(item, *material), mesh, hash_box(mesh->levels.front(), *material)};
}

}  // namespace rubble
