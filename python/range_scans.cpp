// Scans of LiDARs over a pile that rests.
#include <pybind11/stl.h>

#include <algorithm>

#include "python/arrays.h"
#include "python/parts.h"
#include "render/lidar/lidar.h"
#include "scripting/sensors/lidar.h"

namespace rubble::python {
namespace {

LidarModel model_named(const std::string& name) {
  const std::vector<std::string>& names = lidar_model_names();
  const auto at = std::find(names.begin(), names.end(), name);
  if (at != names.end()) return LidarModel(at - names.begin());
  std::string all;
  for (const std::string& known : names) all += (all.empty() ? "one of " : ", ") + known;
  throw InputError({"", 0, "model", "unknown LiDAR", all, "\"" + name + "\"", ""});
}

class PyLidar {
 public:
  PyLidar(SharedPile settled, const std::string& model, bool noise, std::uint64_t seed, int threads)
      : settled_(std::move(settled)), world_(std::make_shared<RayWorld>(scene_of(*settled_))), seed_(seed),
        threads_(threads) {
    LidarFigures figures;
    figures.model = model_named(model);
    spec_ = figures.spec();
    spec_.noise = noise;
  }

  // The sensor stands still.
  py::array scan(const DoubleArray& world_from_sensor, int number) const {
    const Pose pose = to_pose(world_from_sensor, "pose");
    const Scenario& s = settled_->mission.scenario;
    RangeScan scan;
    {
      const py::gil_scoped_release free;
      Lidar lidar(spec_, world_, {[pose](std::int64_t) { return pose; }, s.start_ns}, Medium(s.air, s.seed), seed_,
                  threads_);
      scan = lidar.take(number);
    }
    const auto count = py::ssize_t(scan.points.size());
    return take_vector(std::move(scan.points), {count});
  }

 private:
  SharedPile settled_;
  std::shared_ptr<RayWorld> world_;
  LidarSpec spec_;
  std::uint64_t seed_;
  int threads_;
};

}  // namespace

void add_range_scans(py::module_& module) {
  PYBIND11_NUMPY_DTYPE(ScanPoint, x, y, z, intensity, time, ring, column);
  py::class_<PyLidar>(module, "_Lidar")
      .def(py::init([](const SharedPile& s, const std::string& model, bool noise,
                       const py::object& seed, int threads) {
        return std::make_unique<PyLidar>(s, model, noise, to_seed(seed), threads);
      }))
      .def("scan", &PyLidar::scan, py::arg("pose"), py::arg("number") = 0);
}

}  // namespace rubble::python
