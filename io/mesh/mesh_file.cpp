#include "io/mesh/mesh_file.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <limits>
#include <unordered_map>

#include "io/mesh/mesh_bytes.h"
#include "io/mesh/mesh_paint.h"
#include "kernel/base/error.h"
#include "kernel/base/system/isolated_worker.h"
#include "kernel/base/text.h"

// assimp is called in child processes alone: kernel/base/system/isolated_worker.h says why.

namespace rubble {
namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& message,
                         const std::string& hint = "") {
  Diagnostic diagnostic;
  diagnostic.file = path;
  diagnostic.message = message;
  diagnostic.hint = hint;
  throw InputError(diagnostic);
}

void check_readable(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) refuse(path, "the mesh file does not exist");
  if (!fs::is_regular_file(status)) refuse(path, "is not a file");
  if (fs::file_size(path, error) == 0) refuse(path, "the mesh file is empty");
}

// The importer owns the scene: it must live as long as that is read.
const aiScene& import(Assimp::Importer& importer, const std::string& path, unsigned steps) {
  const aiScene* scene = importer.ReadFile(path, steps);
  if (!scene) refuse(path, std::string("cannot be read as a mesh: ") + importer.GetErrorString());
  if (scene->mFlags & AI_SCENE_FLAGS_INCOMPLETE || scene->mNumMeshes == 0 || !scene->mRootNode) {
    refuse(path, "holds no triangles");
  }
  return *scene;
}

struct PlacedMesh {
  const aiMesh* mesh;
  aiMatrix4x4 file_from_mesh;
  const aiNode* node;
};

// Every mesh where the file's tree of nodes puts it, in the order of the tree.
void collect(const aiScene& scene, const aiNode& node, const aiMatrix4x4& file_from_parent,
             std::vector<PlacedMesh>& placed) {
  const aiMatrix4x4 file_from_node = file_from_parent * node.mTransformation;
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    placed.push_back({scene.mMeshes[node.mMeshes[i]], file_from_node, &node});
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i) {
    collect(scene, *node.mChildren[i], file_from_node, placed);
  }
}

std::vector<PlacedMesh> collect(const aiScene& scene) {
  std::vector<PlacedMesh> placed;
  collect(scene, *scene.mRootNode, aiMatrix4x4(), placed);
  return placed;
}

Vec3 turn_up(const aiVector3D& v, UpAxis up) {
  const Vec3 a(static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z));
  return up == UpAxis::z ? a : Vec3(a.x, -a.z, a.y);
}

[[noreturn]] void refuse_points_and_lines(const std::string& path) {
  refuse(path, "holds points or lines beside its faces", "export faces only");
}

// Corners may be rounded by this share of the mesh's size; by more than `kCoarse`, only by `kCoarseShare` of it.
constexpr double kRoundedAway = 1e-3, kCoarseShare = 1e-5;
constexpr double kCoarse = 1e-3;  // unit: m

// What makes two vertices one: equal bits of position and normal.
struct VertexKey {
  float values[6];
  bool operator==(const VertexKey& other) const {
    return std::memcmp(values, other.values, sizeof values) == 0;
  }
};
struct VertexKeyHash {
  std::size_t operator()(const VertexKey& key) const {
    std::uint64_t hash = 14695981039346656037u;  // FNV-1a over words
    for (const float value : key.values) {
      std::uint32_t bits;
      std::memcpy(&bits, &value, sizeof bits);
      hash = (hash ^ bits) * 1099511628211u;
    }
    return hash ^ (hash >> 29);
  }
};

// Joins meshes into one. The map is only asked, never walked: numbers follow first use.
class MeshBuilder {
 public:
  MeshBuilder(const std::string& path, const MeshUnits& units, bool with_normals, MeshPaints& paints)
      : path_(path), units_(units), with_normals_(with_normals), paints_(paints) {}

  void add(const PlacedMesh& placed, const std::string& surface) {
    const aiMesh& mesh = *placed.mesh;
    const std::uint8_t surface_index = find_surface(surface, paints_.of(mesh));
    aiMatrix3x3 turn(placed.file_from_mesh);
    const bool mirrored = turn.Determinant() < 0;
    turn.Inverse().Transpose();  // normals go by the inverse transpose
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      check_face(mesh, face);
      std::array<std::uint32_t, 3> triangle{};
      std::array<PaintCorner, 3> paint{};
      for (unsigned k = 0; k < 3; ++k) {
        const unsigned corner = face.mIndices[mirrored ? 2 - k : k];
        triangle[k] = add_vertex(placed, turn, corner);
        if (paints_.any()) paint[k] = paints_.corner(mesh, corner);
      }
      if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) {
        continue;  // no area: two corners are one point
      }
      mesh_.triangles.push_back(triangle);
      mesh_.surfaces.push_back(surface_index);
      if (paints_.any()) mesh_.paint_corners.push_back(paint);
    }
  }

  TriangleMesh take() {
    if (mesh_.triangles.empty()) refuse(path_, "holds no triangles");
    check_place();
    return std::move(mesh_);
  }

 private:
  // Far from the origin single precision rounds corners to places that make another shape.
  void check_place() const {
    const Aabb box = mesh_.bounds();
    const Vec3 size = box.max - box.min, far = max(box.max, -box.min);
    const double longest = std::max({size.x, size.y, size.z}), farthest = std::max({far.x, far.y, far.z});
    const double rounding = farthest * double(std::numeric_limits<float>::epsilon());
    if (rounding <= kRoundedAway * longest && (rounding <= kCoarse || rounding <= kCoarseShare * longest)) return;
    char found[160], hint[160];
    std::snprintf(found, sizeof found, "a mesh of %.3g m at up to %.6g m, where corners are rounded to %.2g m", longest,
                  farthest, rounding);
    const Vec3 middle = (box.min + box.max) * 0.5;
    std::snprintf(hint, sizeof hint, "subtract about (%.0f, %.0f, %.0f) m from its corners before it is exported", middle.x,
                  middle.y, middle.z);
    throw InputError({path_, 0, "", "lies too far from its origin", "corners near the origin, not in map coordinates",
                      found, hint});
  }

  void check_face(const aiMesh& mesh, const aiFace& face) const {
    if (face.mNumIndices != 3) refuse_points_and_lines(path_);
    for (unsigned k = 0; k < 3; ++k)
      if (face.mIndices[k] >= mesh.mNumVertices) refuse(path_, "has a face with a corner too many");
  }

  // Two materials of one name are two surfaces if they have two paints.
  std::uint8_t find_surface(const std::string& name, const std::shared_ptr<const SurfacePaint>& paint) {
    for (std::size_t i = 0; i < mesh_.surface_names.size(); ++i) {
      if (mesh_.surface_names[i] == printable(name) && mesh_.paint_of(i) == paint.get())
        return static_cast<std::uint8_t>(i);
    }
    if (mesh_.surface_names.size() == 256) refuse(path_, "has more than 256 materials");
    mesh_.surface_names.push_back(printable(name));  // it comes to be text of JSON
    if (paint) mesh_.paints.push_back(paint);
    return static_cast<std::uint8_t>(mesh_.surface_names.size() - 1);
  }

  std::uint32_t add_vertex(const PlacedMesh& placed, const aiMatrix3x3& turn, unsigned corner) {
    const Vec3 position =
        turn_up(placed.file_from_mesh * placed.mesh->mVertices[corner], units_.up);
    const Vec3f p(position * units_.metres_per_unit);
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
      refuse(path_, "has a vertex that is not a number");
    }
    Vec3f n;
    if (with_normals_)
      n = Vec3f(normalized(turn_up(turn * placed.mesh->mNormals[corner], units_.up)));
    // + 0 turns -0 into 0, which is the same place.
    const VertexKey key{{p.x + 0.0f, p.y + 0.0f, p.z + 0.0f, n.x + 0.0f, n.y + 0.0f, n.z + 0.0f}};
    const auto next = static_cast<std::uint32_t>(mesh_.positions.size());
    const auto [found, is_new] = numbers_.try_emplace(key, next);
    if (is_new) {
      mesh_.positions.push_back(p);
      if (with_normals_) mesh_.normals.push_back(n);
    }
    return found->second;
  }

  const std::string& path_;
  MeshUnits units_;
  bool with_normals_;
  MeshPaints& paints_;
  TriangleMesh mesh_;
  std::unordered_map<VertexKey, std::uint32_t, VertexKeyHash> numbers_;
};

void check_units(const MeshUnits& units, const std::string& path) {
  if (units.metres_per_unit > 0 && std::isfinite(units.metres_per_unit)) return;
  refuse(path, "the mesh needs a positive unit, not " + std::to_string(units.metres_per_unit));
}

std::string name_of_material(const aiScene& scene, const aiMesh& mesh) {
  if (mesh.mMaterialIndex >= scene.mNumMaterials) return "";
  return scene.mMaterials[mesh.mMaterialIndex]->GetName().C_Str();
}

TriangleMesh import_mesh(const std::string& path, const MeshUnits& units, std::vector<std::string>& notes) {
  Assimp::Importer importer;
  const aiScene& scene = import(importer, path, aiProcess_Triangulate);
  const std::vector<PlacedMesh> placed = collect(scene);
  bool with_normals = true;
  for (const PlacedMesh& p : placed) {
    with_normals = with_normals && p.mesh->HasNormals();
    if (p.mesh->mPrimitiveTypes & (aiPrimitiveType_POINT | aiPrimitiveType_LINE))
      refuse_points_and_lines(path);
  }
  MeshPaints paints(scene, path);
  MeshBuilder builder(path, units, with_normals, paints);
  for (const PlacedMesh& p : placed) builder.add(p, name_of_material(scene, *p.mesh));
  notes = paints.notes();
  return builder.take();
}

std::vector<std::vector<Vec3>> import_convex_parts(const std::string& path,
                                                   const MeshUnits& units) {
  Assimp::Importer importer;
  const aiScene& scene = import(importer, path, 0);
  std::vector<std::vector<Vec3>> parts;
  const aiNode* node = nullptr;
  std::unordered_map<VertexKey, std::uint32_t, VertexKeyHash> seen;
  for (const PlacedMesh& placed : collect(scene)) {
    if (placed.node != node) {  // an object of several materials is still one part
      parts.emplace_back();
      seen.clear();
      node = placed.node;
    }
    for (unsigned i = 0; i < placed.mesh->mNumVertices; ++i) {
      const aiVector3D v = placed.file_from_mesh * placed.mesh->mVertices[i];
      if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z))
        refuse(path, "has a vertex that is not a number");
      const VertexKey key{{v.x + 0.0f, v.y + 0.0f, v.z + 0.0f, 0, 0, 0}};
      if (!seen.try_emplace(key, 0).second) continue;
      parts.back().push_back(turn_up(v, units.up) * units.metres_per_unit);
    }
  }
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].size() >= 4) continue;
    refuse(path, "object " + std::to_string(i + 1) + " has " + std::to_string(parts[i].size()) +
                     " corner points; a convex part needs at least 4");
  }
  return parts;
}

constexpr char kMesh = 'm', kParts = 'p';  // what is asked for

std::string pack_request(char kind, const std::string& path, const MeshUnits& units) {
  CacheWriter writer;
  writer.put(kind);
  writer.put(units.metres_per_unit);
  writer.put(units.up);
  return writer.bytes() + path;
}

std::string answer_request(const std::string& request) {
  char kind = 0;
  MeshUnits units;
  const std::size_t size = sizeof kind + sizeof units.metres_per_unit + sizeof units.up;
  CacheReader reader(std::string_view(request).substr(0, size));
  reader.get(kind);
  reader.get(units.metres_per_unit);
  reader.get(units.up);
  const std::string path = request.substr(size);
  if (kind == kParts) return parts_to_bytes(import_convex_parts(path, units));
  std::vector<std::string> notes;
  const TriangleMesh mesh = import_mesh(path, units, notes);
  return mesh_to_bytes(mesh, notes);
}

}  // namespace

MeshImporter::MeshImporter() : worker_(std::make_unique<IsolatedWorker>("mesh", answer_request)) {}

MeshImporter::~MeshImporter() = default;

std::string MeshImporter::ask(char kind, const std::string& path, const MeshUnits& units) {
  check_units(units, path);
  check_readable(path);
  return worker_->ask(path, pack_request(kind, path, units));
}

TriangleMesh MeshImporter::load_mesh(const std::string& path, const MeshUnits& units) {
  return mesh_from_bytes(ask(kMesh, path, units), notes_);
}

std::vector<std::vector<Vec3>> MeshImporter::load_convex_parts(const std::string& path,
                                                               const MeshUnits& units) {
  return parts_from_bytes(ask(kParts, path, units));
}

TriangleMesh load_mesh(const std::string& path, const MeshUnits& units) {
  return MeshImporter().load_mesh(path, units);
}

std::vector<std::vector<Vec3>> load_convex_parts(const std::string& path, const MeshUnits& units) {
  return MeshImporter().load_convex_parts(path, units);
}

}  // namespace rubble
