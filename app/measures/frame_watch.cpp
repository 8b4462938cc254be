#include "app/measures/frame_watch.h"

#include <algorithm>
#include <cmath>

namespace rubble {
namespace {

// The display's dithering is one step.
constexpr int kEven = 2;

bool is_even(const std::vector<std::uint8_t>& rgb) {
  for (std::size_t i = 3; i < rgb.size(); ++i)
    if (std::abs(int(rgb[i]) - int(rgb[i % 3])) > kEven) return false;
  return rgb.size() >= 48;
}

std::string describe(const Frame& frame) {
  const double nearest = [&] {
    double least = 1e9;
    for (const float z : frame.depth)
      if (!std::isnan(z)) least = std::min(least, double(z));
    return least;
  }();
  const bool black = *std::max_element(frame.rgb.begin(), frame.rgb.end()) <= 2 * kEven;
  std::string text = "frame " + std::to_string(frame.index) + " is all one colour (" +
                     std::to_string(frame.rgb[0]) + ", " + std::to_string(frame.rgb[1]) + ", " +
                     std::to_string(frame.rgb[2]) + "); ";
  if (nearest > 1e8)
    text += "it has no surface in view: look at the waypoints' rpy_deg and look_at, and compare with "
            "another device (`rubble info --gl`)";
  else if (nearest < 0.05)
    text += "the camera is against or inside a piece: move its path, or fly with "
            "trajectory.plan = \"avoid\"";
  else if (black)
    text += "nothing lights what it sees: switch lamp.on, or give a longer camera.exposure";
  else
    text += "thick air, an exposure far too long, or a driver that fails: look at air.fog_density and "
            "camera.exposure, and compare with another device (`rubble info --gl`)";
  return text + ". Further frames like it are not reported";
}

}  // namespace

bool FrameWatch::notice(const Frame& frame) {
  if (!warning_.empty() || !is_even(frame.rgb)) return false;
  warning_ = describe(frame);
  return true;
}

}  // namespace rubble
