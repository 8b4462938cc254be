#include "io/mesh/mesh_file.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>

#include "io/import/imported_scene.h"
#include "io/import/mesh_join.h"
#include "io/import/mesh_paint.h"
#include "io/import/mesh_winding.h"
#include "io/mesh/mesh_bytes.h"
#include "io/mesh_formats/scene_reader.h"
#include "kernel/base/error.h"
#include "kernel/base/number_text.h"
#include "kernel/base/system/file_sandbox.h"
#include "kernel/base/system/isolated_worker.h"

// Importers are called in child processes alone: kernel/base/system/isolated_worker.h says why.

namespace rubble {
namespace {

void check_readable(const std::string& path) {
  namespace fs = std::filesystem;
  check_may_read(path);
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) refuse_mesh(path, "the mesh file does not exist");
  if (!fs::is_regular_file(status)) refuse_mesh(path, "is not a file");
  if (fs::file_size(path, error) == 0) refuse_mesh(path, "the mesh file is empty");
}

void check_units(const MeshUnits& units, const std::string& path) {
  if (units.metres_per_unit > 0 && std::isfinite(units.metres_per_unit)) return;
  refuse_mesh(path, "the mesh needs a positive unit, not " + plain_text(units.metres_per_unit));
}

// What the file states of its own axes counts before `up`.
FileFrame frame_of(const ImportedScene& scene, const MeshUnits& units) {
  FileFrame frame{units.metres_per_unit, units.up == UpAxis::y ? FileUp::y : FileUp::z};
  if (scene.up && units.heed_stated_axis) frame.up = *scene.up;
  return frame;
}

// Corners may be rounded by this share of the mesh's size; by more than `kCoarse`, only by `kCoarseShare` of it.
constexpr double kRoundedAway = 1e-3, kCoarseShare = 1e-5;
constexpr double kCoarse = 1e-3;  // unit: m

constexpr double kLargestMesh = 1e6;  // unit: m

// Far from the origin single precision rounds corners to places that make another shape.
void check_place(const TriangleMesh& mesh, const std::string& path) {
  const Aabb box = mesh.bounds();
  const Vec3 size = box.max - box.min, far = max(box.max, -box.min);
  const double longest = std::max({size.x, size.y, size.z}), farthest = std::max({far.x, far.y, far.z});
  if (!(longest <= kLargestMesh))
    throw InputError({path, 0, "", "is too large", "at most 1000 km", brief_text(longest) + " m", "are its `units` right?"});
  const double rounding = farthest * double(std::numeric_limits<float>::epsilon());
  if (rounding <= kRoundedAway * longest && (rounding <= kCoarse || rounding <= kCoarseShare * longest)) return;
  char found[160], hint[160];
  std::snprintf(found, sizeof found, "a mesh of %.3g m at up to %.6g m, where corners are rounded to %.2g m", longest,
                farthest, rounding);
  const Vec3 middle = (box.min + box.max) * 0.5;
  std::snprintf(hint, sizeof hint, "subtract about (%.0f, %.0f, %.0f) m from its corners before it is exported", middle.x,
                middle.y, middle.z);
  throw InputError({path, 0, "", "lies too far from its origin", "corners near the origin, not in map coordinates", found,
                    hint});
}

TriangleMesh import_mesh(const std::string& path, const MeshUnits& units, MeshNotes& notes) {
  ImportedScene scene = read_scene(path);
  MeshPaints paints(scene, path);
  TriangleMesh mesh = join_meshes(scene, path, frame_of(scene, units), paints);
  check_place(mesh, path);
  weld_cracks(mesh);
  const std::string turned = agree_on_outside(mesh);
  if (!turned.empty()) scene.note(turned);
  notes.shape = scene.notes;
  notes.looks = paints.notes();
  return mesh;
}

std::vector<std::vector<Vec3>> import_convex_parts(const std::string& path, const MeshUnits& units) {
  const ImportedScene scene = read_scene(path);
  return collect_parts(scene, path, frame_of(scene, units));
}

constexpr char kMesh = 'm', kParts = 'p';  // what is asked for

std::string pack_request(char kind, const std::string& path, const MeshUnits& units) {
  CacheWriter writer;
  writer.put(kind);
  writer.put(units.metres_per_unit);
  writer.put(units.up);
  writer.put(units.heed_stated_axis);
  return writer.bytes() + path;
}

std::string answer_request(const std::string& request) {
  char kind = 0;
  MeshUnits units;
  const std::size_t size = sizeof kind + sizeof units.metres_per_unit + sizeof units.up + sizeof units.heed_stated_axis;
  CacheReader reader(std::string_view(request).substr(0, size));
  reader.get(kind);
  reader.get(units.metres_per_unit);
  reader.get(units.up);
  reader.get(units.heed_stated_axis);
  const std::string path = request.substr(size);
  if (kind == kParts) return parts_to_bytes(import_convex_parts(path, units));
  MeshNotes notes;
  const TriangleMesh mesh = import_mesh(path, units, notes);
  return mesh_to_bytes(mesh, notes);
}

}  // namespace

MeshImporter::MeshImporter() : worker_(std::make_unique<IsolatedWorker>("mesh", answer_request)) {}

MeshImporter::~MeshImporter() = default;

std::string MeshImporter::ask(char kind, const std::string& path, const MeshUnits& units) {
  check_units(units, path);
  check_readable(path);
  return worker_->ask(path, pack_request(kind, path, units));
}

TriangleMesh MeshImporter::load_mesh(const std::string& path, const MeshUnits& units) {
  return mesh_from_bytes(ask(kMesh, path, units), notes_);
}

std::vector<std::vector<Vec3>> MeshImporter::load_convex_parts(const std::string& path,
                                                               const MeshUnits& units) {
  return parts_from_bytes(ask(kParts, path, units));
}

TriangleMesh load_mesh(const std::string& path, const MeshUnits& units) {
  return MeshImporter().load_mesh(path, units);
}

std::vector<std::vector<Vec3>> load_convex_parts(const std::string& path, const MeshUnits& units) {
  return MeshImporter().load_convex_parts(path, units);
}

}  // namespace rubble
