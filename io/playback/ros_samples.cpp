#include "io/playback/ros_samples.h"

#include <algorithm>
#include <iterator>
#include <optional>

#include "io/image/picture_decoder.h"
#include "io/playback/picture_sources.h"
#include "io/playback/wire_reader.h"
#include "kernel/base/error.h"
#include "render/streams/image_streams.h"

namespace rubble {
namespace {

bool ends_with(const std::string& text, const char* end) {
  const std::string tail = end;
  return text.size() >= tail.size() && text.compare(text.size() - tail.size(), tail.size(), tail) == 0;
}

void walk(const std::string& path, const TakeRosMessage& take) {
  const std::optional<FileFault> fault = ends_with(path, ".bag") ? read_bag(path, take) : read_mcap(path, take);
  if (fault)
    throw InputError({path, 0, "", "is damaged at byte " + std::to_string(fault->byte), "a whole recording", fault->what,
                      "`rubble info FILE` tells how much of it can be read"});
}

// A sensor_msgs/CompressedImage of colour or of depth in millimetres. Throws RunError: the picture is damaged.
std::optional<RecordedPicture> read_compressed_image(const RosMessage& message, bool is_depth, RosLosses& losses) {
  WireReader wire(message);
  wire.header();
  const std::string format = wire.text();
  std::string_view data = wire.block();
  if (!wire.sound()) return std::nullopt;
  RecordedPicture picture;
  if (is_depth) {
    constexpr std::size_t kHead = 12;  // of compressedDepth
    const PngPixels pixels = read_png_pixels(data.substr(std::min(kHead, data.size())));
    picture = {"", pixels.width, pixels.height, 1, {}, 0.001};
    for (const std::uint16_t value : pixels.values) picture.values.push_back(picture.step * value);
    return picture;
  }
  losses.jpeg = losses.jpeg || format.find("jpeg") != std::string::npos;
  const RgbaImage pixels = decode_picture(data);
  picture = {"", pixels.width, pixels.height, 3, {}, 0};
  for (std::size_t i = 0; i < pixels.rgba.size(); ++i)
    if (i % 4 != 3) picture.values.push_back(pixels.rgba[i]);
  return picture;
}

// Puts the messages of one camera together to frames.
class FrameMaker {
 public:
  FrameMaker(const RosSampleSource& source, int camera) : source_(source), camera_(camera) {
    const CameraRecord& c = record();
    const std::string depth = c.topic + "/depth_registered/image";
    expect({c.topic + "/rgb/image_raw", c.topic + "/rgb/image_raw/compressed"}, "rgb");
    expect({depth, depth + "_raw", depth + "_raw/compressedDepth"}, c.channels.measured_depth ? "measured_depth" : "depth");
    if (c.channels.right) expect({c.topic + "/right/image_raw", c.topic + "/right/image_raw/compressed"}, "rgb_right");
    if (c.channels.measured_depth) expect({c.truth_topic + "/depth/image"}, "depth");
    for (const ImageStream* stream : c.channels.truth) expect({c.truth_topic + "/" + stream->name + "/image"}, stream->name);
    if (c.channels.events) expect({c.topic + "/events"}, "events");
  }

  // Whether the message is one of this camera; afterwards `done` says whether a frame is complete.
  bool take(const RosMessage& message, RosLosses& losses) {
    const auto found = topics_.find(std::string(message.topic));
    if (found == topics_.end()) return false;
    const std::string& channel = channels_[found->second];
    const std::int64_t stamp_ns = WireReader(message).header();
    if (got_.empty()) {
      frame_ = {};
      frame_.stamp_ns = stamp_ns;
    }
    if (stamp_ns != frame_.stamp_ns) fail_incomplete();
    if (channel == "events")
      read_events(message);
    else
      read_picture(message, channel, losses);
    got_.push_back(found->second);
    return true;
  }

  bool complete() const { return got_.size() == channels_.size(); }
  bool begun() const { return !got_.empty(); }

  // rig: its poses by stamp.
  Frame finish(const std::map<std::int64_t, Pose>& rig) {
    got_.clear();
    Frame frame = std::move(frame_);
    frame.sensor = camera_;
    frame.index = count_++;
    frame.intrinsics = source_.intrinsics.at(std::size_t(camera_));
    frame.baseline = record().baseline;
    const auto& carrier = record().carrier.empty() ? rig : source_.carriers.at(std::size_t(camera_));
    const auto at = carrier.find(frame.stamp_ns);
    if (at == carrier.end())
      fail("there is no true pose at the stamp of frame " + std::to_string(frame.index) + ", " + std::to_string(frame.stamp_ns) + " ns",
           record().carrier.empty() ? "/ground_truth/pose" : "a line of groundtruth.txt");
    frame.world_from_rig = at->second;
    frame.world_from_camera = record().is_rig() ? at->second : at->second * record().rig_from_camera;
    frame.rig_velocity = velocity_at(carrier, frame.stamp_ns, {});
    frame.linear_velocity = velocity_at(carrier, frame.stamp_ns, record().rig_from_camera.translation);
    return frame;
  }

  [[noreturn]] void fail_incomplete() const {
    std::string missing, hint;
    for (std::size_t i = 0; i < channels_.size(); ++i) {
      if (std::find(got_.begin(), got_.end(), i) != got_.end()) continue;
      missing += (missing.empty() ? "" : ", ") + channels_[i];
      const ImageStream* stream = find_image_stream(channels_[i]);
      if (stream && stream->is_truth() && stream->components > 1)
        hint = "a recording with outputs.vectors = \"colours\" does not hold the values of " + stream->name;
    }
    fail("frame " + std::to_string(count_) + " of " + record().name + " is not whole", missing, hint);
  }

 private:
  const CameraRecord& record() const { return source_.recording.cameras[std::size_t(camera_)]; }

  void expect(const std::vector<std::string>& topics, const std::string& channel) {
    for (const std::string& topic : topics) topics_[topic] = channels_.size();
    channels_.push_back(channel);
  }

  [[noreturn]] void fail(const std::string& what, const std::string& missing, const std::string& hint = "") const {
    throw InputError({source_.path, 0, "", what, "all that the mission records", "without " + missing, hint});
  }

  void read_picture(const RosMessage& message, const std::string& channel, RosLosses& losses) {
    const bool depth = channel == "depth" || channel == "measured_depth";
    const bool packed = ends_with(std::string(message.topic), "/compressed") || ends_with(std::string(message.topic), "/compressedDepth");
    std::optional<RecordedPicture> picture;
    try {
      picture = packed ? read_compressed_image(message, depth, losses) : read_ros_image(message, depth);
    } catch (const RunError& error) {
      fail("frame " + std::to_string(count_) + ": the picture of " + std::string(message.topic) + " " + error.what(), channel);
    }
    const Intrinsics& k = source_.intrinsics.at(std::size_t(camera_));
    if (!picture || picture->width != k.width || picture->height != k.height)
      fail("frame " + std::to_string(count_) + " has a damaged picture in " + std::string(message.topic), channel);
    losses.whole_millimetres = losses.whole_millimetres || picture->step > 0;
    put_picture(*picture, channel, frame_);
  }

  void read_events(const RosMessage& message) {
    WireReader wire(message);
    wire.header();
    wire.number<std::uint32_t>(), wire.number<std::uint32_t>();  // height, width
    for (std::uint32_t left = wire.number<std::uint32_t>(); left > 0 && wire.sound(); --left) {
      Event event;
      event.x = wire.number<std::uint16_t>(), event.y = wire.number<std::uint16_t>();
      event.stamp_ns = std::int64_t(wire.number<std::uint32_t>()) * 1'000'000'000;
      event.stamp_ns += wire.number<std::uint32_t>();
      event.brighter = wire.number<std::uint8_t>() != 0;
      frame_.events.push_back(event);
    }
    if (!wire.sound()) fail("frame " + std::to_string(count_) + " has damaged events", "events");
  }

  const RosSampleSource& source_;
  int camera_;
  int count_ = 0;                              // frames so far
  std::map<std::string, std::size_t> topics_;  // to the channel
  std::vector<std::string> channels_;          // one message of each makes a frame
  std::vector<std::size_t> got_;               // of the open frame
  Frame frame_;                                // the open one
};

}  // namespace

Vec3 velocity_at(const std::map<std::int64_t, Pose>& world_from_body, std::int64_t stamp_ns, const Vec3& point) {
  const auto at = world_from_body.find(stamp_ns);
  const auto before = at == world_from_body.begin() ? at : std::prev(at);
  const auto after = std::next(at) == world_from_body.end() ? at : std::next(at);
  if (before == after) return {};
  return (after->second * point - before->second * point) * (1e9 / double(after->first - before->first));
}

RosLosses read_ros_frames(const RosSampleSource& source, const std::function<void(Frame)>& take) {
  std::vector<FrameMaker> makers;
  for (std::size_t i = 0; i < source.recording.cameras.size(); ++i) makers.emplace_back(source, int(i));
  std::map<std::int64_t, Pose> rig;
  RosLosses losses;
  // First of all, as the velocity at a pose depends on the next one.
  walk(source.path, [&](const RosMessage& message) {
    if (message.topic != "/ground_truth/pose") return true;
    WireReader wire(message);
    const std::int64_t stamp_ns = wire.header();
    rig[stamp_ns] = wire.pose();
    return true;
  });
  walk(source.path, [&](const RosMessage& message) {
    for (FrameMaker& maker : makers)
      if (maker.take(message, losses)) {
        if (maker.complete()) take(maker.finish(rig));
        break;
      }
    return true;
  });
  for (const FrameMaker& maker : makers)
    if (maker.begun()) maker.fail_incomplete();
  return losses;
}

std::vector<ImuSample> read_ros_imus(const std::string& path, const Recording& recording) {
  std::vector<ImuSample> samples;
  walk(path, [&](const RosMessage& message) {
    for (std::size_t i = 0; i < recording.imus.size(); ++i) {
      if (message.topic != recording.imus[i].topic) continue;
      WireReader wire(message);
      ImuSample& sample = samples.emplace_back();
      sample.sensor = int(i);
      sample.stamp_ns = wire.header();
      wire.skip_doubles(4 + 9);  // no orientation
      sample.angular_velocity = wire.vector();
      wire.skip_doubles(9);
      sample.linear_acceleration = wire.vector();
    }
    return true;
  });
  return samples;
}

}  // namespace rubble
