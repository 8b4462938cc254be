// A mesh file of any format: the one way from a file to an ImportedScene.
#pragma once

#include <optional>
#include <string>

#include "io/import/imported_scene.h"

namespace rubble {

// Reads a file by the reader of its format: OBJ, STL, PLY, glTF 2.0 and 3MF by readers of our own, everything else by
// assimp. Throws InputError.
ImportedScene read_scene(const std::string& path);

// Wavefront OBJ with its material libraries.
// Polygons of `f`; `o` and `g` begin an object. Lines, points, curves and surfaces of free form are left out with a note.
// Throws InputError with the line.
ImportedScene read_obj(const std::string& path);

// STL, text and binary.
// Each `solid` of a text is an object. Colours of facets in binary files are those of Materialise Magics (a header
// with COLOR=) and VisCAM. Throws InputError.
ImportedScene read_stl(const std::string& path);

// glTF 2.0, with skins, morph targets, quantization, Draco and instances.
// The default scene of a .gltf or .glb file, in the pose of its nodes: joints bend skins, weights of morph targets move
// corners. Animations are not read. Files of glTF 1.0 are read by assimp. Throws InputError with the element.
ImportedScene read_gltf(const std::string& path);

// 3MF, with the production extension: objects in several files of the package.
// The items of the build, in the numbers of the file (its unit is in a note where it is not what 3MF takes by default).
// Colours are those of base materials and colour groups, one for each triangle. Throws InputError for a package that
// requires an extension that is not known, by its name.
ImportedScene read_3mf(const std::string& path);

// Every format without a reader of our own: COLLADA, FBX, OFF, X3D, 3DS, glTF 1.0 and what else assimp knows.
// COLLADA is read as it is written, without assimp's turn to Y up; ImportedScene::up says what the file states.
// Throws InputError.
ImportedScene read_by_assimp(const std::string& path);

// COLLADA before assimp reads it.

// The document without the blanks that XML allows around the content of an element: assimp 5.2 takes those of <color>
// for a part of the number and refuses the file. Names of images that are empty are
// removed: they end assimp by an assertion. Comments and CDATA stay.
std::string repair_collada(const std::string& xml);

// The document without images, effects and materials: for one whose looks assimp refuses, so that the shape is left.
std::string without_looks(const std::string& collada);

// What <up_axis> of the document's own <asset> states; nothing where there is none. (The standard's default,
// Y_UP, is not taken for a statement.)
std::optional<FileUp> find_up_axis(const std::string& xml);

}  // namespace rubble
