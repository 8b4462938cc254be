// LeRobot datasets of the episodes of environments; rubble/envs/episodes.py makes them.

#include <nanobind/stl/tuple.h>

#include <tuple>

#include "io/learning/lerobot_dataset.h"
#include "python/arrays.h"
#include "python/parts.h"

namespace rubble::python {
namespace {

// Name, kind, names of the parts.
using FeatureGiven = std::tuple<std::string, std::string, std::vector<std::string>>;
using Picture = nb::ndarray<const std::uint8_t, nb::ndim<3>, nb::c_contig, nb::device::cpu>;

LerobotFeature to_feature(const FeatureGiven& given) {
  const auto& [name, kind, parts] = given;
  return {name, kind == "flag" ? LerobotFeature::Kind::flag : kind == "number" ? LerobotFeature::Kind::number : LerobotFeature::Kind::values,
          parts};
}

// Height x width x 3, or x 1: grey.
std::vector<std::uint8_t> to_rgb(const Picture& picture) {
  const std::size_t pixels = picture.shape(0) * picture.shape(1), channels = picture.shape(2);
  if (channels != 1 && channels != 3)
    throw InputError({"", 0, "picture", "wrong shape", "height x width x 1 or 3", std::to_string(channels) + " channels", ""});
  std::vector<std::uint8_t> rgb(3 * pixels);
  for (std::size_t i = 0; i < 3 * pixels; ++i) rgb[i] = picture.data()[channels == 3 ? i : i / 3];
  return rgb;
}

}  // namespace

void add_episodes(nb::module_& module) {
  nb::class_<LerobotDataset>(module, "_LerobotDataset")
      .def("__init__", [](LerobotDataset* made, const nb::object& path, const std::vector<std::string>& videos,
                          const std::vector<FeatureGiven>& features, const std::optional<std::string>& robot_type, const std::string& task,
                          double rate_hz) {
        expect_positive(rate_hz, "rate_hz", 1e9);
        LerobotDataset::Spec spec{videos, {}, robot_type, task, rate_hz, true};
        for (const FeatureGiven& feature : features) spec.features.push_back(to_feature(feature));
        new (made) LerobotDataset(to_path(path, "path"), std::move(spec), recording_threads());
      })
      .def("add_picture", [](LerobotDataset& d, std::size_t video, std::int64_t since_ns, const Picture& picture) {
        d.add_picture(video, since_ns, int(picture.shape(1)), int(picture.shape(0)), to_rgb(picture));
      })
      .def("add_row", &LerobotDataset::add_row)
      .def("end_episode", &LerobotDataset::end_episode)
      .def("finish", &LerobotDataset::finish);
}

}  // namespace rubble::python
