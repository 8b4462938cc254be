#include "io/ros/vector_colours.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "kernel/base/portable_math.h"

namespace rubble {
namespace {

using Colour = std::array<std::uint8_t, 3>;

constexpr double kFullColour = 1.0 / 16;  // of the width: a longer flow has no stronger colour

// share: 0 to 1.
std::uint8_t byte_of(double share) { return static_cast<std::uint8_t>(std::floor(share * 255 + 0.5)); }

Colour direction_colour(const float* v, int width) {
  const double x = double(v[0]), y = double(v[1]);
  const double strength = std::min(1.0, std::sqrt(x * x + y * y) / (kFullColour * width));
  const double turn = portable::atan2(y, x) / (2 * portable::kPi);
  const double hue = 6 * (turn - std::floor(turn));
  Colour colour;
  for (int i = 0; i < 3; ++i) {  // red, green and blue rise and fall, a third of a turn after each other
    const double from = hue - 2 * i, away = std::min(std::fabs(from), 6 - std::fabs(from));
    const double pure = std::clamp(2 - away, 0.0, 1.0);
    colour[std::size_t(i)] = byte_of(1 - strength * (1 - pure));
  }
  return colour;
}

Colour triple_colour(const float* v, bool unit_vector) {
  Colour colour;
  for (std::size_t i = 0; i < 3; ++i) {
    const double value = double(v[i]);
    colour[i] = byte_of(unit_vector ? std::clamp((value + 1) / 2, 0.0, 1.0) : value - std::floor(value));
  }
  return colour;
}

}  // namespace

std::vector<std::uint8_t> colour_vectors(const ImageStream& stream, const std::vector<float>& values, int width) {
  const auto components = std::size_t(stream.components);
  std::vector<std::uint8_t> rgb;
  rgb.reserve(3 * values.size() / components);
  for (std::size_t at = 0; at + components <= values.size(); at += components) {
    const float* v = &values[at];
    Colour colour{};
    if (std::all_of(v, v + components, [](float value) { return std::isfinite(value); }))
      colour = components == 2 ? direction_colour(v, width) : triple_colour(v, stream.unit.empty());
    rgb.insert(rgb.end(), colour.begin(), colour.end());
  }
  return rgb;
}

}  // namespace rubble
