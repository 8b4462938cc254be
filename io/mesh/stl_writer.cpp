// A writer of our own rather than assimp's: that one wants the whole scene in memory once more, and
// here hundreds of thousands of triangles pass through a small buffer in a fixed order.
#include "io/mesh/stl_writer.h"

#include <limits>

#include "io/base/atomic_file.h"
#include "io/base/little_endian.h"
#include "kernel/base/error.h"

namespace rubble {
namespace {

constexpr std::size_t kHeaderSize = 80;  // must not begin with "solid": that means text
constexpr char kHeader[] = "Binary STL by Rubble: metres, right-handed, Z up";

Vec3f to_world(const MeshInstance& instance, std::uint32_t vertex) {
  return Vec3f(instance.world_from_body *
               (Vec3(instance.mesh->positions[vertex]) * instance.scale));
}

void put_vector(std::string& bytes, const Vec3f& v) {
  for (int i = 0; i < 3; ++i) put(bytes, v[i]);
}

void put_triangle(std::string& bytes, const Vec3f& a, const Vec3f& b, const Vec3f& c) {
  put_vector(bytes, Vec3f(normalized(cross(Vec3(b) - Vec3(a), Vec3(c) - Vec3(a)))));
  put_vector(bytes, a);
  put_vector(bytes, b);
  put_vector(bytes, c);
  put(bytes, std::uint16_t{0});
}

std::string make_header(std::uint64_t triangles) {
  std::string bytes(kHeader);
  bytes.resize(kHeaderSize, ' ');
  put(bytes, static_cast<std::uint32_t>(triangles));
  return bytes;
}

void put_triangles(std::string& bytes, const MeshInstance& instance) {
  std::vector<Vec3f> world;
  world.reserve(instance.mesh->positions.size());
  for (std::uint32_t v = 0; v < instance.mesh->positions.size(); ++v) world.push_back(to_world(instance, v));
  for (const auto& t : instance.mesh->triangles) put_triangle(bytes, world[t[0]], world[t[1]], world[t[2]]);
}

}  // namespace

std::string stl_bytes(const TriangleMesh& mesh) {
  std::string bytes = make_header(mesh.triangles.size());
  put_triangles(bytes, {&mesh, 1, {}});
  return bytes;
}

void write_stl(const std::string& path, const std::vector<MeshInstance>& instances) {
  std::uint64_t count = 0;
  for (const MeshInstance& instance : instances) count += instance.mesh->triangles.size();
  if (count > std::numeric_limits<std::uint32_t>::max()) {
    throw RunError("cannot write " + path + ": STL holds at most 2^32 - 1 triangles");
  }
  AtomicFile file(path);
  file.write(make_header(count));
  for (const MeshInstance& instance : instances) {
    std::string bytes;
    put_triangles(bytes, instance);
    file.write(bytes);
  }
  file.commit();
}

}  // namespace rubble
