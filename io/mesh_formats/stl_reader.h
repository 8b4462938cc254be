// STL, text and binary.
#pragma once

#include "io/import/imported_scene.h"

namespace rubble {

// Each `solid` of a text is an object. Colours of facets in binary files are those of Materialise Magics (a header
// with COLOR=) and VisCAM. Throws InputError.
ImportedScene read_stl(const std::string& path);

}  // namespace rubble
