// Notices a camera or another sensor that flies through solid matter, or below the ground: it sees the inside of a wall, or
// through it.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "app/assets/asset_library.h"
#include "kernel/model/pile_state.h"

namespace rubble {

// All that is solid: pieces, terrain, fines, the ground z = 0, and of surroundings what has an inside (no leaves, no skyline).
// Inside of a closed mesh is where its winding number is 1, not 0 (Jacobson, Kavan and Sorkine-Hornung 2013).
class SolidMatter {
 public:
  // Both must outlive it.
  SolidMatter(const AssetLibrary& assets, const PileState& pile);

  // A sentence that names the first of the positions (world; unit: m; one a frame) that is inside of something, that thing,
  // and how many there are; nothing: none is. who: "the camera", or another sensor. rides: a robot carries it.
  std::optional<std::string> warn_of(const std::string& who, const std::vector<Vec3>& positions, bool rides = false) const;

 private:
  struct Body {
    const TriangleMesh* mesh = nullptr;
    const Aabb* box = nullptr;  // of the mesh
    Pose world_from_mesh;
    double scale = 1;
    bool is_ground = false;  // a sheet without a floor
    double least_winding = 0.5;  // of a point inside
    std::string what;        // as part of a sentence
  };
  const Aabb* box_of(const TriangleMesh& mesh) { return &boxes_.emplace_back(mesh.bounds()); }
  void add_pieces(const AssetLibrary& assets, const PileState& pile);
  void add_fines(const PileState& pile);
  void add_surroundings(const Surroundings& surroundings);
  // What a point is inside of, as part of a sentence; "": nothing.
  std::string describe(const Vec3& point) const;

  std::deque<Aabb> boxes_;  // addresses stay
  std::vector<Body> bodies_;
};

// 1 inside of a closed mesh whose triangles face outwards, 0 outside.
double calc_winding_number(const TriangleMesh& mesh, const Vec3& point);

}  // namespace rubble
