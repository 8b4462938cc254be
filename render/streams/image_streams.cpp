#include "render/streams/image_streams.h"

#include <type_traits>

namespace rubble {
namespace {

// The type of the values that a maker makes.
template <typename T>
T value_type(PixelMaker<T>);

}  // namespace

std::size_t ImageStream::bytes_per_pixel() const {
  static constexpr std::size_t kSizes[] = {0, 1, 2, 4, 4};
  return kSizes[make.index()] * std::size_t(components);
}

const char* ImageStream::ros_encoding() const {
  static constexpr const char* kNames[5][3] = {{"", "", ""},
                                               {"mono8", "8UC2", "rgb8"},
                                               {"16UC1", "16UC2", "16UC3"},
                                               {"32SC1", "32SC2", "32SC3"},
                                               {"32FC1", "32FC2", "32FC3"}};
  return kNames[make.index()][components - 1];
}

ImageValues ImageStream::blank(std::size_t pixels) const {
  const std::size_t count = pixels * std::size_t(components);
  return std::visit(
      [&](const auto& maker) -> ImageValues {
        if constexpr (std::is_same_v<std::decay_t<decltype(maker)>, std::monostate>) {
          return {};
        } else {
          using T = decltype(value_type(maker));
          return std::vector<T>(count, T(nothing));
        }
      },
      make);
}

std::vector<const ImageStream*> truth_streams() {
  std::vector<const ImageStream*> found;
  for (const ImageStream& stream : image_streams())
    if (stream.is_truth()) found.push_back(&stream);
  return found;
}

const ImageStream* find_image_stream(const std::string& name) {
  for (const ImageStream& stream : image_streams())
    if (stream.name == name) return &stream;
  return nullptr;
}

std::optional<ImageView> find_image(const Frame& frame, const ImageStream& stream) {
  if (stream.of) {
    const ImageView view = stream.of(frame);
    return count_values(view) == 0 ? std::nullopt : std::optional(view);
  }
  const auto at = frame.truth.find(stream.name);
  if (at == frame.truth.end()) return std::nullopt;
  return std::visit([](const auto& values) -> ImageView { return &values; }, at->second);
}

}  // namespace rubble
