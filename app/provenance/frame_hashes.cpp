#include "app/provenance/frame_hashes.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <limits>
#include <sstream>

#include "kernel/base/error.h"
#include "kernel/base/hash_pose.h"
#include "render/streams/image_streams.h"

namespace rubble {
namespace {

// After the columns of the cameras, in this order.
constexpr const char* kOfAllCameras[] = {"imu", "robots"};

template <typename T>
std::uint64_t hash_numbers(const std::vector<T>& numbers) {
  if (numbers.empty()) return 0;
  StateHash hash;
  hash.add_bytes(numbers.data(), numbers.size() * sizeof(T));
  return hash.digest();
}

// Where, when and through what the frame was seen.
std::uint64_t hash_pose(const Frame& frame) {
  StateHash hash;
  hash.add(frame.stamp_ns);
  add(hash, frame.world_from_camera);
  const Intrinsics& k = frame.intrinsics;
  hash.add(k.width), hash.add(k.height);
  for (const double c : {k.fx, k.fy, k.cx, k.cy}) hash.add(c);
  for (const double c : k.distortion) hash.add(c);
  hash.add(std::int32_t(k.lens));
  add(hash, frame.linear_velocity);
  hash.add(frame.baseline);
  hash.add(frame.exposure_s);
  return hash.digest();
}

std::uint64_t hash_events(const std::vector<Event>& events) {
  if (events.empty()) return 0;
  StateHash hash;
  for (const Event& e : events) {
    hash.add(e.stamp_ns), hash.add(e.x), hash.add(e.y);
    hash.add(std::uint8_t(e.brighter));
  }
  return hash.digest();
}

std::uint64_t hash_imu(const std::vector<ImuSample>& samples) {
  if (samples.empty()) return 0;
  StateHash hash;
  for (const ImuSample& s : samples) {
    hash.add(s.stamp_ns);
    add(hash, s.angular_velocity);
    add(hash, s.linear_acceleration);
    add(hash, s.angular_bias);
    add(hash, s.acceleration_bias);
  }
  return hash.digest();
}

std::uint64_t hash_robots(const std::vector<RobotSample>& samples) {
  if (samples.empty()) return 0;
  StateHash hash;
  for (const RobotSample& s : samples) {
    hash.add(s.stamp_ns), hash.add(std::int32_t(s.sensor));
    for (const auto* list : {&s.positions, &s.speeds, &s.efforts})
      for (const double value : *list) hash.add(value);
    for (const RobotSample::Wrench& w : s.contacts) add(hash, w.force), add(hash, w.moment);
    add(hash, s.world_from_base);
    add(hash, s.linear_velocity), add(hash, s.angular_velocity);
    if (!s.odometry) continue;
    add(hash, s.odometry->odom_from_base);
    hash.add(s.odometry->linear), hash.add(s.odometry->angular);
  }
  return hash.digest();
}

void add_scan(StateHash& hash, const RangeScan& scan) {
  for (const Pose& pose : scan.world_from_sensor) {
    for (const double c : {pose.rotation.w, pose.rotation.x, pose.rotation.y, pose.rotation.z}) hash.add(c);
    add(hash, pose.translation);
  }
  hash.add_bytes(scan.points.data(), scan.points.size() * sizeof(ScanPoint));
}

std::uint64_t hash_reading(const Reading& reading) {
  StateHash hash;
  hash.add(reading.stamp_ns);
  if (reading.scan) add_scan(hash, *reading.scan);
  for (const double value : reading.values) hash.add(std::isnan(value) ? std::numeric_limits<double>::quiet_NaN() : value);
  return hash.digest();
}

// Of one camera: the pose, every image stream in the order of the table, then what is no image.
std::vector<std::string> channels_of_camera() {
  std::vector<std::string> names{"pose"};
  for (const ImageStream& stream : image_streams()) names.push_back(stream.name);
  names.push_back("events");
  return names;
}

std::vector<std::string> channels_of_sensors(const std::vector<std::string>& cameras,
                                             const std::vector<std::string>& sensors) {
  const std::vector<std::string> each = channels_of_camera();
  std::vector<std::string> all;
  if (cameras.empty()) all = each;
  for (const std::string& camera : cameras)
    for (const std::string& channel : each) all.push_back(camera + "/" + channel);
  all.insert(all.end(), sensors.begin(), sensors.end());
  for (const char* rig : kOfAllCameras) all.push_back(rig);
  return all;
}

std::string without_camera(const std::string& channel) {
  return channel.substr(channel.find('/') + 1);
}

}  // namespace

void FrameHashes::add(const Frame& f) {
  if (channels.empty()) channels = channels_of_sensors(cameras_, sensors_);
  const std::size_t others = sensors_.size() + std::size(kOfAllCameras);
  const std::size_t each = (channels.size() - others) / std::max<std::size_t>(1, cameras_.size());
  std::vector<std::uint64_t>& row = frames.emplace_back(channels.size(), 0);
  auto at = row.begin() + std::ptrdiff_t(std::size_t(f.sensor) * each);
  *at++ = hash_pose(f);
  for (const ImageStream& stream : image_streams()) {
    const auto image = find_image(f, stream);
    *at++ = image ? std::visit([](const auto* values) { return hash_numbers(*values); }, *image) : 0;
  }
  *at = hash_events(f.events);
  for (std::size_t i = 0; i < sensors_.size(); ++i) {
    row[row.size() - others + i] = hash_numbers(values_[i]);
    values_[i].clear();
  }
  row[row.size() - 2] = hash_imu(readings_);
  row.back() = hash_robots(robots_);
  readings_.clear();
  robots_.clear();
}

void FrameHashes::add_imu(const ImuSample& sample) { readings_.push_back(sample); }
void FrameHashes::add_robot(const RobotSample& sample) { robots_.push_back(sample); }

void FrameHashes::add_reading(const Reading& reading) {
  values_.at(std::size_t(reading.sensor)).push_back(hash_reading(reading));
}

FrameHashes FrameHashes::compact() const {
  FrameHashes kept;
  kept.frames.resize(frames.size());
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const bool filled = std::any_of(frames.begin(), frames.end(),
                                    [c](const auto& hashes) { return hashes[c] != 0; });
    if (!filled) continue;
    kept.channels.push_back(channels[c]);
    for (std::size_t i = 0; i < frames.size(); ++i) kept.frames[i].push_back(frames[i][c]);
  }
  return kept;
}

bool is_picture(const std::string& channel) {
  const std::string name = without_camera(channel);
  return name != "pose" && name != "events" && name != "points" && name != "reading" &&
         std::find(std::begin(kOfAllCameras), std::end(kOfAllCameras), name) == std::end(kOfAllCameras);
}

FrameDifference find_difference(const FrameHashes& was, const FrameHashes& is) {
  if (was.channels != is.channels) return {0, "", "the frames have other channels"};
  const std::size_t both = std::min(was.frames.size(), is.frames.size());
  for (std::size_t i = 0; i < both; ++i)
    for (std::size_t c = 0; c < was.channels.size(); ++c)
      if (was.frames[i][c] != is.frames[i][c])
        return {int(i), was.channels[c],
                "frame " + std::to_string(i) + " is the first that differs, in its " +
                    was.channels[c] + ": " + hex64(is.frames[i][c]) + " instead of " +
                    hex64(was.frames[i][c])};
  if (was.frames.size() == is.frames.size()) return {};
  return {
      int(both), "",
      std::to_string(is.frames.size()) + " frames instead of " + std::to_string(was.frames.size())};
}

std::string format_hashes(const std::vector<std::uint64_t>& hashes) {
  std::string text;
  for (const std::uint64_t hash : hashes) text += (text.empty() ? "" : " ") + hex64(hash);
  return text;
}

bool parse_hashes(const std::string& text, std::vector<std::uint64_t>& hashes) {
  hashes.clear();
  std::istringstream in(text);
  for (std::string word; in >> word;) {
    std::uint64_t value = 0;
    const char* const end = word.data() + word.size();
    const auto read = std::from_chars(word.data(), end, value, 16);
    if (read.ec != std::errc() || read.ptr != end) return false;
    hashes.push_back(value);
  }
  return true;
}

FrameJournal::FrameJournal(const std::string& path) : file_(path) {
  const std::string text = file_.read_all();
  std::size_t end = 0;
  for (std::size_t begin = 0; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1)
    lines_.push_back(text.substr(begin, end - begin));
  const std::size_t whole = text.rfind('\n') + 1;
  if (whole < text.size()) file_.cut(whole);
}

void FrameJournal::note(std::size_t index, const std::vector<std::uint64_t>& hashes) {
  const std::string line = format_hashes(hashes);
  if (index >= lines_.size()) return file_.append(line + "\n");
  if (lines_[index] == line) return;
  throw RunError("frame " + std::to_string(index) +
                 " is not the one that was rendered before the run was interrupted: has the "
                 "graphics driver changed? Start again with --force");
}

}  // namespace rubble
