// Material libraries of OBJ files (MTL).
#pragma once

#include <map>
#include <set>
#include <string>

#include "io/import/imported_scene.h"

namespace rubble {

// Appends the materials of libraries to a scene. A mistake in a library never costs the mesh: it becomes a note.
class MtlReader {
 public:
  // path: of the OBJ file, beside which the libraries lie.
  MtlReader(const std::string& path, ImportedScene& scene) : path_(path), scene_(scene) {}

  // names: the rest of an `mtllib` line: one name, maybe with blanks, or several.
  void read_libraries(std::string_view names);
  // Of `usemtl`.
  int find(const std::string& name);
  // After the last line. A material that no library has is that of the same name without quotes and comment; otherwise it
  // is grey, or white below colours of vertices, and a note names it unless its library is lost.
  void define_missing(bool vertex_colours);

 private:
  bool read_file_of(const std::string& name);
  void read(const std::string& name, const std::string& text);
  void read_line(std::string_view keyword, std::string_view rest, const std::string& place);
  bool read_numbers(ImportedMaterial& material, std::string_view keyword, std::string_view rest,
                    const std::string& place);
  bool read_image(ImportedMaterial& material, std::string_view keyword, std::string_view rest,
                  const std::string& place);
  std::string take_options(std::string_view rest, TexturePlace& where, const std::string& place);
  int image_of(const std::string& name);

  std::string path_;
  ImportedScene& scene_;
  std::map<std::string, int> numbers_;  // of materials, by name
  std::set<int> defined_;               // materials that a library has
  std::string library_folder_;          // of the library that is read, from the folder of the OBJ file; "sub/"
  bool asked_ = false;                  // the file names a library: without one, names of materials are names alone
  bool lost_ = false;                   // a library was not found, or cannot be read
  int current_ = -1;
};

}  // namespace rubble
