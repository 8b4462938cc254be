#include "io/voids/void_files.h"

#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>

#include <cmath>
#include <functional>
#include <mutex>
#include <ostream>
#include <streambuf>
#include <vector>

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

// What OpenVDB writes goes into a file as it comes. A VDB header is: magic (8 bytes), file version, library version (4 + 4 + 4),
// whether there are offsets (1), then a random UUID as 36 characters. It is replaced by one from the content.
class VdbFile : public std::streambuf {
 public:
  explicit VdbFile(const std::string& path) : file_(path) {}

  void commit() {
    const std::string digest = hash_.hex();
    file_.overwrite(kUuidAt, digest.substr(0, 8) + "-" + digest.substr(8, 4) + "-8" + digest.substr(13, 3) + "-8" +
                                 digest.substr(17, 3) + "-" + digest.substr(20, 12));
    file_.commit();
  }

 protected:
  std::streamsize xsputn(const char* bytes, std::streamsize size) override {
    std::streamsize done = 0;
    for (; done < size && file_.size() < kUuidAt + kUuidLength; ++done)
      add(file_.size() < kUuidAt ? bytes + done : "0", 1);
    add(bytes + done, std::size_t(size - done));
    return size;
  }
  int_type overflow(int_type c) override {
    const char byte = traits_type::to_char_type(c);
    if (!traits_type::eq_int_type(c, traits_type::eof())) xsputn(&byte, 1);
    return traits_type::not_eof(c);
  }

 private:
  static constexpr std::uint64_t kUuidAt = 21, kUuidLength = 36;

  void add(const char* bytes, std::size_t size) {
    hash_.add(bytes, size), file_.write(bytes, size);
  }

  AtomicFile file_;
  Sha256 hash_;
};

// openvdb::io::Stream, but for grids that are made one after the other: those of a large map would fill the memory together.
class GridByGrid : private openvdb::io::Archive {
 public:
  using Makers = std::vector<std::function<openvdb::GridBase::Ptr()>>;

  // Their names are all different.
  void write(std::ostream& out, const Makers& makers) const {
    writeHeader(out, false);
    openvdb::io::setWriteGridStatsMetadata(out, isGridStatsMetadataEnabled());
    openvdb::MetaMap().writeMeta(out);
    const std::int32_t count = std::int32_t(makers.size());
    out.write(reinterpret_cast<const char*>(&count), sizeof count);
    for (const auto& make : makers) {
      const openvdb::GridBase::Ptr grid = make();
      openvdb::io::GridDescriptor descriptor(grid->getName(), grid->type(), grid->saveFloatAsHalf());
      writeGrid(descriptor, grid, out, false);
    }
  }
};

}  // namespace

void write_vdb(const std::string& path, const VoidMap& map) {
  static std::once_flag once;
  std::call_once(once, [] { openvdb::initialize(); });
  const VoidSpace& space = map.space;
  const auto widest_at = [&map](std::size_t i) { return map.widest.radius[map.widest.cells[i]]; };
  GridByGrid::Makers makers{
      [&] { return make_float_grid(space, [&](std::size_t i) { return space.clearance[i]; }, "clearance"); },
      [&] { return make_float_grid(space, widest_at, "widest_path"); }, [&] { return make_solid_grid(space); }};
  for (const RobotVoids& robot : map.robots) makers.push_back([&] { return make_label_grid(space, robot); });
  VdbFile file(path);
  std::ostream out(&file);
  out.exceptions(std::ios::badbit);  // so that what the file says gets through
  try {
    GridByGrid().write(out, makers);
  } catch (const openvdb::Exception& e) {
    throw RunError(path + ": OpenVDB cannot write it: " + e.what());
  }
  file.commit();
}

}  // namespace rubble
