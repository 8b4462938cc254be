#include "io/voids/void_files.h"

#include <openvdb/io/Archive.h>
#include <openvdb/io/Compression.h>
#include <openvdb/io/DelayedLoadMetadata.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <mutex>
#include <ostream>
#include <streambuf>
#include <vector>

#include "io/base/atomic_file.h"
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

// A grid that writes itself.
class Writable {
 public:
  virtual ~Writable() = default;
  virtual openvdb::GridBase& grid() = 0;
  // compression: of OpenVDB.
  virtual void add_sizes(std::uint32_t compression) = 0;
  virtual void write_values(std::ostream& out) const = 0;
};

// Its leaves have masks alone; each gets its values when it is written. Those of a large map would fill the memory.
template <typename Grid>
class LateGrid : public Writable {
 public:
  using Value = typename Grid::ValueType;
  using Leaf = typename Grid::TreeType::LeafNodeType;
  using IsStored = std::function<bool(std::size_t cell)>;
  using ValueAt = std::function<Value(std::size_t cell)>;

  LateGrid(const VoxelGrid& cells, const IsStored& is_stored, const ValueAt& value_at)
      : cells_(cells), value_at_(value_at), grid_(Grid::create(Value(0))) {
    const Cell& n = cells.size;
    constexpr int kEdge = int(Leaf::DIM);
    for (int z = 0; z < n[2]; z += kEdge)
      for (int y = 0; y < n[1]; y += kEdge)
        for (int x = 0; x < n[0]; x += kEdge) add_leaf({x, y, z}, is_stored);
  }

  openvdb::GridBase& grid() override { return *grid_; }

  // As those of leaves with values. Readers that load leaves when they are asked for need to know where these are.
  void add_sizes(std::uint32_t compression) override {
    const openvdb::Index64 leaves = grid_->tree().leafCount();
    if (leaves == 0) return;
    grid_->insertMeta(grid_->META_FILE_MEM_BYTES,
                      openvdb::Int64Metadata(openvdb::Int64(grid_->memUsage() + leaves * Leaf::SIZE * sizeof(Value))));
    openvdb::io::DelayedLoadMetadata sizes;
    sizes.resizeMask(leaves), sizes.resizeCompressedSize(leaves);
    std::size_t number = 0;
    for (auto leaf = grid_->tree().cbeginLeaf(); leaf; ++leaf, ++number) {
      const Leaf whole = fill(*leaf);
      const auto mask = openvdb::io::NO_MASK_OR_INACTIVE_VALS;
      const std::size_t size = openvdb::io::writeCompressedValuesSize(whole.buffer().data(), Leaf::SIZE,
                                                                     whole.valueMask(), mask, false, compression);
      sizes.setMask(number, mask), sizes.setCompressedSize(number, std::int64_t(size + 8));
    }
    grid_->insertMeta(grid_->META_FILE_DELAYED_LOAD, sizes);
  }
  void write_values(std::ostream& out) const override {
    for (auto leaf = grid_->tree().cbeginLeaf(); leaf; ++leaf) fill(*leaf).writeBuffers(out, false);
  }

 private:
  std::size_t cell_at(const Leaf& leaf, openvdb::Index voxel) const {
    const openvdb::Coord c = leaf.offsetToGlobalCoord(voxel);
    return cells_.index({c.x(), c.y(), c.z()});
  }
  void add_leaf(const Cell& first, const IsStored& is_stored) {
    auto leaf = std::make_unique<Leaf>(openvdb::PartialCreate(), to_coord(first), Value(0));
    for (openvdb::Index voxel = 0; voxel < Leaf::SIZE; ++voxel) {
      const openvdb::Coord c = leaf->offsetToGlobalCoord(voxel);
      const Cell cell{c.x(), c.y(), c.z()};
      if (cells_.contains(cell) && is_stored(cells_.index(cell))) leaf->setActiveState(voxel, true);
    }
    if (!leaf->getValueMask().isOff()) grid_->tree().addLeaf(leaf.release());
  }
  Leaf fill(const Leaf& leaf) const {
    Leaf whole(leaf.origin(), Value(0));
    for (auto voxel = leaf.cbeginValueOn(); voxel; ++voxel)
      whole.setValueOn(voxel.pos(), value_at_(cell_at(leaf, voxel.pos())));
    return whole;
  }

  const VoxelGrid cells_;
  const ValueAt value_at_;
  const typename Grid::Ptr grid_;
};

// One whose tree is small.
class WholeGrid : public Writable {
 public:
  explicit WholeGrid(openvdb::GridBase::Ptr grid) : grid_(std::move(grid)) {}
  openvdb::GridBase& grid() override { return *grid_; }
  void add_sizes(std::uint32_t) override {}
  void write_values(std::ostream& out) const override { grid_->writeBuffers(out); }

 private:
  const openvdb::GridBase::Ptr grid_;
};

using WritablePtr = std::unique_ptr<Writable>;

void describe(const VoidSpace& space, const std::string& name, openvdb::GridBase& grid) {
  grid.setName(name);
  grid.setTransform(make_transform(space.grid));
  grid.setSaveFloatAsHalf(false);
  grid.insertMeta("pile_state_hash", openvdb::StringMetadata(hex64(space.pile_state)));
}

// value_at: of a cell of the void, by its index.
WritablePtr make_float_grid(const VoidSpace& space, const std::function<float(std::size_t)>& value_at,
                            const std::string& name) {
  const auto is_void = [&space](std::size_t i) { return space.kind[i] == CellKind::free_void; };
  auto late = std::make_unique<LateGrid<openvdb::FloatGrid>>(space.grid, is_void, value_at);
  describe(space, name, late->grid());
  late->grid().setGridClass(openvdb::GRID_FOG_VOLUME);
  return late;
}

WritablePtr make_solid_grid(const VoidSpace& space) {
  const auto grid = openvdb::BoolGrid::create(false);
  describe(space, "solid", *grid);
  auto accessor = grid->getAccessor();
  for (std::size_t i = 0; i < space.kind.size(); ++i) {
    if (space.kind[i] == CellKind::solid) accessor.setValue(to_coord(space.grid.cell(i)), true);
  }
  grid->tree().prune();
  return std::make_unique<WholeGrid>(grid);
}

// The ranks of voids, by their cells.
class Ranks {
 public:
  Ranks(const RobotVoids& robot, std::size_t cells) {
    std::size_t count = 0;
    for (const Void& v : robot.voids) count += v.cells.runs().size();
    runs_.reserve(count), begin_.reserve(cells / kBlock + 1);
    for (std::size_t v = 0; v < robot.voids.size(); ++v)
      for (const CellRun& run : robot.voids[v].cells.runs()) runs_.push_back({run, int(v + 1)});
    std::sort(runs_.begin(), runs_.end(), [](const Run& a, const Run& b) { return a.cells.first < b.cells.first; });
    std::uint32_t run = 0;
    for (std::size_t block = 0; block <= cells / kBlock; ++block) {
      while (run < runs_.size() && end_of(runs_[run]) <= block * kBlock) ++run;
      begin_.push_back(run);
    }
  }

  int operator()(std::size_t cell) const {  // 0: in none
    std::size_t run = begin_[cell / kBlock];
    while (run < runs_.size() && end_of(runs_[run]) <= cell) ++run;
    return run < runs_.size() && runs_[run].cells.first <= cell ? runs_[run].rank : 0;
  }

 private:
  static constexpr std::size_t kBlock = 64;  // cells

  struct Run {
    CellRun cells;
    int rank;
  };
  static std::size_t end_of(const Run& run) { return std::size_t(run.cells.first) + run.cells.count; }

  std::vector<Run> runs_;
  std::vector<std::uint32_t> begin_;  // of each block of cells, the first run that does not end before it
};

WritablePtr make_label_grid(const VoidSpace& space, const RobotVoids& robot) {
  const auto ranks = std::make_shared<const Ranks>(robot, space.grid.count());
  const auto rank_at = [ranks](std::size_t i) { return (*ranks)(i); };
  auto late = std::make_unique<LateGrid<openvdb::Int32Grid>>(space.grid, rank_at, rank_at);
  describe(space, "voids_r" + std::to_string(int(std::lround(robot.radius * 1000))), late->grid());
  return late;
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

// openvdb::io::Stream, but for grids that are made one after the other, and that write their values themselves.
class GridByGrid : private openvdb::io::Archive {
 public:
  using Makers = std::vector<std::function<WritablePtr()>>;

  // Their names are all different.
  void write(std::ostream& out, const Makers& makers) const {
    writeHeader(out, false);
    openvdb::io::setWriteGridStatsMetadata(out, isGridStatsMetadataEnabled());
    openvdb::MetaMap().writeMeta(out);
    const std::int32_t count = std::int32_t(makers.size());
    out.write(reinterpret_cast<const char*>(&count), sizeof count);
    for (const auto& make : makers) write(out, *make());
  }

 private:
  void write(std::ostream& out, Writable& writable) const {
    openvdb::GridBase& grid = writable.grid();
    const openvdb::io::GridDescriptor descriptor(grid.getName(), grid.type(), grid.saveFloatAsHalf());
    descriptor.writeHeader(out);
    descriptor.writeStreamPos(out);
    setGridCompression(out, grid);
    const std::uint32_t compression = openvdb::io::getDataCompression(out);
    grid.addStatsMetadata();
    grid.insertMeta(grid.META_FILE_COMPRESSION, openvdb::StringMetadata(openvdb::io::compressionToString(compression)));
    writable.add_sizes(compression);
    grid.writeMeta(out);
    grid.writeTransform(out);
    grid.writeTopology(out);
    writable.write_values(out);
  }
};

}  // namespace

void write_vdb(const std::string& path, const VoidMap& map) {
  static std::once_flag once;
  std::call_once(once, [] { openvdb::initialize(); });
  const VoidSpace& space = map.space;
  const auto widest_at = [&map](std::size_t i) { return map.widest.radius(map.space, i); };
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
