// Wavefront OBJ with its material libraries.
#pragma once

#include "io/import/imported_scene.h"

namespace rubble {

// Polygons of `f`; `o` and `g` begin an object. Lines, points, curves and surfaces of free form are left out with a note.
// Throws InputError with the line.
ImportedScene read_obj(const std::string& path);

}  // namespace rubble
