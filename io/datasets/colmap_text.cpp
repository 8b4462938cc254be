#include <charconv>
#include <cmath>
#include <limits>
#include <sstream>

#include "io/base/atomic_file.h"
#include "io/datasets/colmap_parts.h"
#include "kernel/base/error.h"
#include "kernel/base/tables/text_table.h"

namespace rubble {
namespace {

// A file by its lines, with the errors that a line can have.
class Lines {
 public:
  explicit Lines(std::string path) : path_(std::move(path)), text_(read_whole_file(path_)) {
    at_ = text_.size() - skip_byte_order_mark(text_).size();
  }

  // The next line that says something; false at the end.
  bool next() {
    while (next_any()) {
      const std::size_t first = line_.find_first_not_of(" \t");
      if (first != std::string::npos && line_[first] != '#') return true;
    }
    return false;
  }

  // The next line, whatever it holds.
  bool next_any() {
    if (at_ >= text_.size()) return false;
    const std::size_t end = text_.find('\n', at_);
    line_ = text_.substr(at_, end == std::string::npos ? end : end - at_);
    at_ = end == std::string::npos ? text_.size() : end + 1;
    if (!line_.empty() && line_.back() == '\r') line_.pop_back();
    ++number_;
    words_.clear();
    words_.str(line_);
    return true;
  }

  [[noreturn]] void refuse(const std::string& message, const std::string& expected,
                           const std::string& found) const {
    throw InputError({path_, number_, "", message, expected, found, ""});
  }

  bool at_end_of_line() { return (words_ >> std::ws).eof(); }

  std::string word(const char* what) {
    std::string word;
    if (!(words_ >> word)) refuse("the line ends early", what, "nothing");
    return word;
  }

  std::string rest(const char* what) {
    std::string rest;
    std::getline(words_ >> std::ws, rest);
    while (!rest.empty() && (rest.back() == ' ' || rest.back() == '\t')) rest.pop_back();
    if (rest.empty()) refuse("the line ends early", what, "nothing");
    return rest;
  }

  double number(const char* what) {
    const std::string text = word(what);
    double value = 0;
    if (!parse_colmap_number(text, value)) refuse("not a finite number", what, text);
    return value;
  }

  template <typename T>
  T integer(const char* what) {
    const std::string text = word(what);
    T value = 0;
    const char* last = text.data() + text.size();
    const auto [end, failed] = std::from_chars(text.data(), last, value);
    if (failed != std::errc() || end != last) refuse("not a number", what, text);
    return value;
  }

  std::size_t line_number() const { return std::size_t(number_); }

 private:
  std::string path_, text_, line_;
  std::size_t at_ = 0;
  int number_ = 0;
  std::istringstream words_;
};

std::vector<ColmapCamera> read_text_cameras(const std::string& path) {
  std::vector<ColmapCamera> cameras;
  Lines lines(path);
  while (lines.next()) {
    ColmapCamera camera;
    camera.id = lines.integer<std::uint32_t>("CAMERA_ID");
    camera.model = lines.word("MODEL");
    const std::size_t count = colmap_parameter_count(camera.model);
    if (count == 0) lines.refuse("unknown camera model", "one of COLMAP 3.8", camera.model);
    camera.width = lines.integer<std::uint64_t>("WIDTH");
    camera.height = lines.integer<std::uint64_t>("HEIGHT");
    for (std::size_t i = 0; i < count; ++i) camera.params.push_back(lines.number("PARAMS"));
    if (!lines.at_end_of_line())
      lines.refuse("too many numbers", std::to_string(count) + " of " + camera.model, "more");
    cameras.push_back(camera);
  }
  return cameras;
}

Quat read_rotation(Lines& lines) {
  Quat q;
  q.w = lines.number("QW"), q.x = lines.number("QX");
  q.y = lines.number("QY"), q.z = lines.number("QZ");
  if (q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z < 1e-12)
    lines.refuse("not a rotation", "a quaternion", "0 0 0 0");
  return normalized(q);
}

void read_features(Lines& lines, ColmapImage& image) {
  if (!lines.next_any())
    lines.refuse("the file ends early", "the line with POINTS2D of " + image.name, "nothing");
  while (!lines.at_end_of_line()) {
    ColmapFeature feature;
    feature.x = lines.number("X"), feature.y = lines.number("Y");
    const auto point = lines.integer<std::int64_t>("POINT3D_ID, or -1");
    if (point >= 0) feature.point = std::uint64_t(point);
    image.features.push_back(feature);
  }
}

void read_text_images(const std::string& path, ColmapParts& parts) {
  Lines lines(path);
  while (lines.next()) {
    ColmapImage image;
    parts.places.images.push_back(lines.line_number());
    image.id = lines.integer<std::uint32_t>("IMAGE_ID");
    image.camera_from_world.rotation = read_rotation(lines);
    Vec3& t = image.camera_from_world.translation;
    t.x = lines.number("TX"), t.y = lines.number("TY"), t.z = lines.number("TZ");
    image.camera = lines.integer<std::uint32_t>("CAMERA_ID");
    image.name = lines.rest("NAME");
    read_features(lines, image);
    parts.model.images.push_back(std::move(image));
  }
}

void read_text_points(const std::string& path, ColmapParts& parts) {
  Lines lines(path);
  while (lines.next()) {
    ColmapPoint point;
    parts.places.points.push_back(lines.line_number());
    point.id = lines.integer<std::uint64_t>("POINT3D_ID");
    for (int i = 0; i < 3; ++i) point.position[i] = lines.number("X Y Z");
    for (std::uint8_t& c : point.rgb) c = lines.integer<std::uint8_t>("R G B, 0 to 255");
    point.error = lines.number("ERROR");
    while (!lines.at_end_of_line()) {
      ColmapTrackElement element;
      element.image = lines.integer<std::uint32_t>("IMAGE_ID of the track");
      element.feature = lines.integer<std::uint32_t>("POINT2D_IDX of the track");
      point.track.push_back(element);
    }
    parts.model.points.push_back(std::move(point));
  }
}

}  // namespace

bool parse_colmap_number(const std::string& word, double& value) {
  const auto number = parse_number(word);
  value = number.value_or(0);
  return number && std::isfinite(value);
}

ColmapParts read_colmap_text(const std::string& folder) {
  ColmapParts parts;
  parts.model.folder = folder;
  parts.model.cameras = read_text_cameras(folder + "/cameras.txt");
  read_text_images(folder + "/images.txt", parts);
  read_text_points(folder + "/points3D.txt", parts);
  return parts;
}

}  // namespace rubble
