// Scans of LiDARs over a pile that rests.

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
  nb::object scan(const DoubleArray& world_from_sensor, int number) const {
    const Pose pose = to_pose(world_from_sensor, "pose");
    const Scenario& s = settled_->mission.scenario;
    RangeScan scan;
    {
      const nb::gil_scoped_release free;
      Lidar lidar(spec_, world_, {[pose](std::int64_t) { return pose; }, s.start_ns}, Medium(s.air, s.seed), seed_,
                  threads_);
      scan = lidar.take(number);
    }
    return to_structured(std::move(scan.points));
  }

 private:
  SharedPile settled_;
  std::shared_ptr<RayWorld> world_;
  LidarSpec spec_;
  std::uint64_t seed_;
  int threads_;
};

}  // namespace

nb::object to_structured(std::vector<ScanPoint>&& points) {
  static const std::vector<std::pair<const char*, std::pair<const char*, std::size_t>>> fields = {
      {"x", {"<f4", offsetof(ScanPoint, x)}},         {"y", {"<f4", offsetof(ScanPoint, y)}},
      {"z", {"<f4", offsetof(ScanPoint, z)}},         {"intensity", {"<f4", offsetof(ScanPoint, intensity)}},
      {"time", {"<f4", offsetof(ScanPoint, time)}},   {"ring", {"<u2", offsetof(ScanPoint, ring)}},
      {"column", {"<u2", offsetof(ScanPoint, column)}}};
  nb::list names, formats, offsets;
  for (const auto& [name, rest] : fields)
    names.append(name), formats.append(rest.first), offsets.append(rest.second);
  nb::dict layout;
  layout["names"] = names, layout["formats"] = formats, layout["offsets"] = offsets;
  layout["itemsize"] = sizeof(ScanPoint);
  const Size count = Size(points.size());
  const nb::object raw = nb::cast(take_as<std::uint8_t>(std::move(points), {count * Size(sizeof(ScanPoint))}));
  return raw.attr("view")(nb::module_::import_("numpy").attr("dtype")(layout));
}

void add_range_scans(nb::module_& module) {
  nb::class_<PyLidar>(module, "_Lidar")
      .def("__init__", [](PyLidar* made, const SharedPile& s, const std::string& model, bool noise, const nb::object& seed,
                          const nb::object& threads) {
        new (made) PyLidar(s, model, noise, to_seed(seed), to_threads(threads));
      })
      .def("scan", &PyLidar::scan, nb::arg("pose"), nb::arg("number") = 0);
}

}  // namespace rubble::python
