// What VoidExplore computes in every step: a depth picture, what it shows of a void, and where there is room.
// One call a step, and no array that a step leaves behind.
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "app/scene/build_scene.h"
#include "kernel/base/number_text.h"
#include "kernel/base/parallel.h"
#include "kernel/queries/queries.h"
#include "kernel/voids/seen_cells.h"
#include "python/arrays.h"
#include "python/one_thread.h"
#include "python/parts.h"
#include "render/rays/depth_rays.h"

namespace rubble::python {
namespace {

constexpr double kMostVoxels = 1e9;   // of the grid around a void
constexpr int kSeenStride = 4;   // of the pixels whose rays show cells, each way
constexpr double kLongestWay = 1000;  // of a move; unit: m
constexpr double kProbe = 0.25;  // of the radius: how finely a way is looked at for what stands in it

VoxelGrid grid_around(const std::vector<Vec3>& centres, double voxel) {
  if (centres.empty()) throw InputError({"", 0, "cells", "no cells", "the cells of a void", "none", ""});
  expect_positive(voxel, "voxel", 1);
  Aabb box;
  for (const Vec3& c : centres) box.include(c);
  VoxelGrid grid;
  grid.voxel = voxel;
  const Vec3 most = (box.max - box.min) * (1 / voxel) + Vec3{1, 1, 1};
  if (!(most.x * most.y * most.z < kMostVoxels))
    throw InputError({"", 0, "voxel", "the grid around the cells is too large", "at most " + exact_text(kMostVoxels) + " voxels",
                      exact_text(most.x * most.y * most.z), "ask for larger voxels"});
  grid.corner = box.min - Vec3{0.5, 0.5, 0.5} * voxel;
  for (int k = 0; k < 3; ++k)
    grid.size[std::size_t(k)] = int(std::floor((box.max[k] - box.min[k]) / voxel + 0.5)) + 1;
  return grid;
}

// What several explorers of a pile have in common.
struct ExploredPile {
  RayWorld world;
  PileQueries queries;
  explicit ExploredPile(const SettledMission& settled)
      : world(build_scene(settled.mission.scenario, settled.mission.assets, settled.state)),
        queries(settled.state, settled.mission.assets.finest_meshes()) {}
};

class Explorer : public OneThread {
 public:
  Explorer(std::shared_ptr<ExploredPile> pile, const DoubleArray& cells, double voxel, double radius, int size,
           double fov_deg, double max_range, int threads)
      : pile_(std::move(pile)), world_(pile_->world), queries_(pile_->queries),
        rays_(pinhole(size, size, fov_deg), 2 * max_range), pool_(threads), radius_(radius), max_range_(max_range),
        seen_(make_seen(to_points(cells, "cells"), voxel)) {
    expect_positive(max_range, "max_range", kFarthest);
    if (!(radius >= 0.001 && radius <= 100))
      throw InputError({"", 0, "radius", "out of range", "0.001 to 100 m", exact_text(radius), ""});
  }

  void forget() { seen_.forget(), clearance_ = 0; }
  // shift: of the principal point; unit: pixel
  void set_camera(double fov_deg, double shift_x, double shift_y) {
    const int size = rays_.intrinsics().width;
    rays_ = DepthRays(pinhole(size, size, fov_deg, shift_x, shift_y), 2 * max_range_);
  }
  std::size_t seen() const { return seen_.count(); }
  std::size_t count() const { return seen_.wanted(); }

  // (picture, clearance): depth, at most max_range; how far the middle of the body is from everything.
  nb::tuple look(const DoubleArray& world_from_body) {
    const Pose pose = to_pose(world_from_body, "pose");
    const int size = rays_.intrinsics().width;
    Array<float> picture = make_array<float>({size, size});
    float* const depth = picture.data();
    {
      const nb::gil_scoped_release free;
      rays_.cast(world_, pose, pool_, depth);
      const float most = float(max_range_);
      for (int i = 0; i < size * size; ++i) depth[i] = std::min(depth[i], most);
      mark(pose, depth);
      // Nothing begins within the ball of free space that was around it before.
      const bool outside = distance(pose.translation, at_) < clearance_;
      clearance_ = outside ? queries_.clearance_outside(pose.translation, max_range_)
                           : queries_.clearance(pose.translation, max_range_);
      at_ = pose.translation;
    }
    return nb::make_tuple(picture, clearance_);
  }

  // (place, whether all the way is free): as far along `way` as the body has room. from: where it looked last.
  nb::tuple move(const DoubleArray& from_row, const DoubleArray& way_row) {
    const Vec3 from = to_points(from_row, "from").at(0), way = to_points(way_row, "way").at(0);
    const double length = norm(way);
    if (!(length <= kLongestWay))
      throw InputError({"", 0, "way", "out of range", "at most " + exact_text(kLongestWay) + " m", exact_text(length), ""});
    // Clearance changes by no more than the distance that is gone.
    if (distance(from, at_) == 0 && clearance_ - length >= radius_) return nb::make_tuple(from_vector(from + way), true);
    const int parts = std::max(1, int(std::ceil(length / (kProbe * radius_))));
    Vec3 place = from;
    for (int i = 1; i <= parts; ++i) {
      const Vec3 next = from + way * (double(i) / parts);
      if (queries_.clearance(next, 2 * radius_) < radius_) return nb::make_tuple(from_vector(place), false);
      place = next;
    }
    return nb::make_tuple(from_vector(place), true);
  }

  Array<double> matrix() const { return camera_matrix(rays_.intrinsics()); }

 private:
  static SeenCells make_seen(const std::vector<Vec3>& centres, double voxel) {
    const VoxelGrid grid = grid_around(centres, voxel);
    std::vector<std::uint32_t> cells;
    for (const Vec3& c : centres) cells.push_back(std::uint32_t(grid.index(grid.find_cell(c))));
    return {grid, cells};
  }

  void mark(const Pose& pose, const float* depth) {
    const int size = rays_.intrinsics().width;
    for (int v = kSeenStride / 2; v < size; v += kSeenStride)
      for (int u = kSeenStride / 2; u < size; u += kSeenStride) {
        const auto pixel = std::size_t(v) * std::size_t(size) + std::size_t(u);
        seen_.mark(pose.translation, pose.rotation.rotate(rays_.direction(pixel)),
                   double(depth[pixel]) / rays_.cosine(pixel));
      }
  }

  std::shared_ptr<ExploredPile> pile_;
  const RayWorld& world_;
  const PileQueries& queries_;
  DepthRays rays_;
  ThreadPool pool_;
  double radius_, max_range_;
  SeenCells seen_;
  double clearance_ = 0;  // where it looked last; unit: m
  Vec3 at_;
};

}  // namespace

void add_explorer(nb::module_& module) {
  nb::class_<ExploredPile>(module, "_ExploredPile").def("__init__", [](ExploredPile* made, const SharedPile& s) {
    new (made) ExploredPile(*s);
  });
  nb::class_<Explorer>(module, "_Explorer")
      .def("__init__", [](Explorer* made, const std::shared_ptr<ExploredPile>& pile, const DoubleArray& cells, double voxel,
                          double radius, int size, double fov_deg, double max_range,
                          const nb::object& threads) {
        new (made) Explorer(pile, cells, voxel, radius, size, fov_deg, max_range, to_threads(threads));
      })
      .def("set_camera", in_one_thread(&Explorer::set_camera), nb::arg("fov_deg"), nb::arg("shift_x"), nb::arg("shift_y"))
      .def("forget", in_one_thread(&Explorer::forget))
      .def("look", in_one_thread(&Explorer::look), nb::arg("pose"))
      .def("move", in_one_thread(&Explorer::move), nb::arg("from_"), nb::arg("way"))
      .def_prop_ro("seen", in_one_thread(&Explorer::seen))
      .def_prop_ro("count", in_one_thread(&Explorer::count))
      .def_prop_ro("K", in_one_thread(&Explorer::matrix), nb::rv_policy::automatic);
}

}  // namespace rubble::python
