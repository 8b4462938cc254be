#include "tests/io/ros_expectation.h"

#include <nlohmann/json.hpp>

#include "io/base/atomic_file.h"
#include "io/image/image_file.h"

namespace rubble::test {
namespace {

using Json = nlohmann::json;

Json stamp_json(std::int64_t stamp_ns) {
  return {{"sec", stamp_ns / 1000000000}, {"nsec", stamp_ns % 1000000000}};
}

Json vector_json(const Vec3& v) { return {v.x, v.y, v.z}; }

Json frame_json(const Frame& frame, const std::vector<ImuSample>& imu) {
  const Quat& q = frame.world_from_camera.rotation;
  Json json{{"stamp", stamp_json(frame.stamp_ns)},
            {"translation", vector_json(frame.world_from_camera.translation)},
            {"rotation", {q.w, q.x, q.y, q.z}},
            {"events", Json::array()},
            {"imu", Json::array()}};
  for (const Event& e : frame.events)
    json["events"].push_back({e.x, e.y, stamp_json(e.stamp_ns), e.brighter});
  for (const ImuSample& s : imu) {
    json["imu"].push_back({{"stamp", stamp_json(s.stamp_ns)},
                           {"angular_velocity", vector_json(s.angular_velocity)},
                           {"linear_acceleration", vector_json(s.linear_acceleration)}});
  }
  return json;
}

template <typename T>
void write_values(const std::string& path, const std::vector<T>& values) {
  write_text_file(path, {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)});
}

void write_pictures(const std::string& stem, const Frame& frame, const RosVariant& variant) {
  write_values(stem + ".rgb", frame.rgb);
  const auto& depth = variant.channels ? frame.measured_depth : frame.depth;
  if (variant.depth == RosDepth::millimetres)
    write_values(stem + ".depth", encode_depth(depth, 0.001));
  else
    write_values(stem + ".depth", depth);
  write_values(stem + ".true_depth", frame.depth);
  write_values(stem + ".right", frame.rgb_right);
  write_values(stem + ".normals", frame.get<float>("normals"));
  write_values(stem + ".flow", frame.get<float>("flow"));
  write_values(stem + ".sky", frame.get<float>("sky_visibility"));
  write_values(stem + ".instance", frame.get<std::uint32_t>("instance"));
  write_values(stem + ".label", frame.get<std::uint16_t>("label"));
}

}  // namespace

RosOptions options_of(const RosVariant& variant) {
  RosOptions options;
  options.depth = variant.depth;
  if (variant.channels) options.recording = full_recording();
  return options;
}

void record_and_expect(Recorder& recorder, const ScratchFolder& folder, const RosVariant& variant) {
  const Intrinsics k = make_frame(0).intrinsics;
  const ImuModel model = full_recording().imus.front().model;
  Json json{{"ros2", variant.version == ros::Version::ros2},
            {"width", k.width},
            {"height", k.height},
            {"depth", variant.depth == RosDepth::millimetres ? "16UC1" : "32FC1"},
            {"K", {k.fx, 0, k.cx, 0, k.fy, k.cy, 0, 0, 1}},
            {"D", k.distortion},
            {"channels", variant.channels},
            {"baseline", make_full_frame(0).baseline},
            {"gyroscope_variance", model.gyroscope_noise * model.gyroscope_noise *
                                       model.rate_hz}};
  for (int i = 0; i < kRosFrames; ++i) {
    const Frame frame = variant.channels ? make_full_frame(i) : make_frame(i);
    const std::vector<ImuSample> imu =
        variant.channels ? make_full_imu(i) : std::vector<ImuSample>();
    for (const ImuSample& sample : imu) recorder.write_imu(sample);
    recorder.write(frame);
    json["frames"].push_back(frame_json(frame, imu));
    write_pictures(folder / std::to_string(i), frame, variant);
  }
  recorder.finish();
  write_text_file(folder / "expected.json", json.dump());
}

}  // namespace rubble::test
