#include "app/assets/asset_materials.h"

#include <algorithm>

#include "render/materials/surface_appearance.h"

namespace rubble {
namespace {

bool is_known(const std::string& look) {
  const std::vector<std::string> known = known_surface_appearances();
  return std::find(known.begin(), known.end(), look) != known.end();
}

// Looks of one material begin alike: "concrete_cast", "concrete_fracture".
std::string stem(const std::string& name) { return name.substr(0, name.find('_')); }

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

bool is_break(const std::string& look) { return ends_with(look, "_fracture") || ends_with(look, "_core"); }

std::string break_of(const Material& material) {
  for (const std::string& begin : {stem(material.look), stem(material.name)})
    for (const char* end : {"_fracture", "_core"})
      if (is_known(begin + end)) return begin + end;
  return material.look;
}

}  // namespace

std::string variant_name(const std::string& asset, const std::string& material) {
  return asset + " of " + material;
}

bool is_variant(const Asset& asset) { return ends_with(asset.name, variant_name("", asset.material)); }

Asset make_variant(const Asset& asset, const Material& material) {
  Asset variant = asset;
  variant.name = variant_name(asset.name, material.name);
  variant.material = material.name;
  variant.density = material.density;
  variant.friction = material.friction;
  variant.look = material.look;
  variant.look_given = true;
  const std::string own[] = {stem(asset.look), stem(asset.material)};
  const auto is_own = [&](const std::string& look) {
    return look == asset.look || stem(look) == own[0] || stem(look) == own[1];
  };
  const auto changed = [&](const std::string& look) {
    return is_break(look) ? break_of(material) : material.look;
  };
  for (auto& [surface, look] : variant.surface_appearance)
    if (is_own(look)) look = changed(look);
  for (const std::string& look : known_surface_appearances())
    if (is_own(look)) variant.surface_appearance.emplace_back(look, changed(look));
  return variant;
}

std::optional<Asset> find_variant(const Asset& asset, const std::string& name,
                                  const std::vector<Material>& materials) {
  if (asset.name == name) return asset;
  if (!asset.links.empty()) return std::nullopt;
  for (const Material& material : materials)
    if (variant_name(asset.name, material.name) == name) return make_variant(asset, material);
  return std::nullopt;
}

bool has_paint(const TriangleMesh& mesh) {
  return std::any_of(mesh.paints.begin(), mesh.paints.end(), [](const auto& paint) { return paint != nullptr; });
}

void choose_surfaces(TriangleMesh& mesh, const ChooseLook& choose) {
  constexpr std::size_t kDigits = 8;  // of the hash
  for (std::size_t s = 0; s < mesh.surface_names.size(); ++s) {
    std::string& name = mesh.surface_names[s];
    const SurfacePaint* paint = mesh.paint_of(s);
    const std::string look = choose(name, paint);
    if (look.empty() && paint)
      name = (name.empty() ? "paint" : name) + "_" + paint->sha256.substr(0, kDigits);
    else
      name = look;
    if (!look.empty() && paint) mesh.paints[s] = nullptr;
  }
  if (!has_paint(mesh)) mesh.paints.clear(), mesh.paint_corners.clear();
}

}  // namespace rubble
