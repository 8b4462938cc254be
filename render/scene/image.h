// The pixels of one image stream.
#pragma once

#include <cstddef>
#include <cstdint>
#include <variant>
#include <vector>

namespace rubble {

// Rows from the top, the components of a pixel side by side. The type is the stream's.
using ImageValues = std::variant<std::vector<std::uint8_t>, std::vector<std::uint16_t>,
                                 std::vector<std::uint32_t>, std::vector<float>>;

// The same where it lies in a frame.
using ImageView = std::variant<const std::vector<std::uint8_t>*, const std::vector<std::uint16_t>*,
                               const std::vector<std::uint32_t>*, const std::vector<float>*>;

inline std::size_t count_values(const ImageView& view) {
  return std::visit([](const auto* values) { return values->size(); }, view);
}

}  // namespace rubble
