#include "render/geometry/mesh_refine.h"

#include <cstring>
#include <map>
#include <tuple>

namespace rubble {

namespace {

using VertexKey = std::tuple<float, float, float, int, int, int>;

// Merges vertices with equal position and (nearly) equal normal.
class Welder {
 public:
  explicit Welder(TriangleMesh& out) : out_(out) {}

  std::uint32_t add(const Vec3f& p, const Vec3f& n) {
    const auto step = [](float v) { return int(std::lround(v * 128.0f)); };
    // + 0.0f turns -0 into 0, which compare equal but would print as different keys.
    const VertexKey key{p.x + 0.0f, p.y + 0.0f, p.z + 0.0f, step(n.x), step(n.y), step(n.z)};
    const auto [at, added] = index_.emplace(key, std::uint32_t(out_.positions.size()));
    if (added) out_.positions.push_back(p), out_.normals.push_back(n);
    return at->second;
  }

 private:
  TriangleMesh& out_;
  std::map<VertexKey, std::uint32_t> index_;
};

TriangleMesh weld(const TriangleMesh& mesh) {
  TriangleMesh out;
  out.surface_names = mesh.surface_names, out.paints = mesh.paints;
  Welder welder(out);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& tri = mesh.triangles[t];
    const Vec3f p[3] = {mesh.positions[tri[0]], mesh.positions[tri[1]], mesh.positions[tri[2]]};
    const Vec3f face = normalized(cross(p[1] - p[0], p[2] - p[0]));
    if (dot(face, face) == 0) continue;
    std::array<std::uint32_t, 3> welded;
    for (int k = 0; k < 3; ++k)
      welded[std::size_t(k)] =
          welder.add(p[k], mesh.normals.empty() ? face : mesh.normals[tri[std::size_t(k)]]);
    out.triangles.push_back(welded);
    out.surfaces.push_back(mesh.surfaces.empty() ? std::uint8_t(0) : mesh.surfaces[t]);
    if (!mesh.paint_corners.empty()) out.paint_corners.push_back(mesh.paint_corners[t]);
  }
  return out;
}

struct Corner {
  std::uint32_t vertex;
  PaintCorner paint;
};

// One round: every edge that is too long is halved.
class Halver {
 public:
  Halver(TriangleMesh& mesh, float longest) : mesh_(mesh), limit_(longest * longest) {}

  bool run() {
    const auto triangles = std::move(mesh_.triangles);
    const auto surfaces = std::move(mesh_.surfaces);
    const auto paint = std::move(mesh_.paint_corners);
    mesh_.triangles.clear(), mesh_.surfaces.clear(), mesh_.paint_corners.clear();
    painted_ = !paint.empty();
    bool cut = false;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      surface_ = surfaces[t];
      std::array<Corner, 3> corners;
      for (std::size_t i = 0; i < 3; ++i)
        corners[i] = {triangles[t][i], painted_ ? paint[t][i] : PaintCorner()};
      cut |= divide(corners);
    }
    return cut;
  }

 private:
  bool too_long(const Corner& a, const Corner& b) const {
    const Vec3f d = mesh_.positions[a.vertex] - mesh_.positions[b.vertex];
    return dot(d, d) > limit_;
  }
  std::uint32_t middle(std::uint32_t a, std::uint32_t b) {
    const auto key = a < b ? std::make_pair(a, b) : std::make_pair(b, a);
    const auto [at, added] = middles_.emplace(key, std::uint32_t(mesh_.positions.size()));
    if (added) {
      mesh_.positions.push_back((mesh_.positions[a] + mesh_.positions[b]) * 0.5f);
      const Vec3f sum = mesh_.normals[a] + mesh_.normals[b];  // nothing where they are opposed
      mesh_.normals.push_back(dot(sum, sum) > 1e-8f ? normalized(sum) : mesh_.normals[a]);
    }
    return at->second;
  }
  Corner middle(const Corner& a, const Corner& b) {
    return {middle(a.vertex, b.vertex), between(a.paint, b.paint, 0.5f)};
  }
  void emit(const Corner& a, const Corner& b, const Corner& c) {
    mesh_.triangles.push_back({a.vertex, b.vertex, c.vertex});
    mesh_.surfaces.push_back(surface_);
    if (painted_) mesh_.paint_corners.push_back({a.paint, b.paint, c.paint});
  }
  bool divide(std::array<Corner, 3> t) {
    // Turn the triangle until the pattern of long edges is one of four.
    const auto pattern = [&] {
      return int(too_long(t[0], t[1])) + 2 * int(too_long(t[1], t[2])) +
             4 * int(too_long(t[2], t[0]));
    };
    int which = pattern();
    while (which == 2 || which == 4 || which == 6 || which == 5) {
      t = {t[1], t[2], t[0]};
      which = pattern();
    }
    const auto& [a, b, c] = t;
    if (which == 0) return emit(a, b, c), false;
    const Corner ab = middle(a, b);
    if (which == 1) return emit(a, ab, c), emit(ab, b, c), true;
    const Corner bc = middle(b, c);
    if (which == 3) return emit(ab, b, bc), emit(a, ab, c), emit(ab, bc, c), true;
    const Corner ca = middle(c, a);
    emit(a, ab, ca), emit(ab, b, bc), emit(ca, bc, c), emit(ab, bc, ca);
    return true;
  }

  TriangleMesh& mesh_;
  float limit_;
  std::uint8_t surface_ = 0;
  bool painted_ = false;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles_;
};

}  // namespace

TriangleMesh refine_mesh(const TriangleMesh& mesh, float longest_edge) {
  TriangleMesh out = weld(mesh);
  while (Halver(out, longest_edge).run()) {
  }
  return out;
}

}  // namespace rubble
