#include "io/voids/void_files.h"

#include <openvdb/openvdb.h>
#include <openvdb/tools/Prune.h>
#include <openvdb/tools/VolumeToMesh.h>

#include <algorithm>
#include <array>
#include <mutex>
#include <numeric>
#include <tuple>

#include "io/base/atomic_file.h"
#include "kernel/base/hash.h"

namespace rubble {

namespace {

// 1 in the void and 0 outside, averaged over 3 x 3 x 3 voxels.
openvdb::FloatGrid::Ptr make_grid(const VoxelGrid& voxels, const Void& v) {
  auto grid = openvdb::FloatGrid::create(0.0f);
  auto accessor = grid->getAccessor();
  for (const std::uint32_t i : v.cells) {
    const Cell c = voxels.cell(i);
    for (int dz = -1; dz <= 1; ++dz)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
          const openvdb::Coord at(c[0] + dx, c[1] + dy, c[2] + dz);
          accessor.setValue(at, accessor.getValue(at) + 1.0f / 27);
        }
  }
  return grid;
}

// OpenVDB's threads leave points and faces in any order: into one that is always the same. Returns
// where each point has gone.
std::vector<std::uint32_t> put_in_order(std::vector<Vec3f>& positions) {
  std::vector<std::uint32_t> order(positions.size()), place(order.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const Vec3f &p = positions[a], &q = positions[b];
    return std::tie(p.z, p.y, p.x) < std::tie(q.z, q.y, q.x);
  });
  std::vector<Vec3f> ordered;
  ordered.reserve(positions.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    place[order[i]] = std::uint32_t(i);
    ordered.push_back(positions[order[i]]);
  }
  positions = std::move(ordered);
  return place;
}

// Values are high inside, so OpenVDB's faces look inwards: they are turned round.
void add_faces(const openvdb::tools::PolygonPoolList& pools, std::size_t pool_count, const std::vector<std::uint32_t>& place,
               TriangleMesh& mesh) {
  std::size_t quads = 0;
  for (std::size_t pool = 0; pool < pool_count; ++pool) quads += pools[pool].numQuads();
  mesh.triangles.reserve(2 * quads);
  for (std::size_t pool = 0; pool < pool_count; ++pool)
    for (std::size_t i = 0; i < pools[pool].numQuads(); ++i) {
      const openvdb::Vec4I& quad = pools[pool].quad(i);
      std::array<std::uint32_t, 4> q{place[quad[3]], place[quad[2]], place[quad[1]], place[quad[0]]};
      std::rotate(q.begin(), std::min_element(q.begin(), q.end()), q.end());
      mesh.triangles.push_back({q[0], q[1], q[2]});
      mesh.triangles.push_back({q[0], q[2], q[3]});
    }
  std::sort(mesh.triangles.begin(), mesh.triangles.end());
}

constexpr const char* kBegin = "ply\nformat binary_little_endian 1.0\ncomment pile state ";

}  // namespace

TriangleMesh make_void_surface(const VoidSpace& space, const Void& v) {
  static std::once_flag once;
  std::call_once(once, [] { openvdb::initialize(); });
  openvdb::FloatGrid::Ptr grid = make_grid(space.grid, v);
  openvdb::tools::prune(grid->tree());  // what is deep inside takes no memory
  openvdb::tools::VolumeToMesh mesher(0.5);
  mesher(*grid);
  grid.reset();  // as the points below: those of a large void fill the memory
  TriangleMesh mesh;
  mesh.positions.reserve(mesher.pointListSize());
  for (std::size_t i = 0; i < mesher.pointListSize(); ++i) {
    const openvdb::Vec3s& p = mesher.pointList()[i];
    mesh.positions.push_back(
        Vec3f(space.grid.corner + Vec3{p.x() + 0.5, p.y() + 0.5, p.z() + 0.5} * space.grid.voxel));
  }
  mesher.pointList().reset();
  add_faces(mesher.polygonPoolList(), mesher.polygonPoolListSize(), put_in_order(mesh.positions), mesh);
  return mesh;
}

void write_void_surface(const std::string& path, const TriangleMesh& mesh, std::uint64_t pile_state) {
  AtomicFile file(path);
  file.write(kBegin + hex64(pile_state) + "\nelement vertex " +
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

bool is_void_surface_of(const std::string& path, std::uint64_t pile_state) {
  const std::string begin = kBegin + hex64(pile_state) + "\n";
  return read_whole_file(path).compare(0, begin.size(), begin) == 0;
}

}  // namespace rubble
