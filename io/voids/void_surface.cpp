#include "io/voids/void_surface.h"

#include <openvdb/openvdb.h>
#include <openvdb/tools/Filter.h>
#include <openvdb/tools/VolumeToMesh.h>

#include <algorithm>
#include <mutex>
#include <numeric>
#include <tuple>

#include "io/atomic_file.h"

namespace rubble {

namespace {

// OpenVDB's threads leave points and faces in any order: into one that is always the same.
void put_in_order(TriangleMesh& mesh) {
  std::vector<std::uint32_t> order(mesh.positions.size()), place(order.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const Vec3f &p = mesh.positions[a], &q = mesh.positions[b];
    return std::tie(p.z, p.y, p.x) < std::tie(q.z, q.y, q.x);
  });
  std::vector<Vec3f> positions;
  for (std::size_t i = 0; i < order.size(); ++i) {
    place[order[i]] = std::uint32_t(i);
    positions.push_back(mesh.positions[order[i]]);
  }
  mesh.positions = std::move(positions);
  for (auto& t : mesh.triangles) {
    for (std::uint32_t& corner : t) corner = place[corner];
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  }
  std::sort(mesh.triangles.begin(), mesh.triangles.end());
}

}  // namespace

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
  put_in_order(mesh);
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
