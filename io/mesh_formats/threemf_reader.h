// 3MF, with the production extension: objects in several files of the package.
#pragma once

#include "io/import/imported_scene.h"

namespace rubble {

// The items of the build, in the numbers of the file (its unit is in a note where it is not what 3MF takes by default).
// Colours are those of base materials and colour groups, one for each triangle. Throws InputError for a package that
// requires an extension that is not known, by its name.
ImportedScene read_3mf(const std::string& path);

}  // namespace rubble
