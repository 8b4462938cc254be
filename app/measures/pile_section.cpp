#include "app/measures/pile_section.h"

#include <algorithm>

namespace rubble {
namespace {

struct Corner {
  Vec3 position, normal;  // in the world
  PaintCorner paint;
};

class Cutter {
 public:
  Cutter(const SceneInstance& instance, const TriangleMesh& mesh, double y)
      : instance_(instance), mesh_(mesh), y_(y) {
    cut_.surface_names = mesh.surface_names, cut_.paints = mesh.paints;
    face_.instance = instance.id;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) add(t);
  }
  TriangleMesh& mesh() { return cut_; }
  CutFace& face() { return face_; }

 private:
  Corner corner(std::size_t t, std::size_t i) const {
    const std::uint32_t v = mesh_.triangles[t][i];
    const Pose& pose = instance_.world_from_body;
    Corner c{pose * (Vec3(mesh_.positions[v]) * double(instance_.scale)), {}, {}};
    if (!mesh_.paint_corners.empty()) c.paint = mesh_.paint_corners[t][i];
    if (!mesh_.normals.empty()) c.normal = pose.rotation.rotate(Vec3(mesh_.normals[v]));
    return c;
  }

  // What of a triangle is behind the plane (Sutherland and Hodgman 1974, for one plane), and the
  // segment along which it was cut.
  void add(std::size_t t) {
    std::vector<Corner> kept;
    std::vector<Vec3> crossings;
    for (int i = 0; i < 3; ++i) {
      const Corner a = corner(t, std::size_t(i)), b = corner(t, std::size_t((i + 1) % 3));
      const bool a_behind = a.position.y > y_, b_behind = b.position.y > y_;
      if (a_behind) kept.push_back(a);
      if (a_behind == b_behind) continue;
      const double s = (y_ - a.position.y) / (b.position.y - a.position.y);
      kept.push_back({a.position + (b.position - a.position) * s,
                      normalized(a.normal + (b.normal - a.normal) * s), between(a.paint, b.paint, float(s))});
      crossings.push_back(kept.back().position);
    }
    if (crossings.size() == 2)
      face_.segments.push_back({crossings[0].x, crossings[0].z, crossings[1].x, crossings[1].z});
    const auto first = std::uint32_t(cut_.positions.size());
    for (const Corner& c : kept) {
      cut_.positions.push_back(Vec3f(c.position));
      if (!mesh_.normals.empty()) cut_.normals.push_back(Vec3f(c.normal));
    }
    for (std::uint32_t k = 2; k < kept.size(); ++k) {
      cut_.triangles.push_back({first, first + k - 1, first + k});
      cut_.surfaces.push_back(mesh_.surfaces[t]);
      if (!mesh_.paint_corners.empty())
        cut_.paint_corners.push_back({kept[0].paint, kept[k - 1].paint, kept[k].paint});
    }
  }

  const SceneInstance& instance_;
  const TriangleMesh& mesh_;
  double y_;
  TriangleMesh cut_;
  CutFace face_;
};

Aabb box_of(const SceneInstance& instance, const TriangleMesh& mesh) {
  Aabb box;
  for (const Vec3f& p : mesh.positions)
    box.include(instance.world_from_body * (Vec3(p) * double(instance.scale)));
  return box;
}

}  // namespace

PileSection cut_pile(const Scene& scene, double y) {
  PileSection section;
  section.scene = scene;
  section.scene.instances.clear();
  section.x0 = 1e9, section.x1 = -1e9;
  for (const SceneInstance& instance : scene.instances) {
    const TriangleMesh& mesh = scene.meshes[instance.mesh]->levels.front();
    const Aabb box = box_of(instance, mesh);
    if (box.max.y <= y) continue;
    section.x0 = std::min(section.x0, box.min.x);
    section.x1 = std::max(section.x1, box.max.x);
    section.top = std::max(section.top, box.max.z);
    section.scene.instances.push_back(instance);
    if (box.min.y >= y) continue;
    Cutter cutter(instance, mesh, y);
    auto cut = std::make_shared<SceneMesh>();
    cut->levels.push_back(std::move(cutter.mesh()));
    SceneInstance& left = section.scene.instances.back();
    left.mesh = std::uint32_t(section.scene.meshes.size());
    left.scale = 1;
    left.world_from_body = {};
    section.scene.meshes.push_back(std::move(cut));
    section.faces.push_back(std::move(cutter.face()));
  }
  return section;
}

std::vector<double> find_insides(const CutFace& face, double z) {
  std::vector<double> x;
  for (const CutSegment& s : face.segments)
    if ((s.z0 > z) != (s.z1 > z)) x.push_back(s.x0 + (s.x1 - s.x0) * (z - s.z0) / (s.z1 - s.z0));
  std::sort(x.begin(), x.end());
  if (x.size() % 2) x.pop_back();
  return x;
}

}  // namespace rubble
