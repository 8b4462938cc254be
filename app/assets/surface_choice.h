// Which surfaces of a mesh keep the colours of its file, and which get a look.
#pragma once

#include <functional>
#include <string>

#include "kernel/base/mesh.h"

namespace rubble {

// The look of a surface of this name; empty: it keeps its paint. painted: whether it has one.
using ChooseLook = std::function<std::string(const std::string& surface, bool painted)>;

// Surfaces that keep their paint get a name of their own: "wood_1a2b3c4d".
void choose_surfaces(TriangleMesh& mesh, const ChooseLook& choose);

bool has_paint(const TriangleMesh& mesh);

}  // namespace rubble
