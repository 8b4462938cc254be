// glTF 2.0 in one binary file: https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html
#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "io/base/atomic_file.h"
#include "io/base/little_endian.h"
#include "io/mesh/mesh_writers.h"
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

  // Of the types that some piece has.
  void add_meshes() {
    std::vector<bool> used(model_.types.size(), false);
    for (const PileModel::Piece& piece : model_.pieces) used[piece.type] = true;
    int count = 0;
    for (std::size_t i = 0; i < model_.types.size(); ++i) {
      const PileModel::Type& type = model_.types[i];
      mesh_of_type_.push_back(used[i] ? count++ : -1);
      if (!used[i]) continue;
      Json mesh{{"name", type.name}, {"primitives", Json::array()}};
      int positions = -1, normals = -1;  // of surfaces without a paint, which share them
      const std::size_t surfaces = std::max<std::size_t>(1, type.mesh->surface_names.size());
      for (std::size_t s = 0; s < surfaces; ++s) {
        if (type.mesh->paint_of(s)) {
          add_painted(*type.mesh, s, mesh);
          continue;
        }
        const int indices = add_indices(*type.mesh, s);
        if (indices < 0) continue;
        if (positions < 0) {
          positions = add_vectors(type.mesh->positions, true);
          if (!type.mesh->normals.empty()) normals = add_vectors(type.mesh->normals, false);
        }
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
                                {"mesh", mesh_of_type_[piece.type]},
                                {"translation", {t.x, t.y, t.z}},
                                {"rotation", {axis.x, axis.y, axis.z, q.w}},
                                {"scale", {piece.scale, piece.scale, piece.scale}}});
    }
    if (!children.empty()) json_["scenes"][0]["nodes"] = children;
  }

  // A clip of the whole track; after add_nodes().
  void add_animation(const Track& track) {
    Json clip{{"name", "settling"}, {"samplers", Json::array()}, {"channels", Json::array()}};
    for (std::size_t node = 0; node < model_.pieces.size(); ++node) {
      const TrackBody* body = track.find(model_.pieces[node].number);
      if (!body) continue;
      if (body->keys.size() > 1) add_motion(track, *body, node, clip);
      add_life(track, *body, node, clip);
    }
    if (!clip["channels"].empty()) json_["animations"] = Json::array({clip});
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
  // Its triangles with vertices of their own, which have places in images and colours.
  void add_painted(const TriangleMesh& mesh, std::size_t surface, Json& out) {
    const GlbCorners corners = make_glb_corners(mesh, surface);
    if (corners.positions.empty()) return;
    const SurfacePaint& paint = *mesh.paints[surface];
    Json attributes{{"POSITION", add_vectors(corners.positions, true)},
                    {"NORMAL", add_vectors(corners.normals, false)}};
    if (paint.relief.side > 0) {
      std::vector<float> tangents;
      for (std::size_t i = 0; i < corners.tangents.size(); ++i) {
        const Vec3f t = to_y_up(corners.tangents[i]);
        tangents.insert(tangents.end(), {t.x, t.y, t.z, corners.handedness[i]});
      }
      attributes["TANGENT"] = add_floats(tangents, "VEC4", kArrayBuffer);
    }
    if (paint.albedo.side > 0 || paint.relief.side > 0)
      attributes["TEXCOORD_0"] = add_floats(corners.places, "VEC2", kArrayBuffer);
    if (corners.coloured) {
      std::vector<float> colours;
      for (const Vec3f& c : corners.colours) colours.insert(colours.end(), {c.x, c.y, c.z});
      attributes["COLOR_0"] = add_floats(colours, "VEC3", kArrayBuffer);
    }
    out["primitives"].push_back(
        {{"attributes", attributes}, {"material", find_painted(mesh.surface_names[surface], paint)}});
  }

  // Of one name, meshes may have different paints, or none.
  std::size_t find_painted(const std::string& name, const SurfacePaint& paint) {
    const auto key = std::make_pair(name, "paint " + paint.sha256);
    for (std::size_t i = 0; i < materials_.size(); ++i)
      if (materials_[i] == key) return i;
    const Vec3f& c = paint.colour;
    Json rough{{"baseColorFactor", {c.x, c.y, c.z, 1}},
               {"metallicFactor", paint.metalness},
               {"roughnessFactor", paint.roughness}};
    const GlbImages images = make_glb_images(paint);
    const auto add = [this](Json& to, const char* part, const std::string& png) {
      if (!png.empty()) to[part] = {{"index", add_image(png)}};
    };
    add(rough, "baseColorTexture", images.base_colour);
    add(rough, "metallicRoughnessTexture", images.metallic_roughness);
    Json material{{"name", name}, {"pbrMetallicRoughness", rough}};
    add(material, "normalTexture", images.normal);
    json_["materials"].push_back(material);
    materials_.push_back(key);
    return materials_.size() - 1;
  }

  std::size_t add_image(const std::string& png) {
    Json view{{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", png.size()}};
    bytes_ += png;
    bytes_.append((4 - bytes_.size() % 4) % 4, '\0');
    json_["bufferViews"].push_back(view);
    json_["images"].push_back({{"bufferView", json_["bufferViews"].size() - 1}, {"mimeType", "image/png"}});
    json_["textures"].push_back({{"source", json_["images"].size() - 1}});
    return json_["textures"].size() - 1;
  }

  static void put_chunk(std::string& out, std::string_view type, const std::string& content) {
    put(out, static_cast<std::uint32_t>(content.size()));
    out.append(type);
    out += content;
  }

  void add_motion(const Track& track, const TrackBody& body, std::size_t node, Json& clip) {
    std::vector<float> times, places, turns;
    Quat last = body.keys.front().world_from_body.rotation;
    for (const TrackKey& key : body.keys) {
      times.push_back(float(track.times[key.sample]));
      const Vec3 t = to_y_up(key.world_from_body.translation);
      Quat q = key.world_from_body.rotation;
      // Of the two signs of a rotation the one that a reader blends the short way to.
      const double along = q.w * last.w + q.x * last.x + q.y * last.y + q.z * last.z;
      if (along < 0) q = {-q.w, -q.x, -q.y, -q.z};
      last = q;
      const Vec3 axis = to_y_up(Vec3{q.x, q.y, q.z});
      for (int i = 0; i < 3; ++i) places.push_back(float(t[i]));
      for (const double part : {axis.x, axis.y, axis.z, q.w}) turns.push_back(float(part));
    }
    const int input = add_times(times);
    add_channel(node, "translation", "LINEAR", input, add_floats(places, "VEC3"), clip);
    add_channel(node, "rotation", "LINEAR", input, add_floats(turns, "VEC4"), clip);
  }

  // Nothing to see before it appears, and from when it is gone.
  void add_life(const Track& track, const TrackBody& body, std::size_t node, Json& clip) {
    const auto size = float(model_.pieces[node].scale);
    const double appears = track.times[body.keys.front().sample];
    std::vector<float> times, sizes;
    const auto add = [&](double time, float scale) {
      times.push_back(float(time));
      sizes.insert(sizes.end(), 3, scale);
    };
    if (appears > track.begin()) add(track.begin(), 0);
    add(appears, size);
    if (body.gone != TrackBody::kStays) add(track.times[body.gone], 0);
    if (times.size() == 1) return;
    const int output = add_floats(sizes, "VEC3"), input = add_times(times);  // one after the other, for any compiler
    add_channel(node, "scale", "STEP", input, output, clip);
  }

  static void add_channel(std::size_t node, const char* path, const char* interpolation, int input,
                          int output, Json& clip) {
    clip["channels"].push_back(
        {{"sampler", clip["samplers"].size()}, {"target", {{"node", node}, {"path", path}}}});
    clip["samplers"].push_back(
        {{"input", input}, {"output", output}, {"interpolation", interpolation}});
  }

  int add_floats(const std::vector<float>& numbers, const char* type, int target = 0) {
    const std::size_t start = bytes_.size();
    for (const float number : numbers) put(bytes_, number);
    const std::size_t parts = type[0] == 'V' ? std::size_t(type[3] - '0') : 1;  // "VEC3"
    return add_accessor(start, target, kFloat, type, numbers.size() / parts);
  }

  int add_times(const std::vector<float>& times) {
    const int accessor = add_floats(times, "SCALAR");
    json_["accessors"].back()["min"] = {times.front()};
    json_["accessors"].back()["max"] = {times.back()};
    return accessor;
  }

  // What was appended to bytes_ since `start`, as a view and an accessor of it. target: 0: none.
  int add_accessor(std::size_t start, int target, int component, const char* type,
                   std::size_t count) {
    Json view{{"buffer", 0}, {"byteOffset", start}, {"byteLength", bytes_.size() - start}};
    if (target != 0) view["target"] = target;
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
    const auto key = std::make_pair(name, std::string());
    for (std::size_t i = 0; i < materials_.size(); ++i)
      if (materials_[i] == key) return i;
    const Vec3f c = model_.colour_of(name);
    json_["materials"].push_back({{"name", name},
                                  {"pbrMetallicRoughness",
                                   {{"baseColorFactor", {c.x, c.y, c.z, 1}},
                                    {"metallicFactor", 0},
                                    {"roughnessFactor", 0.9}}}});
    materials_.push_back(key);
    return materials_.size() - 1;
  }

  const PileModel& model_;
  Json json_;
  std::string bytes_;  // all numbers; every part's size is a multiple of 4
  std::vector<std::pair<std::string, std::string>> materials_;  // name and paint
  std::vector<int> mesh_of_type_;  // -1: no piece has it
};

}  // namespace

void write_glb(const std::string& path, const PileModel& model) {
  GlbBuilder builder(model);
  builder.add_meshes();
  builder.add_nodes();
  write_text_file(path, builder.take(path));
}

void write_track_glb(const std::string& path, const PileModel& model, const Track& track) {
  GlbBuilder builder(model);
  builder.add_meshes();
  builder.add_nodes();
  builder.add_animation(track);
  write_text_file(path, builder.take(path));
}

}  // namespace rubble
