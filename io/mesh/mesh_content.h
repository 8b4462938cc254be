// What a mesh file is made of, as a hash: the file itself, and the files beside it that it names.
#pragma once

#include <string>
#include <vector>

namespace rubble {

enum class MeshContent {
  geometry,  // buffers of glTF files
  all        // and images, and the material libraries of OBJ files
};

// Files that the mesh names and that are there, in order. Nothing of the mesh is checked: a file that is no mesh names none.
std::vector<std::string> list_files_of_mesh(const std::string& path, MeshContent content);

// Hexadecimal SHA-256 of the file; where it names others, of the hashes of all. Throws InputError: it cannot be read.
std::string sha256_of_mesh(const std::string& path, MeshContent content);

}  // namespace rubble
