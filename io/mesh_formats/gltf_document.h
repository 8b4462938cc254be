// A glTF 2.0 file (.gltf or .glb): its JSON, buffers and accessors.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/import/imported_scene.h"

namespace rubble {

// The numbers of an accessor as the standard means them: normalized integers are shares of their largest value.
struct GltfAccessor {
  std::size_t count = 0, components = 0;  // of each element
  std::vector<double> values;             // count * components
  Vec3 vector(std::size_t i) const { return {values[i * components], values[i * components + 1], values[i * components + 2]}; }
};

class GltfDocument {
 public:
  // Throws InputError: not glTF, a version other than 2, a required extension that is not known, a buffer that cannot
  // be had. Required extensions that change only looks become notes.
  GltfDocument(const std::string& path, ImportedScene& scene);

  const nlohmann::json& json() const { return json_; }
  const std::string& path() const { return path_; }
  // An object of a list at the top, as of "meshes"; throws InputError if there is none.
  const nlohmann::json& find(const char* list, std::int64_t index, const std::string& user) const;
  std::size_t count(const char* list) const;

  // user: the element that names the accessor, for errors. components: as expected; 0: any.
  GltfAccessor read_accessor(std::int64_t index, std::size_t components, const std::string& user) const;
  std::string_view read_view(std::int64_t index, const std::string& user) const;

  [[noreturn]] void refuse(const std::string& element, const std::string& message, const std::string& hint = "") const;

  // The version that the file states, "2.0"; empty: it is not JSON of glTF.
  static std::string version_of(const std::string& path);

 private:
  void parse(std::string_view text);
  void check_extensions(ImportedScene& scene) const;
  std::string_view buffer(std::size_t index, const std::string& user) const;
  void read_elements(std::string_view bytes, std::size_t stride, int type, bool normalized, GltfAccessor& out) const;
  void apply_sparse(const nlohmann::json& accessor, int type, bool normalized, const std::string& element,
                    GltfAccessor& out) const;

  std::string path_, bytes_;
  std::string_view chunk_;  // the binary chunk of a .glb
  nlohmann::json json_;
  mutable std::vector<std::optional<std::string>> buffers_;  // read when they are first needed
};

// Members of JSON with their defaults; a value of another type throws nlohmann::json::exception.
std::int64_t gltf_index(const nlohmann::json& object, const char* name);  // -1: none
double gltf_number(const nlohmann::json& object, const char* name, double otherwise);
std::string gltf_text(const nlohmann::json& object, const char* name);
const nlohmann::json* gltf_member(const nlohmann::json& object, const char* name);  // null: none

// The materials, textures and images of a glTF file.
// Appends all of them, in the order of the file.
void read_gltf_materials(const GltfDocument& document, ImportedScene& scene);

}  // namespace rubble
