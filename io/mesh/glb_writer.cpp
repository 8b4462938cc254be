// glTF 2.0 in one binary file: https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html
#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "io/base/atomic_file.h"
#include "io/base/little_endian.h"
#include "io/mesh/pile_export.h"
#include "kernel/base/error.h"

namespace rubble {
namespace {

using Json = nlohmann::ordered_json;

enum { kArrayBuffer = 34962, kElementArrayBuffer = 34963, kUint32 = 5125, kFloat = 5126 };

// Z up to Y up: a turn by -90 degrees about X, here alone.
Vec3f to_y_up(const Vec3f& v) { return {v.x, v.z, 0.0f - v.y}; }
Vec3 to_y_up(const Vec3& v) { return {v.x, v.z, 0.0 - v.y}; }

class GlbBuilder {
 public:
  explicit GlbBuilder(const PileModel& model) : model_(model) {
    json_["asset"] = {{"version", "2.0"}, {"generator", "Rubble"}};
    json_["scene"] = 0;
    json_["scenes"] = Json::array({Json{{"name", "pile"}}});
  }

  void add_meshes() {
    for (const PileModel::Type& type : model_.types) {
      Json mesh{{"name", type.name}, {"primitives", Json::array()}};
      const int positions = add_vectors(type.mesh->positions, true);
      const int normals = type.mesh->normals.empty() ? -1 : add_vectors(type.mesh->normals, false);
      const std::size_t surfaces = std::max<std::size_t>(1, type.mesh->surface_names.size());
      for (std::size_t s = 0; s < surfaces; ++s) {
        const int indices = add_indices(*type.mesh, s);
        if (indices < 0) continue;
        Json primitive{{"attributes", {{"POSITION", positions}}}, {"indices", indices}};
        if (normals >= 0) primitive["attributes"]["NORMAL"] = normals;
        if (s < type.mesh->surface_names.size())
          primitive["material"] = find_material(type.mesh->surface_names[s]);
        mesh["primitives"].push_back(primitive);
      }
      json_["meshes"].push_back(mesh);
    }
  }

  void add_nodes() {
    Json children = Json::array();
    for (const PileModel::Piece& piece : model_.pieces) {
      const Vec3 t = to_y_up(piece.world_from_body.translation);
      const Quat& q = piece.world_from_body.rotation;
      const Vec3 axis = to_y_up(Vec3{q.x, q.y, q.z});
      children.push_back(children.size());
      json_["nodes"].push_back({{"name", piece.name},
                                {"mesh", piece.type},
                                {"translation", {t.x, t.y, t.z}},
                                {"rotation", {axis.x, axis.y, axis.z, q.w}},
                                {"scale", {piece.scale, piece.scale, piece.scale}}});
    }
    if (!children.empty()) json_["scenes"][0]["nodes"] = children;
  }

  // The text is padded by blanks, the numbers by zeros, as the format wants it.
  std::string take(const std::string& path) {
    if (!bytes_.empty()) json_["buffers"] = Json::array({Json{{"byteLength", bytes_.size()}}});
    std::string text = json_.dump();
    text.append((4 - text.size() % 4) % 4, ' ');
    const std::size_t size = 12 + 8 + text.size() + (bytes_.empty() ? 0 : 8 + bytes_.size());
    if (size > std::numeric_limits<std::uint32_t>::max())
      throw RunError("cannot write " + path + ": a .glb file holds at most 4 GiB");
    std::string out = "glTF";
    put(out, std::uint32_t{2});
    put(out, static_cast<std::uint32_t>(size));
    put_chunk(out, "JSON", text);
    if (!bytes_.empty()) put_chunk(out, std::string_view("BIN\0", 4), bytes_);
    return out;
  }

 private:
  static void put_chunk(std::string& out, std::string_view type, const std::string& content) {
    put(out, static_cast<std::uint32_t>(content.size()));
    out.append(type);
    out += content;
  }

  // What was appended to bytes_ since `start`, as a view and an accessor of it.
  int add_accessor(std::size_t start, int target, int component, const char* type,
                   std::size_t count) {
    Json view{{"buffer", 0}, {"byteOffset", start}, {"byteLength", bytes_.size() - start}};
    view["target"] = target;
    json_["bufferViews"].push_back(view);
    json_["accessors"].push_back({{"bufferView", json_["bufferViews"].size() - 1},
                                  {"componentType", component},
                                  {"count", count},
                                  {"type", type}});
    return static_cast<int>(json_["accessors"].size()) - 1;
  }

  int add_vectors(const std::vector<Vec3f>& vectors, bool with_bounds) {
    const std::size_t start = bytes_.size();
    Vec3f low = to_y_up(vectors.front()), high = low;
    for (const Vec3f& vector : vectors) {
      const Vec3f v = to_y_up(vector);
      low = min(low, v), high = max(high, v);
      for (int i = 0; i < 3; ++i) put(bytes_, v[i]);
    }
    const int accessor = add_accessor(start, kArrayBuffer, kFloat, "VEC3", vectors.size());
    if (with_bounds) {
      json_["accessors"].back()["min"] = {low.x, low.y, low.z};
      json_["accessors"].back()["max"] = {high.x, high.y, high.z};
    }
    return accessor;
  }

  // Of one surface; -1 when it has no triangle.
  int add_indices(const TriangleMesh& mesh, std::size_t surface) {
    const std::size_t start = bytes_.size();
    std::size_t count = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      if (!mesh.surfaces.empty() && mesh.surfaces[i] != surface) continue;
      for (const std::uint32_t v : mesh.triangles[i]) put(bytes_, v), ++count;
    }
    return count ? add_accessor(start, kElementArrayBuffer, kUint32, "SCALAR", count) : -1;
  }

  std::size_t find_material(const std::string& name) {
    for (std::size_t i = 0; i < material_names_.size(); ++i)
      if (material_names_[i] == name) return i;
    const Vec3f c = model_.colour_of(name);
    json_["materials"].push_back({{"name", name},
                                  {"pbrMetallicRoughness",
                                   {{"baseColorFactor", {c.x, c.y, c.z, 1}},
                                    {"metallicFactor", 0},
                                    {"roughnessFactor", 0.9}}}});
    material_names_.push_back(name);
    return material_names_.size() - 1;
  }

  const PileModel& model_;
  Json json_;
  std::string bytes_;  // all numbers; every part's size is a multiple of 4
  std::vector<std::string> material_names_;
};

}  // namespace

void write_glb(const std::string& path, const PileModel& model) {
  GlbBuilder builder(model);
  builder.add_meshes();
  builder.add_nodes();
  write_text_file(path, builder.take(path));
}

}  // namespace rubble
