// A mesh file of any format: the one way from a file to an ImportedScene.
#pragma once

#include <string>

#include "io/import/imported_scene.h"

namespace rubble {

// Reads a file by the reader of its format: OBJ, STL, PLY, glTF 2.0 and 3MF by readers of our own, everything else by
// assimp. Throws InputError.
ImportedScene read_scene(const std::string& path);

}  // namespace rubble
