#include "io/datasets/colmap_recorder.h"

#include <algorithm>

#include "io/base/folder_writer.h"
#include "io/base/number_text.h"
#include "io/image/image_file.h"
#include "io/recording/frame_order.h"

namespace rubble {
namespace {

std::string camera_line(const Intrinsics& k) {
  const auto& d = k.distortion;
  const bool plain = std::all_of(d.begin(), d.end(), [](double v) { return v == 0; });
  std::string model;
  std::vector<double> numbers{k.fx, k.fy, k.cx + 0.5, k.cy + 0.5};
  if (k.lens == LensModel::fisheye) {
    model = "OPENCV_FISHEYE";
    numbers.insert(numbers.end(), d.begin(), d.begin() + 4);
  } else if (plain) {
    model = "PINHOLE";
  } else {
    model = d[4] == 0 ? "OPENCV" : "FULL_OPENCV";
    numbers.insert(numbers.end(), d.begin(), d.begin() + 4);
    if (d[4] != 0) numbers.insert(numbers.end(), {d[4], 0, 0, 0});  // k3, and no k4 to k6
  }
  std::string line = "1 " + model + " " + std::to_string(k.width) + " " + std::to_string(k.height);
  for (const double number : numbers) line += " " + exact_text(number);
  return line + "\n";
}

class ColmapRecorder : public Recorder {
 public:
  ColmapRecorder(const std::string& path, const Channels& channels, int threads)
      : channels_(channels), order_(path, channels), folder_(path, folders(channels), threads) {}

  void write(const Frame& frame) override {
    order_.check(frame);
    if (frame.index == 0) intrinsics_ = frame.intrinsics;
    const std::string name = index_text(frame.index) + ".png";
    add(name, frame, frame.rgb, 0);
    if (channels_.right) add("right/" + name, frame, frame.rgb_right, frame.baseline);
  }

  void finish() override {
    folder_.write("sparse/cameras.txt",
                  "# CAMERA_ID MODEL WIDTH HEIGHT PARAMS[]\n" + camera_line(intrinsics_));
    folder_.write(
        "sparse/images.txt",
        "# IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME, then POINTS2D[] as X Y POINT3D_ID\n" +
            images_);
    folder_.write("sparse/points3D.txt", "# POINT3D_ID X Y Z R G B ERROR TRACK[]\n");
    folder_.finish();
  }

 private:
  static std::vector<std::string> folders(const Channels& channels) {
    return {channels.right ? "images/right" : "images", "sparse"};
  }

  // right: how far the camera is to the right of the frame's pose; unit: m
  void add(const std::string& name, const Frame& frame, const std::vector<std::uint8_t>& rgb,
           double right) {
    const Intrinsics& k = frame.intrinsics;
    folder_.add("images/" + name,
                [image = RgbImage{k.width, k.height, rgb}] { return encode_png(image); });
    const Pose camera_from_eye{camera_from_optical.rotation, {0, -right, 0}};
    const Pose optical_from_world = (frame.world_from_camera * camera_from_eye).inverse();
    const Quat& q = optical_from_world.rotation;
    const Vec3& t = optical_from_world.translation;
    images_ += std::to_string(++image_count_);
    for (const double value : {q.w, q.x, q.y, q.z, t.x, t.y, t.z})
      images_ += " " + exact_text(value);
    images_ += " 1 " + name + "\n\n";  // no points
  }

  Channels channels_;
  FrameOrder order_;
  FolderWriter folder_;
  Intrinsics intrinsics_;
  int image_count_ = 0;
  std::string images_;  // the list, so far
};

}  // namespace

std::unique_ptr<Recorder> make_colmap_recorder(const std::string& path, const Recording& recording,
                                               int threads) {
  Channels channels;  // what the format has a place for
  channels.right = recording.cameras.front().channels.right;
  return std::make_unique<ColmapRecorder>(path, channels, threads);
}

}  // namespace rubble
