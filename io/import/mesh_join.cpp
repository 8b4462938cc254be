#include "io/import/mesh_join.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <unordered_map>

#include "io/import/mesh_paint.h"
#include "kernel/base/text.h"

namespace rubble {
namespace {

constexpr std::size_t kMostSurfaces = 256;

Vec3 turn_up(const Vec3& a, FileUp up) {
  if (up == FileUp::y) return {a.x, -a.z, a.y};
  // X_UP of COLLADA: right is -Y, up is X, inwards is Z; ours: right X, up Z, inwards -Y.
  return up == FileUp::x ? Vec3(-a.y, -a.z, a.x) : a;
}

bool is_finite(const Vec3f& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

// What makes two vertices one: equal bits of position and normal.
struct VertexKey {
  float values[6];
  bool operator==(const VertexKey& other) const { return std::memcmp(values, other.values, sizeof values) == 0; }
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
// + 0 turns -0 into 0, which is the same place.
VertexKey key_of(const Vec3f& p, const Vec3f& n) {
  return {{p.x + 0.0f, p.y + 0.0f, p.z + 0.0f, n.x + 0.0f, n.y + 0.0f, n.z + 0.0f}};
}

// The maps are only asked, never walked: numbers follow first use.
using VertexNumbers = std::unordered_map<VertexKey, std::uint32_t, VertexKeyHash>;

class MeshJoiner {
 public:
  MeshJoiner(ImportedScene& scene, const std::string& path, const FileFrame& frame, MeshPaints& paints)
      : scene_(scene), path_(path), frame_(frame), paints_(paints) {
    for (const ImportedMesh& mesh : scene.meshes)
      with_normals_ = with_normals_ && (!mesh.normals.empty() || mesh.triangles.empty());
  }

  TriangleMesh join() {
    for (const ImportedMesh& mesh : scene_.meshes) add(mesh);
    if (joined_.triangles.empty()) refuse_mesh(path_, "holds no triangles");
    if (repaired_normals_ > 0)
      scene_.note(std::to_string(repaired_normals_) + " of " + std::to_string(normals_) +
                  " normals are zero or not numbers; those of the faces are used");
    if (dropped_ > 0 && dropped_ * 100 > joined_.triangles.size())
      scene_.note(std::to_string(dropped_) + " triangles have two corners at one place; they are left out");
    return std::move(joined_);
  }

 private:
  void add(const ImportedMesh& mesh) {
    if (mesh.triangles.empty()) return;
    const std::uint8_t surface = find_surface(mesh.material);
    for (const auto& t : mesh.triangles) {
      std::array<Vec3f, 3> places{};
      for (std::size_t k = 0; k < 3; ++k) {
        if (t[k] >= mesh.positions.size()) refuse_mesh(path_, "has a face with a corner too many");
        places[k] = place_of(mesh, t[k]);
      }
      if (places[0] == places[1] || places[1] == places[2] || places[2] == places[0]) {
        ++dropped_;
        continue;
      }
      const Vec3f face = face_normal(places);
      std::array<std::uint32_t, 3> triangle{};
      std::array<PaintCorner, 3> paint{};
      for (std::size_t k = 0; k < 3; ++k) {
        triangle[k] = add_vertex(places[k], with_normals_ ? normal_of(mesh, t[k], face) : Vec3f());
        if (paints_.any()) paint[k] = paints_.corner(mesh, t[k]);
      }
      joined_.triangles.push_back(triangle);
      joined_.surfaces.push_back(surface);
      if (paints_.any()) joined_.paint_corners.push_back(paint);
    }
  }

  // Two materials of one name are two surfaces if they have two paints.
  std::uint8_t find_surface(int material) {
    const std::shared_ptr<const SurfacePaint> paint = paints_.of(material);
    // The name comes to be text of JSON.
    const std::string name = material < 0 ? "" : printable(scene_.materials[std::size_t(material)].name);
    for (std::size_t i = 0; i < joined_.surface_names.size(); ++i)
      if (joined_.surface_names[i] == name && joined_.paint_of(i) == paint.get()) return std::uint8_t(i);
    if (joined_.surface_names.size() == kMostSurfaces) refuse_mesh(path_, "has more than 256 materials");
    joined_.surface_names.push_back(name);
    if (paint) joined_.paints.push_back(paint);
    return std::uint8_t(joined_.surface_names.size() - 1);
  }

  Vec3f place_of(const ImportedMesh& mesh, std::uint32_t i) const {
    const Vec3f p(turn_up(mesh.positions[i], frame_.up) * frame_.metres_per_unit);
    if (!is_finite(p))
      refuse_mesh(path_, "has a vertex that is not a number: vertex " + std::to_string(i) + " (from 0) of its mesh " +
                             std::to_string(&mesh - scene_.meshes.data()) + " (from 0)",
                  "export without it, or repair the mesh in a modeller");
    return p;
  }

  // Up for a triangle without area.
  static Vec3f face_normal(const std::array<Vec3f, 3>& p) {
    const Vec3f n(normalized(cross(Vec3(p[1]) - Vec3(p[0]), Vec3(p[2]) - Vec3(p[0]))));
    return is_finite(n) && dot(n, n) > 0.5f ? n : Vec3f(0, 0, 1);
  }

  Vec3f normal_of(const ImportedMesh& mesh, std::uint32_t i, const Vec3f& face) {
    ++normals_;
    const Vec3f n(normalized(turn_up(Vec3(mesh.normals[i]), frame_.up)));
    if (is_finite(n) && dot(n, n) > 0.5f) return n;
    ++repaired_normals_;
    return face;
  }

  std::uint32_t add_vertex(const Vec3f& p, const Vec3f& n) {
    const auto [found, is_new] = numbers_.try_emplace(key_of(p, n), std::uint32_t(joined_.positions.size()));
    if (!is_new) return found->second;
    joined_.positions.push_back(p);
    if (with_normals_) joined_.normals.push_back(n);
    return found->second;
  }

  ImportedScene& scene_;
  const std::string& path_;
  FileFrame frame_;
  MeshPaints& paints_;
  bool with_normals_ = true;
  std::size_t normals_ = 0, repaired_normals_ = 0, dropped_ = 0;
  TriangleMesh joined_;
  VertexNumbers numbers_;
};

constexpr double kCracks[] = {1e-6, 1e-5};  // of the diagonal
constexpr double kRounding = 4.0 / (1 << 23);  // of the largest coordinate: a few units in the last place

// Gives each position the first one within the tolerance, by cells of its size.
std::vector<Vec3f> snap(const TriangleMesh& mesh, double tolerance) {
  using Cell = std::array<std::int64_t, 3>;
  std::map<Cell, std::vector<Vec3f>> cells;
  std::vector<Vec3f> out;
  out.reserve(mesh.positions.size());
  const Vec3 origin = mesh.bounds().min;
  for (const Vec3f& p : mesh.positions) {
    const Vec3 at = (Vec3(p) - origin) * (1 / tolerance);
    const Cell own{std::int64_t(at.x), std::int64_t(at.y), std::int64_t(at.z)};
    const Vec3f* near = nullptr;
    for (std::int64_t i = 0; i < 27 && !near; ++i) {
      const auto found = cells.find({own[0] + i % 3 - 1, own[1] + i / 3 % 3 - 1, own[2] + i / 9 - 1});
      if (found == cells.end()) continue;
      for (const Vec3f& other : found->second)
        if (norm(Vec3(other) - Vec3(p)) <= tolerance) {
          near = &other;
          break;
        }
    }
    if (!near) cells[own].push_back(p);
    out.push_back(near ? *near : p);
  }
  return out;
}

// Of a mesh whose positions have moved: triangles that lost their area go.
TriangleMesh without_slivers(const TriangleMesh& mesh) {
  TriangleMesh out = mesh;
  out.triangles.clear(), out.surfaces.clear(), out.paint_corners.clear();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& v = mesh.triangles[t];
    const Vec3f &a = mesh.positions[v[0]], &b = mesh.positions[v[1]], &c = mesh.positions[v[2]];
    if (a == b || b == c || c == a) continue;
    out.triangles.push_back(v);
    out.surfaces.push_back(mesh.surfaces[t]);
    if (!mesh.paint_corners.empty()) out.paint_corners.push_back(mesh.paint_corners[t]);
  }
  return out;
}

}  // namespace

TriangleMesh join_meshes(ImportedScene& scene, const std::string& path, const FileFrame& frame, MeshPaints& paints) {
  return MeshJoiner(scene, path, frame, paints).join();
}

bool weld_cracks(TriangleMesh& mesh) {
  if (is_closed(mesh)) return false;
  const Aabb box = mesh.bounds();
  const double size = norm(box.max - box.min);
  double largest = 0;
  for (int i = 0; i < 3; ++i) largest = std::max({largest, std::fabs(box.min[i]), std::fabs(box.max[i])});
  for (const double share : kCracks) {
    const double tolerance = std::max(share * size, kRounding * largest);
    if (!(tolerance > 0) || tolerance > 1e-3 * size) return false;
    TriangleMesh welded = mesh;
    welded.positions = snap(mesh, tolerance);
    welded = without_slivers(welded);
    if (!is_closed(welded)) continue;
    mesh = std::move(welded);
    return true;
  }
  return false;
}

std::vector<std::vector<Vec3>> collect_parts(const ImportedScene& scene, const std::string& path, const FileFrame& frame) {
  struct Part {
    std::vector<Vec3> points;
    VertexNumbers seen;
  };
  std::map<int, Part> by_object;
  for (const ImportedMesh& mesh : scene.meshes) {
    if (mesh.positions.empty()) continue;
    Part& part = by_object[mesh.object];
    for (const Vec3& v : mesh.positions) {
      const Vec3f rounded(v);
      if (!is_finite(rounded)) refuse_mesh(path, "has a vertex that is not a number");
      if (part.seen.try_emplace(key_of(rounded, {}), 0).second)
        part.points.push_back(turn_up(Vec3(rounded), frame.up) * frame.metres_per_unit);
    }
  }
  std::vector<std::vector<Vec3>> parts;
  for (auto& [object, part] : by_object) {
    if (part.points.size() < 4)
      refuse_mesh(path, "object " + std::to_string(parts.size() + 1) + " has " + std::to_string(part.points.size()) +
                            " corner points; a convex part needs at least 4");
    parts.push_back(std::move(part.points));
  }
  if (parts.empty()) refuse_mesh(path, "holds no triangles");
  return parts;
}

}  // namespace rubble
