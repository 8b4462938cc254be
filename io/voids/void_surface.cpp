#include "io/voids/void_surface.h"

#include <openvdb/openvdb.h>
#include <openvdb/tools/Filter.h>
#include <openvdb/tools/VolumeToMesh.h>

#include <mutex>

#include "io/atomic_file.h"

namespace rubble {

TriangleMesh make_void_surface(const VoidSpace& space, const Void& v) {
  static std::once_flag once;
  std::call_once(once, [] { openvdb::initialize(); });
  auto grid = openvdb::FloatGrid::create(0.0f);
  auto accessor = grid->getAccessor();
  // Cells around the void are made active as well, so that smoothing reaches them.
  for (const std::uint32_t i : v.cells) {
    const Cell c = space.grid.cell(i);
    for (int dz = -1; dz <= 1; ++dz)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
          const openvdb::Coord at(c[0] + dx, c[1] + dy, c[2] + dz);
          accessor.setValueOn(at, accessor.getValue(at));
        }
    accessor.setValue({c[0], c[1], c[2]}, 1.0f);
  }
  openvdb::tools::Filter<openvdb::FloatGrid> filter(*grid);
  filter.mean(1, 1);

  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec4I> quads;
  openvdb::tools::volumeToMesh(*grid, points, quads, 0.5);
  TriangleMesh mesh;
  for (const openvdb::Vec3s& p : points) {
    mesh.positions.push_back(
        Vec3f(space.grid.corner + Vec3{p.x() + 0.5, p.y() + 0.5, p.z() + 0.5} * space.grid.voxel));
  }
  // Values are high inside, so OpenVDB's faces look inwards: they are turned round.
  for (const openvdb::Vec4I& q : quads) {
    mesh.triangles.push_back({q[2], q[1], q[0]});
    mesh.triangles.push_back({q[3], q[2], q[0]});
  }
  return mesh;
}

void write_ply(const std::string& path, const TriangleMesh& mesh) {
  AtomicFile file(path);
  file.write("ply\nformat binary_little_endian 1.0\nelement vertex " +
             std::to_string(mesh.positions.size()) +
             "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
             std::to_string(mesh.triangles.size()) +
             "\nproperty list uchar uint vertex_indices\nend_header\n");
  static_assert(sizeof(Vec3f) == 12, "three floats without padding");
  file.write(mesh.positions.data(), mesh.positions.size() * sizeof(Vec3f));
  for (const auto& t : mesh.triangles) {
    const std::uint8_t corners = 3;
    file.write(&corners, 1);
    file.write(t.data(), sizeof t);
  }
  file.commit();
}

}  // namespace rubble
