// Sensors over a pile that rests: frames of the renderer, depth by exact rays.

#include <array>
#include <cmath>

#include "app/scene/build_scene.h"
#include "app/support/drawing_device.h"
#include "app/sensors/camera_renderers.h"
#include "kernel/base/parallel.h"
#include "python/arrays.h"
#include "python/one_thread.h"
#include "python/parts.h"
#include "render/rays/depth_rays.h"
#include "render/renderer.h"

namespace rubble::python {

Intrinsics pinhole(int width, int height, double fov_deg, double shift_x, double shift_y) {
  if (width < 16 || height < 16 || width > 8192 || height > 8192)
    throw InputError({"", 0, "width", "out of range", "an image of 16 to 8192 pixels a side",
                      std::to_string(width) + " x " + std::to_string(height), ""});
  if (!(fov_deg >= 1 && fov_deg <= 170))
    throw InputError({"", 0, "fov_deg", "out of range", "1 to 170", std::to_string(fov_deg), ""});
  if (!(std::abs(shift_x) <= 0.5 * width && std::abs(shift_y) <= 0.5 * height))
    throw InputError({"", 0, "shift", "out of range", "at most half a side of the image",
                      std::to_string(shift_x) + ", " + std::to_string(shift_y), ""});
  CameraScenario camera;
  camera.width = width, camera.height = height, camera.fov_deg = fov_deg;
  Intrinsics k = camera.intrinsics();
  k.cx += shift_x, k.cy += shift_y;
  return k;
}

Array<double> camera_matrix(const Intrinsics& k) {
  return take_vector<double>({k.fx, 0, k.cx, 0, k.fy, k.cy, 0, 0, 1}, {3, 3});
}

Scene scene_of(const SettledMission& settled) {
  return build_scene(settled.mission.scenario, settled.mission.assets, settled.state);
}

namespace {

// Colour and depth, as `rubble run` draws them.
class FrameRenderer : public OneThread {
 public:
  FrameRenderer(SharedPile settled, int threads)
      : settled_(std::move(settled)),
        device_(open_device(settled_->mission.scenario.device, "", threads)),
        renderer_(prepare_renderer(scene_of(*settled_), settled_->mission.scenario.cameras.front().camera.colour, *device_, {threads, {}, {}})) {}

  nb::dict render(const DoubleArray& world_from_camera, int width, int height, double fov_deg, int number,
                  const std::array<double, 2>& shift) {
    const std::vector<Pose> poses = to_poses(world_from_camera, "pose");
    const Intrinsics k = pinhole(width, height, fov_deg, shift[0], shift[1]);
    std::vector<std::uint8_t> rgb;
    std::vector<float> depth;
    {
      const nb::gil_scoped_release free;
      renderer_->render(poses, k, number, settled_->mission.scenario.start_ns, [&](Frame frame) {
        if (poses.size() == 1) return void((rgb = std::move(frame.rgb), depth = std::move(frame.depth)));
        rgb.insert(rgb.end(), frame.rgb.begin(), frame.rgb.end());
        depth.insert(depth.end(), frame.depth.begin(), frame.depth.end());
      });
    }
    Shape image{height, width};
    if (world_from_camera.ndim() == 2) image.insert(image.begin(), Size(poses.size()));
    Shape colours = image;
    colours.push_back(3);
    nb::dict out;
    out["rgb"] = take_vector(std::move(rgb), colours);
    out["depth"] = take_vector(std::move(depth), image);
    out["K"] = camera_matrix(k);
    return out;
  }

 private:
  SharedPile settled_;
  std::unique_ptr<Device> device_;
  std::unique_ptr<Renderer> renderer_;
};

// Planar depth by exact rays, for loops that need no colour: nothing is baked, no device is opened.
class DepthCamera : public OneThread {
 public:
  DepthCamera(SharedPile settled, int width, int height, double fov_deg, double max_range, int threads)
      : world_(scene_of(*settled)), rays_(pinhole(width, height, fov_deg), max_range), pool_(threads) {
    expect_positive(max_range, "max_range", kFarthest);
  }

  Array<float> depth(const DoubleArray& world_from_camera) {
    const std::vector<Pose> poses = to_poses(world_from_camera, "pose");
    const Intrinsics& k = rays_.intrinsics();
    Shape image{k.height, k.width};
    if (world_from_camera.ndim() == 2) image.insert(image.begin(), Size(poses.size()));
    Array<float> out = make_array<float>(image);
    float* values = out.data();
    {
      const nb::gil_scoped_release free;
      for (const Pose& pose : poses) {
        rays_.cast(world_, pose, pool_, values);
        values += std::size_t(k.width) * std::size_t(k.height);
      }
    }
    return out;
  }
  Array<double> matrix() const { return camera_matrix(rays_.intrinsics()); }

 private:
  RayWorld world_;
  DepthRays rays_;
  ThreadPool pool_;
};

}  // namespace

void add_sensors(nb::module_& module) {
  nb::class_<FrameRenderer>(module, "_Renderer")
      .def("__init__", [](FrameRenderer* made, const SharedPile& s, const nb::object& threads) {
        new (made) FrameRenderer(s, to_threads(threads));
      })
      .def("render", in_one_thread(&FrameRenderer::render), nb::arg("pose"), nb::arg("width") = 640, nb::arg("height") = 480,
           nb::arg("fov_deg") = 90.0, nb::arg("number") = 0, nb::arg("shift") = std::array<double, 2>{0, 0});
  nb::class_<DepthCamera>(module, "_DepthCamera")
      .def("__init__", [](DepthCamera* made, const SharedPile& s, int width, int height, double fov_deg, double max_range,
                          const nb::object& threads) {
        new (made) DepthCamera(s, width, height, fov_deg, max_range, to_threads(threads));
      })
      .def("depth", in_one_thread(&DepthCamera::depth), nb::arg("pose"))
      .def_prop_ro("K", in_one_thread(&DepthCamera::matrix), nb::rv_policy::automatic);
  add_range_scans(module);
}

}  // namespace rubble::python
