#include "app/assets/surface_choice.h"

#include <algorithm>

namespace rubble {

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
