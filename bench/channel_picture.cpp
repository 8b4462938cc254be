#include "bench/channel_picture.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "kernel/base/error.h"
#include "kernel/base/math.h"
#include "render/streams/image_streams.h"

namespace rubble {
namespace {

using Colour = std::array<double, 3>;  // 0 to 1, as displayed

RgbImage paint(const Frame& frame, const std::function<Colour(std::size_t)>& colour_of) {
  RgbImage image{frame.intrinsics.width, frame.intrinsics.height, {}};
  const std::size_t pixels = std::size_t(image.width) * std::size_t(image.height);
  for (std::size_t i = 0; i < pixels; ++i)
    for (const double c : colour_of(i))
      image.rgb.push_back(std::uint8_t(std::lround(255 * std::clamp(c, 0.0, 1.0))));
  return image;
}

// Hue from 0 to 1.
Colour from_hsv(double hue, double saturation, double value) {
  Colour out{};
  for (int i = 0; i < 3; ++i) {
    const double k = std::fmod(5 - 2.0 * i + 6 * hue, 6.0);
    out[std::size_t(i)] =
        value * (1 - saturation * std::max(0.0, std::min({k, 4 - k, 1.0})));
  }
  return out;
}

// From blue through green to yellow, ever brighter.
Colour by_rank(double t) {
  return {0.25 + 0.75 * t * t, 0.05 + 0.85 * t, 0.35 + 0.5 * std::sin(3.1 * t) * (1 - 0.6 * t)};
}

RgbImage paint_depth(const Frame& frame, const std::vector<float>& depth) {
  std::vector<float> known;
  for (const float z : frame.depth)
    if (z > 0) known.push_back(z);
  if (known.empty()) known.push_back(1);
  std::sort(known.begin(), known.end());
  const double low = std::log(known[known.size() / 100]);
  const double high = std::max(low + 0.1, std::log(double(known[known.size() * 95 / 100])));
  return paint(frame, [&](std::size_t i) -> Colour {
    if (!(depth[i] > 0)) return {0, 0, 0};
    return by_rank(1 - std::clamp((std::log(double(depth[i])) - low) / (high - low), 0.0, 1.0));
  });
}

Colour colour_of_number(std::uint32_t number) {
  const double hue = std::fmod(number * 0.61803398875, 1.0);
  return from_hsv(hue, 0.45 + 0.4 * std::fmod(number * 0.7548777, 1.0),
                  0.6 + 0.4 * std::fmod(number * 0.5698403, 1.0));
}

RgbImage paint_instances(const Frame& frame) {
  const auto& instance = frame.get<std::uint32_t>("instance");
  return paint(frame, [&](std::size_t i) -> Colour {
    if (instance[i] == kNoInstance) return {0, 0, 0};
    if (instance[i] == kGroundInstance) return {0.25, 0.25, 0.25};
    return colour_of_number(instance[i]);
  });
}

RgbImage paint_labels(const Frame& frame) {
  const auto& label = frame.get<std::uint16_t>("label");
  return paint(frame, [&](std::size_t i) -> Colour {
    if (label[i] < 2) return Colour{0.25, 0.25, 0.25};
    return colour_of_number(label[i] * 7u);
  });
}

RgbImage paint_flow(const Frame& frame) {
  const auto& flow = frame.get<float>("flow");
  double longest = 1e-6;
  for (const float f : flow)
    if (std::isfinite(f)) longest = std::max(longest, std::fabs(double(f)));
  return paint(frame, [&](std::size_t i) -> Colour {
    const double u = double(flow[2 * i]), v = double(flow[2 * i + 1]);
    if (!std::isfinite(u)) return {0, 0, 0};
    const double hue = std::atan2(v, u) / 6.283185307179586 + 0.5;
    return from_hsv(hue, std::min(1.0, std::sqrt(std::hypot(u, v) / longest)), 1);
  });
}

RgbImage paint_events(const Frame& frame) {
  std::vector<int> balance(frame.depth.size(), 0);
  for (const Event& e : frame.events)
    balance[std::size_t(e.y) * std::size_t(frame.intrinsics.width) + e.x] += e.brighter ? 1 : -1;
  return paint(frame, [&](std::size_t i) -> Colour {
    const double share = std::min(1.0, 0.4 + 0.2 * std::abs(balance[i]));
    if (balance[i] == 0) return {0.85, 0.85, 0.85};
    return balance[i] > 0 ? Colour{0.9, 0.85 * (1 - share), 0.85 * (1 - share)}
                          : Colour{0.85 * (1 - share), 0.85 * (1 - share), 0.9};
  });
}

RgbImage paint_stereo(const Frame& frame) {
  const auto grey = [](const std::vector<std::uint8_t>& rgb, std::size_t i) {
    return (0.3 * rgb[3 * i] + 0.59 * rgb[3 * i + 1] + 0.11 * rgb[3 * i + 2]) / 255;
  };
  return paint(frame, [&](std::size_t i) -> Colour {
    const double right = grey(frame.rgb_right, i);
    return {grey(frame.rgb, i), right, right};
  });
}

using Painter = std::function<RgbImage(const Frame&)>;
const std::map<std::string, Painter>& painters() {
  static const std::map<std::string, Painter> all{
      {"colour",
       [](const Frame& f) {
         return RgbImage{f.intrinsics.width, f.intrinsics.height, f.rgb};
       }},
      {"depth", [](const Frame& f) { return paint_depth(f, f.depth); }},
      {"measured_depth", [](const Frame& f) { return paint_depth(f, f.measured_depth); }},
      {"normals",
       [](const Frame& f) {
         return paint(f, [&normals = f.get<float>("normals")](std::size_t i) -> Colour {
           const float* n = &normals[3 * i];
           if (std::isnan(n[0])) return {0, 0, 0};
           return {0.5 + 0.5 * double(n[0]), 0.5 - 0.5 * double(n[1]), 0.5 - 0.5 * double(n[2])};
         });
       }},
      {"instance", paint_instances},
      {"label", paint_labels},
      {"flow", paint_flow},
      {"sky_visibility",
       [](const Frame& f) {
         return paint(f, [&sky = f.get<float>("sky_visibility")](std::size_t i) -> Colour {
           const double v = double(sky[i]);
           return std::isnan(v) ? Colour{0.2, 0.3, 0.5} : Colour{v, v, v};
         });
       }},
      {"events", paint_events},
      {"right", paint_stereo}};
  return all;
}

}  // namespace

void ask_for_channel(const std::string& channel, CameraSpec& spec) {
  if (!painters().count(channel)) throw RunError("no channel is called \"" + channel + "\"");
  const ImageStream* stream = find_image_stream(channel);
  if (stream && stream->is_truth()) spec.channels.push_back(stream);
}

RgbImage channel_picture(const std::string& channel, const Frame& frame) {
  return painters().at(channel)(frame);
}

}  // namespace rubble
