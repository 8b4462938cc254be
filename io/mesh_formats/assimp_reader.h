// Every format without a reader of our own: COLLADA, FBX, OFF, X3D, 3DS, glTF 1.0 and what else assimp knows.
#pragma once

#include "io/import/imported_scene.h"

namespace rubble {

// COLLADA is read as it is written, without assimp's turn to Y up; ImportedScene::up says what the file states.
// Throws InputError.
ImportedScene read_by_assimp(const std::string& path);

}  // namespace rubble
