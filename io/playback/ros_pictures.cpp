#include "io/playback/picture_sources.h"

#include "io/playback/wire_reader.h"

namespace rubble {
namespace {

template <typename T>
std::vector<double> unpack(std::string_view data) {
  std::vector<double> values;
  values.reserve(data.size() / sizeof(T));
  for (T value; take(data, value);) values.push_back(static_cast<double>(value));
  return values;
}

struct Encoding {
  const char* name;
  int components;
  std::vector<double> (*unpack)(std::string_view);
};
const Encoding kEncodings[] = {
    {"rgb8", 3, unpack<std::uint8_t>},   {"mono8", 1, unpack<std::uint8_t>},
    {"8UC2", 2, unpack<std::uint8_t>},   {"16UC1", 1, unpack<std::uint16_t>},
    {"16UC2", 2, unpack<std::uint16_t>}, {"16UC3", 3, unpack<std::uint16_t>},
    {"32FC1", 1, unpack<float>},         {"32FC2", 2, unpack<float>},
    {"32FC3", 3, unpack<float>},         {"32SC1", 1, unpack<std::uint32_t>},
    {"32SC2", 2, unpack<std::uint32_t>}, {"32SC3", 3, unpack<std::uint32_t>}};

}  // namespace

std::optional<RecordedPicture> read_ros_image(const RosMessage& message, bool is_depth) {
  WireReader wire(message);
  wire.header();
  RecordedPicture picture;
  const auto height = wire.number<std::uint32_t>(), width = wire.number<std::uint32_t>();
  picture.height = static_cast<int>(height);
  picture.width = static_cast<int>(width);
  const std::string encoding = wire.text();
  wire.number<std::uint8_t>(), wire.number<std::uint32_t>();  // byte order, bytes of a row
  const std::string_view data = wire.block();
  if (!wire.sound()) return std::nullopt;
  for (const Encoding& known : kEncodings) {
    if (encoding != known.name) continue;
    picture.components = known.components;
    picture.values = known.unpack(data);
    const std::uint64_t pixels = std::uint64_t(height) * width;
    if (picture.values.size() % std::size_t(known.components) != 0 ||
        picture.values.size() / std::size_t(known.components) != pixels)
      return std::nullopt;
    if (is_depth && encoding == "16UC1") {
      picture.step = 0.001;
      for (double& value : picture.values) value *= picture.step;
    }
    return picture;
  }
  return std::nullopt;
}

namespace {

// Where a channel is, in the order of trust.
std::vector<std::string> topics_of(const PictureWanted& wanted) {
  const std::string& c = wanted.channel;
  const bool several = !wanted.camera.empty();
  const std::string camera = !wanted.topic.empty() ? wanted.topic : several ? "/" + wanted.camera : "/camera";
  const std::string truth = several ? camera + "/ground_truth/" : "/ground_truth/";
  if (c == "rgb") return {camera + "/rgb/image_raw"};
  if (c == "rgb_right") return {camera + "/right/image_raw"};
  if (c == "depth" && wanted.measured_depth) return {truth + "depth/image"};
  if (c == "depth" || c == "measured_depth")
    return {camera + "/depth_registered/image", camera + "/depth_registered/image_raw"};
  return {truth + c + "/image"};
}

}  // namespace

std::optional<RecordedPicture> find_ros_picture(const std::string& folder, const std::string& name,
                                                const PictureWanted& wanted) {
  const std::vector<std::string> topics = topics_of(wanted);
  const bool is_depth = wanted.channel == "depth" || wanted.channel == "measured_depth";
  std::optional<RecordedPicture> picture;
  int left = wanted.frame;
  const auto look = [&](const RosMessage& message) {
    for (const std::string& topic : topics)
      if (message.topic == topic && left-- == 0) picture = read_ros_image(message, is_depth);
    return left >= 0;
  };
  const std::string path = folder + "/" + name;
  name == "mission.bag" ? read_bag(path, look) : read_mcap(path, look);
  if (!picture) return std::nullopt;
  picture->file = name;
  return picture;
}

}  // namespace rubble
