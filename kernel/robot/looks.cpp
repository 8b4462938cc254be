#include "kernel/robot/looks.h"

#include "kernel/geometry/hull.h"

namespace rubble {

TriangleMesh make_link_mesh(const RobotLink& link, const std::string& surface) {
  if (!link.looks.triangles.empty()) return link.looks;
  TriangleMesh mesh;
  mesh.surface_names = {surface};
  for (const ConvexPart& part : link.parts) {
    const Hull hull = calc_hull(part.points);
    for (const std::vector<int>& face : hull.faces) {
      // Corners of its own for each face: its edges are sharp.
      const std::uint32_t first = std::uint32_t(mesh.positions.size());
      for (int corner : face) mesh.positions.push_back(Vec3f(hull.points[std::size_t(corner)]));
      for (std::uint32_t k = 2; k < face.size(); ++k) {
        mesh.triangles.push_back({first, first + k - 1, first + k});
        mesh.surfaces.push_back(0);
      }
    }
  }
  return mesh;
}

std::string choose_link_surface(const RobotModel& model, std::size_t index) {
  const RobotLink& link = model.links[index];
  if (norm(link.belt_axis) > 0 || link.name.find("wheel") != std::string::npos) return "rubber";
  if (index == 0) return "car_paint";
  return "steel_galvanised";
}

}  // namespace rubble
