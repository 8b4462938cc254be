// The materials, textures and images of a glTF file.
#pragma once

#include "io/mesh_formats/gltf_document.h"

namespace rubble {

// Appends all of them, in the order of the file.
void read_gltf_materials(const GltfDocument& document, ImportedScene& scene);

}  // namespace rubble
