#include "io/datasets/frames_recorder.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "io/base/folder_writer.h"
#include "io/image/exr_file.h"
#include "io/image/flow_file.h"
#include "io/image/image_file.h"
#include "io/recording/frame_order.h"
#include "kernel/base/number_text.h"
#include "render/streams/image_streams.h"

namespace rubble {
namespace {

std::string vector_columns(const Vec3& v) {
  return "," + exact_text(v.x) + "," + exact_text(v.y) + "," + exact_text(v.z);
}

std::string camera_json(const Intrinsics& k, double baseline) {
  const nlohmann::ordered_json json{
      {"width", k.width},
      {"height", k.height},
      {"fx", k.fx},
      {"fy", k.fy},
      {"cx", k.cx},
      {"cy", k.cy},
      {"lens", k.lens == LensModel::fisheye ? "fisheye" : "plumb_bob"},
      {"distortion", k.distortion},
      {"baseline", baseline}};
  return json.dump(2) + "\n";
}

// Piece numbers as 32-bit signed integers, so that the ground is -1 and nothing -2, in floats: readers
// of EXR files that know no integers make floats of them anyway, and could not tell the two apart.
std::vector<float> signed_numbers(const std::vector<std::uint32_t>& instance) {
  constexpr std::int32_t kMost = 1 << 24;  // floats hold all integers up to it
  std::vector<float> out;
  out.reserve(instance.size());
  for (const std::uint32_t id : instance) {
    const auto number = std::int32_t(id);
    if (number < -2 || number > kMost)
      throw RunError("piece " + std::to_string(id) + " has no number that an EXR file can hold");
    out.push_back(float(number));
  }
  return out;
}

std::vector<std::string> exr_names(int components) {
  if (components == 1) return {"Y"};
  return components == 2 ? std::vector<std::string>{"R", "G"}
                         : std::vector<std::string>{"R", "G", "B"};
}

class FramesRecorder : public Recorder {
 public:
  FramesRecorder(const std::string& path, const Recording& recording, int threads)
      : recording_(recording),
        channels_(recording.cameras.front().channels),
        order_(path, channels_),
        folder_(path, folders(channels_), threads) {}

  void write(const Frame& frame) override {
    order_.check(frame);
    if (frame.index == 0) camera_ = camera_json(frame.intrinsics, frame.baseline);
    add_colours(frame);
    add_depths(frame);
    add_ground_truth(frame);
    add_rows(frame);
  }

  void write_imu(const ImuSample& s) override {
    if (s.sensor != std::max(0, find_imu_beside(recording_, 0))) return;
    imu_ += std::to_string(s.stamp_ns) + vector_columns(s.angular_velocity) +
            vector_columns(s.linear_acceleration) + vector_columns(s.angular_bias) +
            vector_columns(s.acceleration_bias) + "\n";
  }

  void finish() override {
    folder_.write("camera.json", camera_);
    folder_.write("poses.csv", poses_);
    if (!recording_.imus.empty()) folder_.write("imu.csv", imu_);
    if (channels_.events) folder_.write("events.txt", events_);
    if (channels_.has_legend())
      folder_.write("legend.json", legend_to_json(recording_.legend) + "\n");
    folder_.finish();
  }

 private:
  static std::vector<std::string> folders(const Channels& c) {
    std::vector<std::string> names{"rgb", "depth"};
    const auto add = [&](bool wanted, const char* name) {
      if (wanted) names.push_back(name);
    };
    add(c.right, "right");
    add(c.measured_depth, "depth_true");
    for (const ImageStream* stream : c.truth) names.push_back(stream->name);
    return names;
  }

  static std::string name(const std::string& channel, const Frame& frame, const char* suffix) {
    return std::string(channel) + "/" + index_text(frame.index) + suffix;
  }

  void add_png(const char* channel, const Frame& frame, const std::vector<std::uint8_t>& rgb) {
    const Intrinsics& k = frame.intrinsics;
    folder_.add(name(channel, frame, ".png"),
                [image = RgbImage{k.width, k.height, rgb}] { return encode_png(image); });
  }

  void add_exr(const std::string& channel, const Frame& frame, std::vector<std::string> names,
               const std::vector<float>& values) {
    const int width = frame.intrinsics.width, height = frame.intrinsics.height;
    folder_.add(name(channel, frame, ".exr"), [width, height, names = std::move(names), values] {
      return encode_exr(width, height, names, values);
    });
  }

  void add_colours(const Frame& frame) {
    add_png("rgb", frame, frame.rgb);
    if (channels_.right) add_png("right", frame, frame.rgb_right);
  }

  void add_depths(const Frame& frame) {
    const bool measured = channels_.measured_depth;
    add_exr("depth", frame, {"Y"}, measured ? frame.measured_depth : frame.depth);
    if (measured) add_exr("depth_true", frame, {"Y"}, frame.depth);
  }

  void add_ground_truth(const Frame& frame) {
    const Channels& c = channels_;
    const int width = frame.intrinsics.width, height = frame.intrinsics.height;
    for (const ImageStream* stream : c.truth)
      std::visit([&](const auto* values) { add_image(*stream, frame, width, height, *values); },
                 *find_image(frame, *stream));
  }

  void add_image(const ImageStream& stream, const Frame& frame, int, int,
                 const std::vector<std::uint32_t>& values) {
    add_exr(stream.name, frame, exr_names(stream.components), signed_numbers(values));
  }
  void add_image(const ImageStream& stream, const Frame& frame, int width, int height,
                 const std::vector<float>& values) {
    if (stream.file != ImageFile::flo)
      return add_exr(stream.name, frame, exr_names(stream.components), values);
    folder_.add(name(stream.name, frame, ".flo"),
                [width, height, values] { return encode_flow(width, height, values); });
  }
  void add_image(const ImageStream& stream, const Frame& frame, int width, int height,
                 const std::vector<std::uint16_t>& values) {
    folder_.add(name(stream.name, frame, ".png"),
                [image = DepthImage{width, height, values}] { return encode_png(image); });
  }
  void add_image(const ImageStream& stream, const Frame& frame, int width, int height,
                 const std::vector<std::uint8_t>& values) {
    folder_.add(name(stream.name, frame, ".png"), [width, height, values, stream] {
      return stream.components == 3 ? encode_png(RgbImage{width, height, values})
                                    : encode_png(GrayImage{width, height, values});
    });
  }

  void add_rows(const Frame& frame) {
    const Quat& q = frame.world_from_camera.rotation;
    poses_ += std::to_string(frame.index) + "," + std::to_string(frame.stamp_ns) +
              vector_columns(frame.world_from_camera.translation) + "," + exact_text(q.w) +
              vector_columns({q.x, q.y, q.z}) + vector_columns(frame.linear_velocity) + "\n";
    if (!channels_.events) return;
    for (const Event& e : frame.events) {
      events_ += seconds_text(e.stamp_ns) + " " + std::to_string(e.x) + " " + std::to_string(e.y) +
                 (e.brighter ? " 1\n" : " 0\n");
    }
  }

  Recording recording_;
  Channels channels_;
  FrameOrder order_;
  FolderWriter folder_;
  std::string camera_;
  // The tables, so far.
  std::string poses_ = "frame,stamp_ns,x,y,z,qw,qx,qy,qz,vx,vy,vz\n";
  std::string imu_ = "stamp_ns,wx,wy,wz,ax,ay,az,bias_wx,bias_wy,bias_wz,bias_ax,bias_ay,bias_az\n";
  std::string events_;
};

}  // namespace

std::unique_ptr<Recorder> make_frames_recorder(const std::string& path, const Recording& recording,
                                               int threads) {
  return std::make_unique<FramesRecorder>(path, recording, threads);
}

}  // namespace rubble
