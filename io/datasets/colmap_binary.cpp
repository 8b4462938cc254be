#include <cmath>

#include "io/base/atomic_file.h"
#include "io/base/little_endian.h"
#include "io/datasets/colmap_parts.h"
#include "kernel/base/error.h"

namespace rubble {
namespace {

// A file by its numbers, with the place of what is missing or wrong.
class Bytes {
 public:
  explicit Bytes(std::string path)
      : path_(std::move(path)), bytes_(read_whole_file(path_)), rest_(bytes_) {}

  std::size_t position() const { return bytes_.size() - rest_.size(); }

  [[noreturn]] void refuse(const std::string& message, const std::string& expected,
                           const std::string& found, std::size_t position) const {
    throw InputError({path_, 0, "byte " + std::to_string(position), message, expected, found, ""});
  }

  template <typename T>
  T read(const char* what) {
    T value{};
    if (!take(rest_, value))
      refuse("the file ends early", what, std::to_string(rest_.size()) + " bytes", position());
    return value;
  }

  double number(const char* what) {
    const std::size_t at = position();
    const double value = read<double>(what);
    if (!std::isfinite(value)) refuse("not finite", what, std::to_string(value), at);
    return value;
  }

  // A count of items of at least `size` bytes each, which the file can hold.
  std::uint64_t count(const char* what, std::size_t size) {
    const std::size_t at = position();
    const auto n = read<std::uint64_t>(what);
    if (n > rest_.size() / size)
      refuse("the file ends early", std::to_string(n) + " " + what,
             std::to_string(rest_.size()) + " bytes", at);
    return n;
  }

  std::string text(const char* what) {
    const std::size_t end = rest_.find('\0');
    if (end == std::string_view::npos)
      refuse("the file ends early", what, "no end of the text", position());
    const std::string text(rest_.substr(0, end));
    rest_.remove_prefix(end + 1);
    return text;
  }

  void end() const {
    if (!rest_.empty())
      refuse("more than was announced", "the end of the file",
             std::to_string(rest_.size()) + " bytes", position());
  }

 private:
  std::string path_, bytes_;
  std::string_view rest_;
};

std::vector<ColmapCamera> read_binary_cameras(const std::string& path) {
  Bytes bytes(path);
  std::vector<ColmapCamera> cameras(bytes.count("cameras", 24));
  for (ColmapCamera& camera : cameras) {
    camera.id = bytes.read<std::uint32_t>("the id of a camera");
    const std::size_t at = bytes.position();
    const int model = bytes.read<std::int32_t>("the model of a camera");
    camera.model = colmap_model_name(model);
    if (camera.model.empty())
      bytes.refuse("unknown camera model", "0 to 10", std::to_string(model), at);
    camera.width = bytes.read<std::uint64_t>("a width");
    camera.height = bytes.read<std::uint64_t>("a height");
    camera.params.resize(colmap_parameter_count(camera.model));
    for (double& p : camera.params) p = bytes.number("a parameter of a camera");
  }
  bytes.end();
  return cameras;
}

Pose read_pose(Bytes& bytes) {
  const std::size_t at = bytes.position();
  Pose pose;
  Quat& q = pose.rotation;
  for (double* v : {&q.w, &q.x, &q.y, &q.z}) *v = bytes.number("a rotation");
  for (int i = 0; i < 3; ++i) pose.translation[i] = bytes.number("a translation");
  if (q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z < 1e-12)
    bytes.refuse("not a rotation", "a quaternion", "0 0 0 0", at);
  q = normalized(q);
  return pose;
}

void read_binary_images(const std::string& path, ColmapParts& parts) {
  Bytes bytes(path);
  parts.model.images.resize(bytes.count("images", 73));
  for (ColmapImage& image : parts.model.images) {
    parts.places.images.push_back(bytes.position());
    image.id = bytes.read<std::uint32_t>("the id of an image");
    image.camera_from_world = read_pose(bytes);
    image.camera = bytes.read<std::uint32_t>("the camera of an image");
    image.name = bytes.text("the name of an image");
    image.features.resize(bytes.count("features of an image", 24));
    for (ColmapFeature& feature : image.features) {
      feature.x = bytes.number("a feature"), feature.y = bytes.number("a feature");
      feature.point = bytes.read<std::uint64_t>("the point of a feature");
    }
  }
  bytes.end();
}

void read_binary_points(const std::string& path, ColmapParts& parts) {
  Bytes bytes(path);
  parts.model.points.resize(bytes.count("points", 51));
  for (ColmapPoint& point : parts.model.points) {
    parts.places.points.push_back(bytes.position());
    point.id = bytes.read<std::uint64_t>("the id of a point");
    for (int i = 0; i < 3; ++i) point.position[i] = bytes.number("the position of a point");
    for (std::uint8_t& c : point.rgb) c = bytes.read<std::uint8_t>("the colour of a point");
    point.error = bytes.number("the error of a point");
    point.track.resize(bytes.count("elements of a track", 8));
    for (ColmapTrackElement& element : point.track) {
      element.image = bytes.read<std::uint32_t>("the image of a track");
      element.feature = bytes.read<std::uint32_t>("the feature of a track");
    }
  }
  bytes.end();
}

}  // namespace

ColmapParts read_colmap_binary(const std::string& folder) {
  ColmapParts parts;
  parts.model.folder = folder;
  parts.model.cameras = read_binary_cameras(folder + "/cameras.bin");
  read_binary_images(folder + "/images.bin", parts);
  read_binary_points(folder + "/points3D.bin", parts);
  return parts;
}

}  // namespace rubble
