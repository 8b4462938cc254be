#include "render/optics/lens_surface.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "kernel/base/quick_math.h"
#include "kernel/base/random.h"

namespace rubble {

namespace {

constexpr int kSmudges = 60;
constexpr double kSmallestSmudge = 0.008, kLargestSmudge = 0.07;  // radii; unit: width of the picture
constexpr double kSmallestDrop = 0.012, kLargestDrop = 0.045;     // likewise
constexpr double kMinified = 3.5;  // how much smaller the picture in a drop is
constexpr double kThrownOn = 0.5;  // of what a smudge takes; the rest it swallows

double soft_step(double x) {  // 1 at 0, 0 from 1 on
  const double t = std::clamp(1 - x, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

// Calls visit(x, y, distance from the middle over the radius) for the pixels of a disc.
template <typename Visit>
void for_disc(const LinearImage& image, double cx, double cy, double radius, const Visit& visit) {
  const int top = std::max(0, int(std::ceil(cy - radius)));
  const int left = std::max(0, int(std::ceil(cx - radius)));
  for (int y = top; y < image.height && y <= cy + radius; ++y)
    for (int x = left; x < image.width && x <= cx + radius; ++x)
      if (const double d = quick::hypot(x - cx, y - cy) / radius; d < 1) visit(x, y, d);
}

std::size_t place(const LinearImage& image, int x, int y) {
  return 3 * (std::size_t(y) * std::size_t(image.width) + std::size_t(x));
}

// Of a mirrored line: a drop sees beyond the border of the picture.
int reflect(double at, int size) {
  const int period = 2 * size;
  const int i = ((int(std::floor(at + 0.5)) % period) + period) % period;
  return i < size ? i : period - 1 - i;
}

}  // namespace

LensSurface::LensSurface(int width, int height, double dirt, int drops, std::uint64_t seed, int eye) {
  const auto draw = [&](RandomStream& random, double smallest, double largest) {
    Spot spot;
    spot.x = random.uniform() * width, spot.y = random.uniform() * height;
    // Radii evenly over their logarithm: many small ones, few large ones.
    spot.radius = width * smallest * quick::pow(largest / smallest, random.uniform());
    spot.opacity = random.uniform(0.3, 1);
    return spot;
  };
  const std::string lens = eye == 0 ? "" : "/right";
  RandomStream dirt_stream(seed, "optics/dirt" + lens), drop_stream(seed, "optics/drops" + lens);
  for (int i = 0; dirt > 0 && i < kSmudges; ++i) {
    smudges_.push_back(draw(dirt_stream, kSmallestSmudge, kLargestSmudge));
    smudges_.back().opacity *= dirt;
  }
  for (int i = 0; i < drops; ++i) drops_.push_back(draw(drop_stream, kSmallestDrop, kLargestDrop));
}

void LensSurface::soil(LinearImage& image, const LinearImage& veil) const {
  std::vector<float> passed(image.rgb.size() / 3, 1);
  for (const Spot& spot : smudges_)
    for_disc(image, spot.x, spot.y, spot.radius, [&](int x, int y, double d) {
      passed[place(image, x, y) / 3] *= float(1 - spot.opacity * soft_step(d));
    });
  for (std::size_t i = 0; i < image.rgb.size(); ++i) {
    const float t = passed[i / 3];
    image.rgb[i] = image.rgb[i] * t + veil.rgb[i] * (float(kThrownOn) * (1 - t));
  }
}

void LensSurface::wet(LinearImage& image, const LinearImage& soft) const {
  for (const Spot& spot : drops_)
    for_disc(image, spot.x, spot.y, spot.radius, [&](int x, int y, double d) {
      const int u = reflect(spot.x - kMinified * (x - spot.x), image.width);
      const int v = reflect(spot.y - kMinified * (y - spot.y), image.height);
      const double cover = soft_step(std::max(0.0, (d - 0.55) / 0.45)), bright = 1 - 0.55 * d * d * d * d;
      float* const to = image.rgb.data() + place(image, x, y);
      const float* const from = soft.rgb.data() + place(image, u, v);
      for (int c = 0; c < 3; ++c) to[c] += float(cover) * (float(bright) * from[c] - to[c]);
    });
}

}  // namespace rubble
