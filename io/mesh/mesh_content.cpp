#include "io/mesh/mesh_content.h"

#include <algorithm>
#include <filesystem>
#include <string_view>

#include "io/base/text_scan.h"
#include "io/import/imported_scene.h"
#include "io/import/uri.h"
#include "io/mesh_formats/gltf_document.h"
#include "kernel/base/error.h"
#include "kernel/base/hash.h"
#include "kernel/base/read_file.h"
#include "kernel/base/tables/text_table.h"

namespace rubble {
namespace {

class FilesBeside {
 public:
  explicit FilesBeside(const std::string& path) { also_beside(path); }

  // Names are looked for beside that file, too, if they are not found before.
  void also_beside(const std::string& path) { folders_.push_back(std::filesystem::path(path).parent_path().string()); }

  bool add(std::string_view name) {
    for (const std::string& folder : folders_) {
      const auto found = find_beside(folder, std::string(name), "textures");
      if (!found) continue;
      if (std::find(files_.begin(), files_.end(), *found) == files_.end()) files_.push_back(*found);
      return true;
    }
    return false;
  }
  // A name that may have blanks, or several names, or one after options.
  void add_words(std::string_view names) {
    const std::string_view whole = trimmed(names);
    if (add(whole)) return;
    for (const std::string_view word : split_words(whole, 0).words) add(word);
  }
  std::vector<std::string> take() { return std::move(files_); }

 private:
  std::vector<std::string> folders_;
  std::vector<std::string> files_;
};

// What is no glTF names none: the reader says why.
void add_gltf(const std::string& path, MeshContent content, FilesBeside& files) try {
  ImportedScene scene;
  const GltfDocument document(path, scene);
  for (const char* list : {"buffers", "images"}) {
    if (content == MeshContent::geometry && list == std::string_view("images")) continue;
    for (std::size_t i = 0; i < document.count(list); ++i) {
      const std::string uri = gltf_text(document.find(list, std::int64_t(i), "the file"), "uri");
      if (!uri.empty() && uri.compare(0, 5, "data:") != 0) files.add(uri);
    }
  }
} catch (const InputError&) {
}

// each(keyword, rest) of every line.
template <typename Each>
void for_each_line(std::string_view text, const Each& each) {
  for (const std::string_view whole : split_lines(text)) {
    const std::string_view line = trimmed(whole);
    const std::size_t blank = line.find_first_of(" \t");
    if (blank != std::string_view::npos) each(line.substr(0, blank), line.substr(blank));
  }
}

void add_obj(const std::string& text, FilesBeside& files) {
  for_each_line(text, [&](std::string_view keyword, std::string_view rest) {
    if (keyword == "mtllib") files.add_words(rest);
  });
}

void add_mtl(const std::string& text, FilesBeside& files) {
  for_each_line(text, [&](std::string_view keyword, std::string_view rest) {
    for (const char* const image : {"map_", "bump", "disp", "decal", "refl", "norm"})
      if (keyword.substr(0, std::string_view(image).size()) == image) return files.add_words(rest);
  });
}

// <init_from>wood.png</init_from>, of COLLADA 1.5 with <ref> around the name.
void add_dae(const std::string& text, FilesBeside& files) {
  constexpr std::string_view kScheme = "file://";
  for (XmlScanner tags(text); tags.next();) {
    if (!tags.closes() || (tags.name() != "init_from" && tags.name() != "ref")) continue;
    const std::string content = tags.text();
    const std::string_view name = trimmed(content);
    files.add(name.substr(name.substr(0, kScheme.size()) == kScheme ? kScheme.size() : 0));
  }
}

}  // namespace

std::vector<std::string> list_files_of_mesh(const std::string& path, MeshContent content) {
  FilesBeside files(path);
  const std::string extension = lower_case(std::filesystem::path(path).extension().string());
  if (extension == ".gltf" || extension == ".glb") add_gltf(path, content, files);
  if (content == MeshContent::geometry) return files.take();
  if (extension == ".dae") add_dae(read_file(path), files);
  if (extension == ".obj") {
    add_obj(read_file(path), files);
    std::vector<std::string> all = files.take();
    for (std::size_t i = 0, libraries = all.size(); i < libraries; ++i) {
      FilesBeside images(path);
      images.also_beside(all[i]);
      add_mtl(read_file(all[i]), images);
      for (std::string& image : images.take()) all.push_back(std::move(image));
    }
    return all;
  }
  return files.take();
}

std::string sha256_of_mesh(const std::string& path, MeshContent content) {
  const std::vector<std::string> beside = list_files_of_mesh(path, content);
  if (beside.empty()) return sha256_of_file(path);
  std::string sums = sha256_of_file(path);
  for (const std::string& file : beside) sums += sha256_of_file(file);
  return sha256(sums);
}

}  // namespace rubble
