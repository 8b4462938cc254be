#include "io/mesh_formats/gltf_document.h"

#include <algorithm>
#include <cstring>
#include <filesystem>

#include "io/import/uri.h"
#include "kernel/base/error.h"
#include "kernel/base/read_file.h"
#include "kernel/base/system/file_sandbox.h"
#include "kernel/base/text.h"

namespace rubble {
namespace {

using Json = nlohmann::json;

constexpr std::uint32_t kMagic = 0x46546c67, kJsonChunk = 0x4e4f534a, kBinaryChunk = 0x004e4942;
constexpr std::size_t kMostElements = std::size_t(1) << 22;  // of an accessor without bytes behind it

// Extensions whose effect is applied, or that say nothing of shapes and looks.
constexpr const char* kKnown[] = {"KHR_mesh_quantization",     "KHR_texture_transform", "KHR_draco_mesh_compression",
                                  "EXT_mesh_gpu_instancing",   "KHR_materials_unlit",   "KHR_materials_pbrSpecularGlossiness",
                                  "KHR_lights_punctual",       "KHR_xmp",               "KHR_xmp_json_ld"};

bool is_known(const std::string& extension) {
  return std::find(std::begin(kKnown), std::end(kKnown), extension) != std::end(kKnown);
}

// By the naming of Khronos: materials, textures and images, whose lack costs only looks.
bool is_of_looks(const std::string& extension) {
  return extension.find("_materials_") != std::string::npos || extension.find("_texture_") != std::string::npos ||
         extension.find("_image_") != std::string::npos || extension.find("_technique") != std::string::npos;
}

std::uint32_t read_word(std::string_view bytes, std::size_t at) {
  std::uint32_t word = 0;
  if (at + 4 <= bytes.size()) std::memcpy(&word, bytes.data() + at, 4);
  return word;
}

// Bytes of a component; 0: no such type.
std::size_t size_of_type(std::int64_t type) {
  switch (type) {
    case 5120: case 5121: return 1;
    case 5122: case 5123: return 2;
    case 5125: case 5126: return 4;
    default: return 0;
  }
}

template <typename T>
double read_as(const char* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return double(value);
}

double read_component(const char* at, int type, bool normalized) {
  switch (type) {
    case 5120: return normalized ? std::max(read_as<std::int8_t>(at) / 127, -1.0) : read_as<std::int8_t>(at);
    case 5121: return read_as<std::uint8_t>(at) / (normalized ? 255 : 1);
    case 5122: return normalized ? std::max(read_as<std::int16_t>(at) / 32767, -1.0) : read_as<std::int16_t>(at);
    case 5123: return read_as<std::uint16_t>(at) / (normalized ? 65535 : 1);
    case 5125: return read_as<std::uint32_t>(at) / (normalized ? 4294967295.0 : 1);
    default: return read_as<float>(at);
  }
}

std::size_t components_of(const std::string& type) {
  if (type == "SCALAR") return 1;
  if (type == "VEC2") return 2;
  if (type == "VEC3") return 3;
  if (type == "VEC4" || type == "MAT2") return 4;
  if (type == "MAT3") return 9;
  return type == "MAT4" ? 16 : 0;
}

std::string list_place(const char* list, std::int64_t index) { return std::string(list) + "[" + std::to_string(index) + "]"; }

}  // namespace

std::int64_t gltf_index(const Json& object, const char* name) {
  const Json* member = gltf_member(object, name);
  return member ? member->get<std::int64_t>() : -1;
}

double gltf_number(const Json& object, const char* name, double otherwise) {
  const Json* member = gltf_member(object, name);
  return member ? member->get<double>() : otherwise;
}

std::string gltf_text(const Json& object, const char* name) {
  const Json* member = gltf_member(object, name);
  return member ? member->get<std::string>() : std::string();
}

const Json* gltf_member(const Json& object, const char* name) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(name);
  return found == object.end() ? nullptr : &*found;
}

GltfDocument::GltfDocument(const std::string& path, ImportedScene& scene) : path_(path), bytes_(read_file(path)) {
  std::string_view text = bytes_;
  if (read_word(bytes_, 0) == kMagic) {
    const std::size_t length = read_word(bytes_, 12);
    if (read_word(bytes_, 16) != kJsonChunk || length > bytes_.size() - 20) refuse("", "its first chunk is not JSON, or it is cut short");
    text = text.substr(20, length);
    // Chunks begin at multiples of four bytes; some writers forget to fill up.
    for (const std::size_t next : {20 + length, 20 + (length + 3) / 4 * 4})
      if (chunk_.empty() && read_word(bytes_, next + 4) == kBinaryChunk && next + 8 <= bytes_.size())
        chunk_ = std::string_view(bytes_).substr(next + 8, read_word(bytes_, next));
  }
  parse(text);
  check_extensions(scene);
  buffers_.resize(count("buffers"));
}

void GltfDocument::parse(std::string_view text) {
  if (calc_json_depth(text) > kDeepestJson) refuse("", "its JSON is nested too deep");
  try {
    json_ = Json::parse(text);
  } catch (const Json::exception& error) {
    refuse("", std::string("is no JSON: ") + error.what());
  }
  const std::string version = json_.is_object() ? gltf_text(json_.value("asset", Json::object()), "version") : "";
  if (version.empty() || version[0] != '2')
    refuse("asset.version", "expected glTF 2.0, found " + (version.empty() ? std::string("no version") : "\"" + version + "\""));
}

std::string GltfDocument::version_of(const std::string& path) {
  const std::string bytes = read_file(path);
  if (read_word(bytes, 0) == kMagic) return std::to_string(read_word(bytes, 4));
  if (calc_json_depth(bytes) > kDeepestJson) return "";
  const Json json = Json::parse(bytes, nullptr, false);
  try {
    const Json asset = json.is_object() ? json.value("asset", Json::object()) : Json::object();
    const Json* version = gltf_member(asset, "version");
    if (!version) return "";
    return version->is_number() ? std::to_string(version->get<double>()) : version->get<std::string>();  // glTF 1.0 has both
  } catch (const Json::exception&) {
    return "";
  }
}

void GltfDocument::refuse(const std::string& element, const std::string& message, const std::string& hint) const {
  refuse_mesh(path_, (element.empty() ? "" : element + ": ") + message, hint);
}

void GltfDocument::check_extensions(ImportedScene& scene) const {
  const Json* required = gltf_member(json_, "extensionsRequired");
  if (!required) return;
  for (const Json& entry : *required) {
    const std::string name = entry.get<std::string>();
    if (is_known(name)) continue;
    if (is_of_looks(name))
      scene.note("the file requires the extension " + name + ", which is not known: what it says of looks is left out");
    else
      refuse("extensionsRequired", "requires the glTF extension " + name + ", which is not known",
             name == "EXT_meshopt_compression" ? "export without compression (gltfpack without -c), or with Draco"
                                               : "export without this extension");
  }
}

std::size_t GltfDocument::count(const char* list) const {
  const Json* all = gltf_member(json_, list);
  return all && all->is_array() ? all->size() : 0;
}

const Json& GltfDocument::find(const char* list, std::int64_t index, const std::string& user) const {
  if (index < 0 || std::size_t(index) >= count(list))
    refuse(user, "names " + list_place(list, index) + ", and there are " + std::to_string(count(list)));
  return json_[list][std::size_t(index)];
}

std::string_view GltfDocument::buffer(std::size_t index, const std::string& user) const {
  const Json& buffer = find("buffers", std::int64_t(index), user);
  const std::string element = list_place("buffers", std::int64_t(index));
  const std::string uri = gltf_text(buffer, "uri");
  if (uri.empty()) {
    if (gltf_member(buffer, "extensions") && buffer["extensions"].contains("EXT_meshopt_compression"))
      refuse(element, "has only data by the extension EXT_meshopt_compression, which is not known",
             "export without compression (gltfpack without -c), or with Draco");
    if (index == 0 && !chunk_.empty()) return chunk_;
    refuse(element, "has no uri, and the file has no binary chunk");
  }
  std::optional<std::string>& bytes = buffers_[index];
  if (bytes) return *bytes;
  if (uri.compare(0, 5, "data:") == 0) {
    bytes = decode_data_uri(uri);
    if (!bytes) refuse(element, "its data URI is damaged");
    return *bytes;
  }
  const auto found = find_beside(std::filesystem::path(path_).parent_path().string(), uri);
  if (!found) refuse(element, "the file " + printable(uri) + " was not found beside it");
  check_may_read(*found, {path_, 0, element + ".uri", "", "", "", ""});
  bytes = read_file(*found);
  return *bytes;
}

std::string_view GltfDocument::read_view(std::int64_t index, const std::string& user) const {
  const Json& view = find("bufferViews", index, user);
  const std::string element = list_place("bufferViews", index);
  const std::int64_t at = gltf_index(view, "buffer");
  if (at < 0) refuse(element, "names no buffer");
  const std::string_view bytes = buffer(std::size_t(at), element);
  const auto offset = std::uint64_t(gltf_number(view, "byteOffset", 0)), length = std::uint64_t(gltf_number(view, "byteLength", 0));
  if (offset > bytes.size() || length > bytes.size() - offset)
    refuse(element, "needs " + std::to_string(offset + length) + " bytes of a buffer that has " + std::to_string(bytes.size()));
  return bytes.substr(std::size_t(offset), std::size_t(length));
}

void GltfDocument::read_elements(std::string_view bytes, std::size_t stride, int type, bool normalized, GltfAccessor& out) const {
  const std::size_t size = size_of_type(type);
  out.values.reserve(out.count * out.components);
  for (std::size_t i = 0; i < out.count; ++i)
    for (std::size_t k = 0; k < out.components; ++k)
      out.values.push_back(read_component(bytes.data() + i * stride + k * size, type, normalized));
}

GltfAccessor GltfDocument::read_accessor(std::int64_t index, std::size_t components, const std::string& user) const {
  const Json& accessor = find("accessors", index, user);
  const std::string element = list_place("accessors", index);
  const std::int64_t type = gltf_index(accessor, "componentType"), count = gltf_index(accessor, "count");
  GltfAccessor out;
  out.components = components_of(gltf_text(accessor, "type"));
  if (size_of_type(type) == 0) refuse(element, "has no known componentType: " + std::to_string(type));
  if (out.components == 0 || count < 0) refuse(element, "has no known type, or no count");
  if (components != 0 && out.components != components)
    refuse(element, "has the type " + printable(gltf_text(accessor, "type")) + ", which does not fit its use in " + user);
  out.count = std::size_t(count);
  const Json* flag = gltf_member(accessor, "normalized");
  const bool normalized = flag && flag->get<bool>();
  const std::int64_t view = gltf_index(accessor, "bufferView");
  if (view >= 0) {
    const std::string_view bytes = read_view(view, element);
    const std::size_t tight = size_of_type(type) * out.components;
    const Json& description = json_["bufferViews"][std::size_t(view)];
    const auto stride = std::size_t(gltf_number(description, "byteStride", double(tight)));
    const auto offset = std::uint64_t(gltf_number(accessor, "byteOffset", 0));
    const bool fits = stride > 0 && stride < 65536 && offset <= bytes.size() &&
                      (out.count == 0 || (out.count <= bytes.size() && offset + (out.count - 1) * stride + tight <= bytes.size()));
    if (!fits) refuse(element, "reaches beyond its bufferView of " + std::to_string(bytes.size()) + " bytes");
    read_elements(bytes.substr(std::size_t(offset)), stride, int(type), normalized, out);
  } else {
    if (out.count > kMostElements) refuse(element, "has too many elements: " + std::to_string(count));
    out.values.assign(out.count * out.components, 0);
  }
  if (gltf_member(accessor, "sparse")) apply_sparse(accessor, int(type), normalized, element, out);
  return out;
}

void GltfDocument::apply_sparse(const Json& accessor, int type, bool normalized, const std::string& element,
                                GltfAccessor& out) const {
  const Json& sparse = accessor.at("sparse");
  const Json &at = sparse.at("indices"), &what = sparse.at("values");
  const std::int64_t count = gltf_index(sparse, "count"), index_type = gltf_index(at, "componentType");
  const std::size_t index_size = size_of_type(index_type), tight = size_of_type(type) * out.components;
  std::string_view indices = read_view(gltf_index(at, "bufferView"), element + ".sparse.indices");
  std::string_view values = read_view(gltf_index(what, "bufferView"), element + ".sparse.values");
  indices.remove_prefix(std::min(indices.size(), std::size_t(gltf_number(at, "byteOffset", 0))));
  values.remove_prefix(std::min(values.size(), std::size_t(gltf_number(what, "byteOffset", 0))));
  if (count < 0 || index_size == 0 || std::uint64_t(count) > indices.size() / index_size || std::uint64_t(count) > values.size() / tight)
    refuse(element, "its sparse part reaches beyond its bufferViews");
  GltfAccessor changed;
  changed.count = std::size_t(count), changed.components = out.components;
  read_elements(values, tight, type, normalized, changed);
  for (std::size_t i = 0; i < changed.count; ++i) {
    const double target = read_component(indices.data() + i * index_size, int(index_type), false);
    if (!(target >= 0 && target < double(out.count))) refuse(element, "its sparse part names an element that is not there");
    std::copy_n(changed.values.begin() + std::ptrdiff_t(i * out.components), out.components,
                out.values.begin() + std::ptrdiff_t(std::size_t(target) * out.components));
  }
}

}  // namespace rubble
