// Which surfaces of a mesh keep the colours of its file, and which get a look.
#pragma once

#include <functional>
#include <string>

#include "kernel/base/mesh.h"

namespace rubble {

// The look of a surface of this name; empty: it keeps its paint. paint: null: it has none.
using ChooseLook = std::function<std::string(const std::string& surface, const SurfacePaint* paint)>;

// Surfaces that keep their paint get a name of their own: "wood_1a2b3c4d".
void choose_surfaces(TriangleMesh& mesh, const ChooseLook& choose);

bool has_paint(const TriangleMesh& mesh);

// Whether a surface whose name is a look keeps its paint all the same: an image is meant, while programs write some
// plain colour for every material.
inline bool outdoes_name(const SurfacePaint* paint) { return paint && paint->albedo.side > 0; }

}  // namespace rubble
