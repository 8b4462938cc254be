#include "io/mesh_formats/scene_reader.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "io/mesh_formats/draco_decoder.h"
#include "io/mesh_formats/gltf_document.h"
#include "kernel/base/error.h"
#include "kernel/base/text.h"

namespace rubble {
namespace {

using Json = nlohmann::json;

constexpr int kDeepestNode = 200;
constexpr std::size_t kMostPlaced = 100000;  // meshes of nodes and instances
constexpr int kMostUvSets = 8;

struct Affine {
  Mat3 turn = Mat3::identity();  // with scale and shear
  Vec3 shift;

  Vec3 operator*(const Vec3& p) const { return turn * p + shift; }
  Affine operator*(const Affine& b) const { return {turn * b.turn, turn * b.shift + shift}; }
  Affine operator*(double s) const { return {turn * s, shift * s}; }
  double determinant() const { return dot(turn.rows[0], cross(turn.rows[1], turn.rows[2])); }
  // The inverse transpose but for its size: normals go by it.
  Mat3 normal_turn() const {
    const double sign = determinant() < 0 ? -1 : 1;
    const Mat3& m = turn;
    return {{cross(m.rows[1], m.rows[2]) * sign, cross(m.rows[2], m.rows[0]) * sign, cross(m.rows[0], m.rows[1]) * sign}};
  }
};

// Column-major, as glTF has them.
Affine from_columns(const double* m) {
  return {{{{m[0], m[4], m[8]}, {m[1], m[5], m[9]}, {m[2], m[6], m[10]}}}, {m[12], m[13], m[14]}};
}

Affine from_parts(const Vec3& shift, const Quat& turn, const Vec3& scale) {
  const double size = turn.w * turn.w + turn.x * turn.x + turn.y * turn.y + turn.z * turn.z;
  const Mat3 rotation = size > 0 ? normalized(turn).matrix() : Mat3::identity();
  return {rotation * Mat3::diagonal(scale), shift};
}

// A primitive in the frame of its mesh, before skins and nodes.
struct Primitive {
  int material = -1;
  std::vector<Vec3> positions;
  std::vector<Vec3f> normals, colours;
  std::vector<std::vector<std::array<float, 2>>> uv_sets;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<GltfAccessor> joints, weights;
};

class GltfReader {
 public:
  explicit GltfReader(const std::string& path) : document_(path, scene_) {}

  ImportedScene read() {
    scene_.linear_colours = true;
    read_gltf_materials(document_, scene_);
    const std::vector<std::int64_t> roots = find_roots();
    globals_.resize(document_.count("nodes"));
    for (const std::int64_t root : roots) place_node(root, {}, 0);
    for (const std::int64_t root : order_) add_node(root);
    return std::move(scene_);
  }

 private:
  struct Placed {
    bool known = false;
    Affine file_from_node;
  };

  // The nodes of the default scene; of a file without scenes, those that are nobody's children.
  std::vector<std::int64_t> find_roots() {
    std::vector<std::int64_t> roots;
    if (document_.count("scenes") > 0) {
      const std::int64_t scene = std::max<std::int64_t>(0, gltf_index(document_.json(), "scene"));
      if (document_.count("scenes") > 1)
        scene_.note("only scene " + std::to_string(scene) + " of its " + std::to_string(document_.count("scenes")) + " scenes is read");
      if (const Json* nodes = gltf_member(document_.find("scenes", scene, "scene"), "nodes"))
        for (const Json& node : *nodes) roots.push_back(node.get<std::int64_t>());
      return roots;
    }
    std::set<std::int64_t> children;
    for (std::size_t i = 0; i < document_.count("nodes"); ++i)
      if (const Json* list = gltf_member(document_.json()["nodes"][i], "children"))
        for (const Json& child : *list) children.insert(child.get<std::int64_t>());
    for (std::size_t i = 0; i < document_.count("nodes"); ++i)
      if (!children.count(std::int64_t(i))) roots.push_back(std::int64_t(i));
    return roots;
  }

  static std::string name_of(std::int64_t node) { return "nodes[" + std::to_string(node) + "]"; }

  static Affine pose_of(const Json& node) {
    if (const Json* matrix = gltf_member(node, "matrix")) {
      double m[16] = {};
      for (std::size_t i = 0; i < 16; ++i) m[i] = matrix->at(i).get<double>();
      return from_columns(m);
    }
    const auto vector = [&node](const char* name, const Vec3& otherwise) {
      const Json* list = gltf_member(node, name);
      return list ? Vec3(list->at(0).get<double>(), list->at(1).get<double>(), list->at(2).get<double>()) : otherwise;
    };
    Quat turn;
    if (const Json* q = gltf_member(node, "rotation"))
      turn = {q->at(3).get<double>(), q->at(0).get<double>(), q->at(1).get<double>(), q->at(2).get<double>()};
    return from_parts(vector("translation", {0, 0, 0}), turn, vector("scale", {1, 1, 1}));
  }

  // First where all nodes are, since joints of skins may come after the skins.
  void place_node(std::int64_t index, const Affine& file_from_parent, int depth) {
    const Json& node = document_.find("nodes", index, "a scene or node");
    Placed& placed = globals_[std::size_t(index)];
    if (placed.known || depth > kDeepestNode) document_.refuse(name_of(index), "has two parents, or is nested too deep");
    placed = {true, file_from_parent * pose_of(node)};
    order_.push_back(index);
    const Affine here = placed.file_from_node;
    if (const Json* children = gltf_member(node, "children"))
      for (const Json& child : *children) place_node(child.get<std::int64_t>(), here, depth + 1);
  }

  void add_node(std::int64_t index) {
    const Json& node = document_.json()["nodes"][std::size_t(index)];
    const std::int64_t mesh_index = gltf_index(node, "mesh");
    if (mesh_index < 0) return;
    const Json& mesh = document_.find("meshes", mesh_index, name_of(index));
    const Json* weights = gltf_member(node, "weights");
    if (!weights) weights = gltf_member(mesh, "weights");
    std::vector<double> morphs;
    if (weights)
      for (const Json& weight : *weights) morphs.push_back(weight.get<double>());
    std::vector<Primitive> primitives;
    const Json* list = gltf_member(mesh, "primitives");
    for (std::size_t i = 0; list && i < list->size(); ++i)
      read_primitive((*list)[i], "meshes[" + std::to_string(mesh_index) + "].primitives[" + std::to_string(i) + "]", morphs, primitives);
    const std::int64_t skin = gltf_index(node, "skin");
    for (const Affine& at : instances_of(node, index)) {
      if (++placed_ > kMostPlaced) document_.refuse(name_of(index), "is one of more than " + std::to_string(kMostPlaced) + " meshes");
      ++object_;
      for (Primitive& primitive : primitives) {
        if (skin >= 0)
          add_skinned(primitive, skin, name_of(index));
        else
          add_placed(primitive, at);
      }
    }
  }

  // One place, or those of EXT_mesh_gpu_instancing.
  std::vector<Affine> instances_of(const Json& node, std::int64_t index) const {
    const Affine& own = globals_[std::size_t(index)].file_from_node;
    const Json* extensions = gltf_member(node, "extensions");
    const Json* instancing = extensions ? gltf_member(*extensions, "EXT_mesh_gpu_instancing") : nullptr;
    const Json* attributes = instancing ? gltf_member(*instancing, "attributes") : nullptr;
    if (!attributes) return {own};
    const std::string user = name_of(index) + ".EXT_mesh_gpu_instancing";
    std::size_t count = 0;
    const auto read = [&](const char* name, std::size_t components) {
      const std::int64_t accessor = gltf_index(*attributes, name);
      if (accessor < 0) return GltfAccessor{};
      GltfAccessor values = document_.read_accessor(accessor, components, user);
      if (count != 0 && values.count != count) document_.refuse(user, "has attributes of different counts");
      count = values.count;
      return values;
    };
    const GltfAccessor shift = read("TRANSLATION", 3), turn = read("ROTATION", 4), scale = read("SCALE", 3);
    std::vector<Affine> out;
    for (std::size_t i = 0; i < std::min(count, kMostPlaced + 1); ++i) {
      const double* q = turn.count ? &turn.values[4 * i] : nullptr;
      out.push_back(own * from_parts(shift.count ? shift.vector(i) : Vec3(), q ? Quat(q[3], q[0], q[1], q[2]) : Quat(),
                                     scale.count ? scale.vector(i) : Vec3(1, 1, 1)));
    }
    return out;
  }

  void read_primitive(const Json& from, const std::string& element, const std::vector<double>& morphs,
                      std::vector<Primitive>& out) {
    const Json* mode_member = gltf_member(from, "mode");
    const std::int64_t mode = mode_member ? mode_member->get<std::int64_t>() : 4;
    if (mode < 4) return scene_.note(std::string(mode == 0 ? "points" : "lines") + " beside its faces are left out (" + element + ")");
    if (mode > 6) document_.refuse(element, "has no known mode: " + std::to_string(mode));
    const Json* attributes = gltf_member(from, "attributes");
    if (!attributes || !attributes->is_object() || gltf_index(*attributes, "POSITION") < 0) document_.refuse(element, "has no POSITION");
    Primitive primitive;
    primitive.material = int(gltf_index(from, "material"));
    if (primitive.material >= 0) document_.find("materials", primitive.material, element);
    std::unique_ptr<DracoMesh> draco;
    const Json* draco_ids = nullptr;
    if (const Json* extensions = gltf_member(from, "extensions"))
      if (const Json* compression = gltf_member(*extensions, "KHR_draco_mesh_compression")) {
        draco = decode(*compression, element);
        draco_ids = gltf_member(*compression, "attributes");
      }
    const auto read = [&](const std::string& name, std::size_t components) {
      const std::int64_t id = draco_ids ? gltf_index(*draco_ids, name.c_str()) : -1;
      const std::int64_t accessor = gltf_index(*attributes, name.c_str());
      if (accessor < 0) return GltfAccessor{};
      GltfAccessor values;
      if (id >= 0) {
        values.components = components != 0 ? components : gltf_text(document_.find("accessors", accessor, element), "type") == "VEC4" ? 4 : 3;
        values.values = draco->values(std::uint32_t(id), values.components);
        values.count = values.values.size() / values.components;
      } else {
        values = document_.read_accessor(accessor, components, element + "." + name);
      }
      if (!primitive.positions.empty() && values.count != primitive.positions.size())
        document_.refuse(element + "." + name, "has " + std::to_string(values.count) + " values for " +
                                                   std::to_string(primitive.positions.size()) + " vertices");
      return values;
    };
    const GltfAccessor positions = read("POSITION", 3);
    for (std::size_t i = 0; i < positions.count; ++i) primitive.positions.push_back(positions.vector(i));
    if (primitive.positions.empty()) return;
    const GltfAccessor normals = read("NORMAL", 3), colours = read("COLOR_0", 0);
    for (std::size_t i = 0; i < normals.count; ++i) primitive.normals.push_back(Vec3f(normals.vector(i)));
    for (std::size_t i = 0; colours.components >= 3 && i < colours.count; ++i) primitive.colours.push_back(Vec3f(colours.vector(i)));
    for (int set = 0; set < kMostUvSets; ++set) read_uv(read("TEXCOORD_" + std::to_string(set), 2), primitive);
    for (int set = 0; gltf_index(*attributes, ("JOINTS_" + std::to_string(set)).c_str()) >= 0; ++set) {
      primitive.joints.push_back(read("JOINTS_" + std::to_string(set), 4));
      primitive.weights.push_back(read("WEIGHTS_" + std::to_string(set), 4));
      if (primitive.weights.back().count == 0) document_.refuse(element, "has joints without weights");
    }
    apply_morphs(from, element, morphs, primitive);
    primitive.triangles = draco ? draco->triangles() : read_triangles(from, element, mode, primitive.positions.size());
    for (const auto& t : primitive.triangles)
      for (const std::uint32_t i : t)
        if (i >= primitive.positions.size()) document_.refuse(element, "has a corner " + std::to_string(i) + ", and " + std::to_string(primitive.positions.size()) + " vertices");
    out.push_back(std::move(primitive));
  }

  std::unique_ptr<DracoMesh> decode(const Json& compression, const std::string& element) const {
    try {
      return std::make_unique<DracoMesh>(document_.read_view(gltf_index(compression, "bufferView"), element));
    } catch (const RunError& error) {
      document_.refuse(element + ".KHR_draco_mesh_compression", error.what());
    }
  }

  static void read_uv(const GltfAccessor& from, Primitive& primitive) {
    std::vector<std::array<float, 2>> places;
    for (std::size_t i = 0; i < from.count; ++i)
      places.push_back({float(from.values[2 * i]), 1 - float(from.values[2 * i + 1])});  // upwards
    primitive.uv_sets.push_back(std::move(places));
  }

  void apply_morphs(const Json& from, const std::string& element, const std::vector<double>& weights, Primitive& primitive) const {
    const Json* targets = gltf_member(from, "targets");
    for (std::size_t t = 0; targets && t < targets->size() && t < weights.size(); ++t) {
      if (weights[t] == 0) continue;
      const std::string user = element + ".targets[" + std::to_string(t) + "]";
      const auto add = [&](const char* name, std::size_t count, const auto& use) {
        const std::int64_t accessor = gltf_index((*targets)[t], name);
        if (accessor < 0 || count == 0) return;
        const GltfAccessor moved = document_.read_accessor(accessor, 3, user);
        if (moved.count != count) document_.refuse(user, "moves " + std::to_string(moved.count) + " of " + std::to_string(count) + " vertices");
        for (std::size_t i = 0; i < count; ++i) use(i, moved.vector(i) * weights[t]);
      };
      add("POSITION", primitive.positions.size(), [&](std::size_t i, const Vec3& by) { primitive.positions[i] += by; });
      add("NORMAL", primitive.normals.size(), [&](std::size_t i, const Vec3& by) { primitive.normals[i] += Vec3f(by); });
    }
  }

  std::vector<std::array<std::uint32_t, 3>> read_triangles(const Json& from, const std::string& element, std::int64_t mode,
                                                           std::size_t vertices) const {
    std::vector<std::uint32_t> corners;
    if (gltf_index(from, "indices") >= 0) {
      const GltfAccessor indices = document_.read_accessor(gltf_index(from, "indices"), 1, element + ".indices");
      for (const double value : indices.values) corners.push_back(value >= 0 && value < 4294967295.0 ? std::uint32_t(value) : 4294967295u);
    } else {
      for (std::uint32_t i = 0; i < vertices; ++i) corners.push_back(i);
    }
    std::vector<std::array<std::uint32_t, 3>> out;
    for (std::size_t i = 2; i < corners.size(); i += mode == 4 ? 3 : 1) {
      if (mode == 6) out.push_back({corners[0], corners[i - 1], corners[i]});
      else if (mode == 5 && i % 2 == 1) out.push_back({corners[i - 1], corners[i - 2], corners[i]});
      else out.push_back({corners[i - 2], corners[i - 1], corners[i]});
    }
    return out;
  }

  ImportedMesh& begin_mesh(const Primitive& primitive) {
    scene_.meshes.emplace_back();
    ImportedMesh& mesh = scene_.meshes.back();
    mesh.material = primitive.material, mesh.object = object_;
    mesh.colours = primitive.colours;
    mesh.uv_sets = primitive.uv_sets;
    while (!mesh.uv_sets.empty() && mesh.uv_sets.back().empty()) mesh.uv_sets.pop_back();
    return mesh;
  }

  void add_placed(const Primitive& primitive, const Affine& at) {
    ImportedMesh& mesh = begin_mesh(primitive);
    for (const Vec3& p : primitive.positions) mesh.positions.push_back(at * p);
    const Mat3 turn = at.normal_turn();
    for (const Vec3f& n : primitive.normals) mesh.normals.push_back(Vec3f(normalized(turn * Vec3(n))));
    mesh.triangles = primitive.triangles;
    if (at.determinant() < 0)
      for (auto& t : mesh.triangles) std::swap(t[0], t[2]);
  }

  // Where the skin's joints are when their vertices are in the frame of the mesh.
  std::vector<Affine> joints_of(std::int64_t skin_index, const std::string& user) const {
    const Json& skin = document_.find("skins", skin_index, user);
    const std::string element = "skins[" + std::to_string(skin_index) + "]";
    GltfAccessor inverse;
    if (gltf_index(skin, "inverseBindMatrices") >= 0)
      inverse = document_.read_accessor(gltf_index(skin, "inverseBindMatrices"), 16, element);
    const Json* list = gltf_member(skin, "joints");
    std::vector<Affine> joints;
    for (std::size_t i = 0; list && i < list->size(); ++i) {
      const std::int64_t node = (*list)[i].get<std::int64_t>();
      document_.find("nodes", node, element);
      if (!globals_[std::size_t(node)].known) document_.refuse(element, "its joint " + name_of(node) + " is not in the scene");
      if (inverse.count != 0 && i >= inverse.count) document_.refuse(element, "has less inverse bind matrices than joints");
      joints.push_back(globals_[std::size_t(node)].file_from_node * (inverse.count ? from_columns(&inverse.values[16 * i]) : Affine{}));
    }
    return joints;
  }

  void add_skinned(const Primitive& primitive, std::int64_t skin, const std::string& user) {
    const std::vector<Affine> joints = joints_of(skin, user);
    if (primitive.joints.empty()) return add_placed(primitive, {});
    ImportedMesh& mesh = begin_mesh(primitive);
    mesh.triangles = primitive.triangles;
    for (std::size_t v = 0; v < primitive.positions.size(); ++v) {
      Affine sum{Mat3::diagonal({0, 0, 0}), {}};
      double total = 0;
      for (std::size_t k = 0; k < primitive.joints.size() * 4; ++k) {
        const double weight = primitive.weights[k / 4].values[4 * v + k % 4], joint = primitive.joints[k / 4].values[4 * v + k % 4];
        if (!(weight > 0)) continue;
        if (!(joint >= 0 && joint < double(joints.size()))) document_.refuse(user, "a vertex hangs on a joint that its skin does not have");
        const Affine part = joints[std::size_t(joint)] * weight;
        sum = {sum.turn + part.turn, sum.shift + part.shift};
        total += weight;
      }
      if (total > 0) sum = sum * (1 / total);
      else sum = {};
      mesh.positions.push_back(sum * primitive.positions[v]);
      if (!primitive.normals.empty()) mesh.normals.push_back(Vec3f(normalized(sum.normal_turn() * Vec3(primitive.normals[v]))));
    }
  }

  ImportedScene scene_;
  GltfDocument document_;
  std::vector<Placed> globals_;        // by node
  std::vector<std::int64_t> order_;    // of the nodes in the scene
  std::size_t placed_ = 0;
  int object_ = 0;
};

}  // namespace

ImportedScene read_gltf(const std::string& path) {
  const std::string version = GltfDocument::version_of(path);
  if (!version.empty() && version[0] == '1') return read_by_assimp(path);
  try {
    return GltfReader(path).read();
  } catch (const Json::exception& error) {
    refuse_mesh(path, std::string("a member of its JSON is of another type than glTF 2.0 wants: ") + error.what());
  }
}

}  // namespace rubble
