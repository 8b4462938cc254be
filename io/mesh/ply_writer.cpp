#include <algorithm>

#include <limits>

#include "io/base/atomic_file.h"
#include "io/base/little_endian.h"
#include "io/base/srgb.h"
#include "io/mesh/mesh_writers.h"
#include "kernel/base/error.h"

namespace rubble {
namespace {

// All is said of vertices, whose lists come last: some readers know no faces but plain ones.
std::string header(std::size_t vertices, std::size_t faces) {
  return "ply\nformat binary_little_endian 1.0\n"
         "comment Rubble: metres, right-handed, Z up; piece: number of the piece\n"
         "element vertex " +
         std::to_string(vertices) +
         "\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n"
         "property uchar green\nproperty uchar blue\nproperty int piece\nelement face " +
         std::to_string(faces) + "\nproperty list uchar int vertex_indices\nend_header\n";
}

// Of each vertex: that of the last face that it is a corner of.
std::vector<std::array<std::uint8_t, 3>> colours_of(const PileModel& model,
                                                    const TriangleMesh& mesh,
                                                    const WeldedMesh& welded) {
  std::vector<std::array<std::uint8_t, 3>> colours(welded.positions.size());
  for (std::size_t i = 0; i < welded.triangles.size(); ++i) {
    const std::size_t surface = welded.surfaces[i];
    const bool named = surface < mesh.surface_names.size();
    const Vec3f c = model.colour_of(named ? mesh.surface_names[surface] : "");
    for (const std::uint32_t v : welded.triangles[i])
      colours[v] = {srgb8_from_linear(double(c.x)), srgb8_from_linear(double(c.y)), srgb8_from_linear(double(c.z))};
  }
  return colours;
}

void put_vertices(std::string& bytes, const PileModel::Piece& piece, const WeldedMesh& welded,
                  const std::vector<std::array<std::uint8_t, 3>>& colours) {
  for (std::size_t v = 0; v < welded.positions.size(); ++v) {
    const Vec3f p = world_position(piece, welded.positions[v]);
    for (int i = 0; i < 3; ++i) put(bytes, p[i]);
    for (const std::uint8_t c : colours[v]) put(bytes, c);
    put(bytes, piece.number);
  }
}

}  // namespace

void write_ply(const std::string& path, const PileModel& model) {
  std::vector<WeldedMesh> welded;
  for (const PileModel::Type& type : model.types) welded.push_back(weld(*type.mesh));
  std::size_t vertices = 0, faces = 0;
  for (const PileModel::Piece& piece : model.pieces) {
    vertices += welded[piece.type].positions.size();
    faces += welded[piece.type].triangles.size();
  }
  if (vertices > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
    throw RunError("cannot write " + path + ": its indices hold at most 2^31 - 1 vertices");

  std::vector<std::vector<std::array<std::uint8_t, 3>>> colours;
  for (std::size_t i = 0; i < welded.size(); ++i)
    colours.push_back(colours_of(model, *model.types[i].mesh, welded[i]));

  AtomicFile file(path);
  file.write(header(vertices, faces));
  std::string bytes;
  for (const PileModel::Piece& piece : model.pieces) {
    bytes.clear();
    put_vertices(bytes, piece, welded[piece.type], colours[piece.type]);
    file.write(bytes);
  }
  std::uint32_t first = 0;
  for (const PileModel::Piece& piece : model.pieces) {
    bytes.clear();
    for (const auto& triangle : welded[piece.type].triangles) {
      put(bytes, std::uint8_t{3});
      for (const std::uint32_t v : triangle) put(bytes, first + v);
    }
    file.write(bytes);
    first += static_cast<std::uint32_t>(welded[piece.type].positions.size());
  }
  file.commit();
}

}  // namespace rubble
