#include "app/planning/camera_inside.h"

#include <cstdio>
#include <limits>

#include "kernel/base/portable_math.h"

namespace rubble {
namespace {

constexpr double kInside = 0.5;

bool contains(const Aabb& box, const Vec3& p, int axes) {
  for (int i = 0; i < axes; ++i)
    if (p[i] < box.min[i] || p[i] > box.max[i]) return false;
  return true;
}

// The solid angle of a triangle seen from the origin, over 4 pi (Van Oosterom and Strackee 1983).
double share_of_sphere(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double la = norm(a), lb = norm(b), lc = norm(c);
  const double over = dot(a, cross(b, c));
  const double under = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
  if (over == 0 && under == 0) return 0;
  return portable::atan2(over, under) / (2 * portable::kPi);
}

}  // namespace

double calc_winding_number(const TriangleMesh& mesh, const Vec3& point) {
  double sum = 0;
  for (const auto& t : mesh.triangles)
    sum += share_of_sphere(Vec3(mesh.positions[t[0]]) - point, Vec3(mesh.positions[t[1]]) - point,
                           Vec3(mesh.positions[t[2]]) - point);
  return sum;
}

namespace {

// All that a camera may not be inside of: the pieces, the ground and the terrain.
class SolidParts {
 public:
  SolidParts(const AssetLibrary& assets, const PileState& pile) : pile_(pile), meshes_(assets.finest_meshes()) {
    for (const TriangleMesh* mesh : meshes_) boxes_.push_back(mesh->bounds());
    is_terrain_.resize(meshes_.size());
    for (const int type : assets.terrain()) is_terrain_[std::size_t(type)] = true;
  }

  // What a point is inside of, as part of a sentence; "": nothing.
  std::string describe(const Vec3& point) const {
    for (std::size_t i = 0; i < pile_.pieces.size(); ++i) {
      const PieceState& piece = pile_.pieces[i];
      const auto type = std::size_t(piece.type);
      if (piece.status == PieceStatus::lost || type >= meshes_.size()) continue;
      const Vec3 local = piece.world_from_body.inverse() * point * (1 / piece.scale);
      if (is_terrain_[type]) {
        if (is_below(type, local)) return "below the ground";
      } else if (contains(boxes_[type], local, 3) && calc_winding_number(*meshes_[type], local) >= kInside) {
        return "inside piece " + std::to_string(i) + " (" + pile_.types[type] + ")";
      }
    }
    return point.z < 0 ? "below the ground" : "";
  }

 private:
  // A terrain is a surface without a floor. A point is below it where what is next above faces up; the ceiling of a cave
  // faces down.
  bool is_below(std::size_t type, const Vec3& local) const {
    if (!contains(boxes_[type], local, 2) || local.z >= boxes_[type].max.z) return false;
    const TriangleMesh& mesh = *meshes_[type];
    double nearest = std::numeric_limits<double>::infinity();
    bool faces_up = false;
    for (const auto& t : mesh.triangles) {
      const Vec3 a = Vec3(mesh.positions[t[0]]) - local, b = Vec3(mesh.positions[t[1]]) - local, c = Vec3(mesh.positions[t[2]]) - local;
      const double u = b.x * c.y - b.y * c.x, v = c.x * a.y - c.y * a.x, w = a.x * b.y - a.y * b.x;
      if (!(u >= 0 && v >= 0 && w >= 0) && !(u <= 0 && v <= 0 && w <= 0)) continue;
      const double area = u + v + w;  // twice that of the triangle seen from above; positive: it faces up
      const double height = (a.z * u + b.z * v + c.z * w) / area;
      if (area != 0 && height > 0 && height < nearest) nearest = height, faces_up = area > 0;
    }
    return faces_up;
  }

  const PileState& pile_;
  const std::vector<const TriangleMesh*> meshes_;
  std::vector<Aabb> boxes_;
  std::vector<bool> is_terrain_;
};

}  // namespace

std::optional<std::string> find_camera_inside(const AssetLibrary& assets, const PileState& pile,
                                              const std::vector<Vec3>& positions, const std::string& who) {
  const SolidParts solid(assets, pile);
  std::size_t frames = 0, first = 0;
  std::string where;
  for (std::size_t f = 0; f < positions.size(); ++f) {
    const std::string found = solid.describe(positions[f]);
    if (found.empty()) continue;
    if (frames++ == 0) first = f, where = found;
  }
  if (frames == 0) return std::nullopt;
  const Vec3& at = positions[first];
  char place[96];
  std::snprintf(place, sizeof place, "{%.2f, %.2f, %.2f}", at.x, at.y, at.z);
  return who + " is " + where + " at frame " + std::to_string(first) + ", " + place +
         ", and inside a piece or below the ground at " + std::to_string(frames) + " of " + std::to_string(positions.size()) +
         " frames: move its path, or fly with trajectory.plan = \"avoid\"";
}

}  // namespace rubble
