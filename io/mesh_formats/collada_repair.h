// COLLADA before assimp reads it.
#pragma once

#include <optional>
#include <string>

#include "io/import/imported_scene.h"

namespace rubble {

// The document without the blanks that XML allows around the content of an element: assimp 5.2 takes those of <color>
// for a part of the number and refuses the file. Names of images that are empty are
// removed: they end assimp by an assertion. Comments and CDATA stay.
std::string repair_collada(const std::string& xml);

// The document without images, effects and materials: for one whose looks assimp refuses, so that the shape is left.
std::string without_looks(const std::string& collada);

// What <up_axis> states; nothing where there is none. (The standard's default, Y_UP, is not taken for a statement.)
std::optional<FileUp> find_up_axis(const std::string& xml);

}  // namespace rubble
