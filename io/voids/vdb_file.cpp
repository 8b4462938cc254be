#include "io/voids/void_files.h"

#include <openvdb/io/Stream.h>

#include <cmath>
#include <mutex>
#include <sstream>

#include "io/base/atomic_file.h"
#include "io/voids/vdb_grids.h"
#include "kernel/base/error.h"
#include "kernel/base/hash.h"

namespace rubble {
namespace {

openvdb::Coord to_coord(const Cell& c) { return {c[0], c[1], c[2]}; }

// OpenVDB's index space has its whole numbers at the centres of voxels.
openvdb::math::Transform::Ptr make_transform(const VoxelGrid& grid) {
  auto transform = openvdb::math::Transform::createLinearTransform(grid.voxel);
  const Vec3 first = grid.centre(Cell{0, 0, 0});
  transform->postTranslate({first.x, first.y, first.z});
  return transform;
}

template <typename Grid>
typename Grid::Ptr make_grid(const VoidSpace& space, const std::string& name,
                             typename Grid::ValueType background) {
  typename Grid::Ptr grid = Grid::create(background);
  grid->setName(name);
  grid->setTransform(make_transform(space.grid));
  grid->setSaveFloatAsHalf(false);
  grid->insertMeta("pile_state_hash", openvdb::StringMetadata(hex64(space.pile_state)));
  return grid;
}

// value_at: of a cell of the void, by its index.
template <typename ValueAt>
openvdb::FloatGrid::Ptr make_float_grid(const VoidSpace& space, const ValueAt& value_at,
                                        const std::string& name) {
  auto grid = make_grid<openvdb::FloatGrid>(space, name, 0.0f);
  auto accessor = grid->getAccessor();
  for (std::size_t i = 0; i < space.kind.size(); ++i) {
    if (space.kind[i] == CellKind::free_void)
      accessor.setValue(to_coord(space.grid.cell(i)), value_at(i));
  }
  grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  return grid;
}

openvdb::BoolGrid::Ptr make_solid_grid(const VoidSpace& space) {
  auto grid = make_grid<openvdb::BoolGrid>(space, "solid", false);
  auto accessor = grid->getAccessor();
  for (std::size_t i = 0; i < space.kind.size(); ++i) {
    if (space.kind[i] == CellKind::solid) accessor.setValue(to_coord(space.grid.cell(i)), true);
  }
  grid->tree().prune();
  return grid;
}

openvdb::Int32Grid::Ptr make_label_grid(const VoidSpace& space, const RobotVoids& robot) {
  const std::string name = "voids_r" + std::to_string(int(std::lround(robot.radius * 1000)));
  auto grid = make_grid<openvdb::Int32Grid>(space, name, 0);
  auto accessor = grid->getAccessor();
  for (std::size_t v = 0; v < robot.voids.size(); ++v) {
    for (const std::uint32_t i : robot.voids[v].cells)
      accessor.setValue(to_coord(space.grid.cell(i)), int(v + 1));
  }
  return grid;
}

// A VDB header is: magic (8 bytes), file version, library version (4 + 4 + 4), whether there are
// offsets (1), then a random UUID as 36 characters. It is replaced by one from the content.
void replace_uuid(std::string& bytes) {
  constexpr std::size_t kAt = 21, kLength = 36;
  bytes.replace(kAt, kLength, kLength, '0');
  Sha256 hash;
  hash.add(bytes.data(), bytes.size());
  const std::string digest = hash.hex();
  const std::string uuid = digest.substr(0, 8) + "-" + digest.substr(8, 4) + "-8" +
                           digest.substr(13, 3) + "-8" + digest.substr(17, 3) + "-" +
                           digest.substr(20, 12);
  bytes.replace(kAt, kLength, uuid);
}

}  // namespace

void write_vdb(const std::string& path, const VoidMap& map) {
  static std::once_flag once;
  std::call_once(once, [] { openvdb::initialize(); });
  const auto widest_at = [&map](std::size_t i) { return map.widest.radius[map.widest.cells[i]]; };
  openvdb::GridPtrVec grids{
      make_float_grid(
          map.space, [&map](std::size_t i) { return map.space.clearance[i]; }, "clearance"),
      make_float_grid(map.space, widest_at, "widest_path"), make_solid_grid(map.space)};
  for (const RobotVoids& robot : map.robots) grids.push_back(make_label_grid(map.space, robot));
  std::ostringstream stream(std::ios::binary);
  try {
    openvdb::io::Stream(stream).write(grids);
  } catch (const openvdb::Exception& e) {
    throw RunError(path + ": OpenVDB cannot write it: " + e.what());
  }
  std::string bytes = stream.str();
  replace_uuid(bytes);
  write_text_file(path, bytes);
}

}  // namespace rubble
