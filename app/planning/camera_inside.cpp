#include "app/planning/camera_inside.h"

#include <cstdio>

#include "kernel/base/portable_math.h"

namespace rubble {
namespace {

constexpr double kInside = 0.5;

bool contains(const Aabb& box, const Vec3& p) {
  for (int i = 0; i < 3; ++i)
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

std::optional<std::string> find_camera_inside(const AssetLibrary& assets, const PileState& pile,
                                              const std::vector<Vec3>& positions) {
  const std::vector<const TriangleMesh*> meshes = assets.finest_meshes();
  std::vector<Aabb> boxes;
  for (const TriangleMesh* mesh : meshes) boxes.push_back(mesh->bounds());
  std::size_t frames = 0, first = 0, first_piece = 0;
  for (std::size_t f = 0; f < positions.size(); ++f)
    for (std::size_t i = 0; i < pile.pieces.size(); ++i) {
      const PieceState& piece = pile.pieces[i];
      const auto type = std::size_t(piece.type);
      if (piece.status == PieceStatus::lost || type >= meshes.size()) continue;
      const Vec3 local = piece.world_from_body.inverse() * positions[f] * (1 / piece.scale);
      if (!contains(boxes[type], local) || calc_winding_number(*meshes[type], local) < kInside)
        continue;
      if (frames++ == 0) first = f, first_piece = i;
      break;
    }
  if (frames == 0) return std::nullopt;
  const PieceState& piece = pile.pieces[first_piece];
  const Vec3& at = positions[first];
  char place[96];
  std::snprintf(place, sizeof place, "{%.2f, %.2f, %.2f}", at.x, at.y, at.z);
  return "the camera is inside piece " + std::to_string(first_piece) + " (" +
         pile.types[std::size_t(piece.type)] + ") at frame " + std::to_string(first) + ", " + place +
         ", and inside a piece at " + std::to_string(frames) + " of " +
         std::to_string(positions.size()) +
         " frames: move its path, or fly with trajectory.plan = \"avoid\"";
}

}  // namespace rubble
