#include "render/media/streaks.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/parallel.h"
#include "kernel/base/portable_math.h"
#include "kernel/base/quick_math.h"

namespace rubble {

namespace {

constexpr int kBand = 16;  // rows of a job

struct Shape {
  double u, v, du, dv;    // from one end to the other
  double square, half;    // length squared; half the width
  double edge;            // over which it fades: the disc of the drop over that of defocus, or a pixel
  double share;           // of a pixel that it covers

  explicit Shape(const Streak& s) : u(s.u0), v(s.v0), du(s.u1 - s.u0), dv(s.v1 - s.v0) {
    square = du * du + dv * dv;
    half = 0.5 * std::max({s.width, s.blur, 1.0}), edge = std::max(1.0, std::min(s.width, s.blur));
    const double area = 2 * half * std::sqrt(square) + portable::kPi * (half * half + edge * edge / 12);
    share = portable::kPi / 4 * s.width * s.width / area;
  }
  double cover(double x, double y) const {
    const double t = square > 0 ? std::clamp(((x - u) * du + (y - v) * dv) / square, 0.0, 1.0) : 0;
    return std::clamp((half - quick::hypot(x - u - t * du, y - v - t * dv)) / edge + 0.5, 0.0, 1.0);
  }
};

}  // namespace

bool place_streak(const Lens& lens, const Pose& open, const Pose& close, double seconds, const Drop& drop,
                  Streak& streak) {
  const Vec3 half = drop.velocity * (0.5 * seconds);
  const auto first = lens.project((open * camera_from_optical).inverse() * (drop.place - half));
  const auto last = lens.project((close * camera_from_optical).inverse() * (drop.place + half));
  if (!first || !last) return false;
  streak.u0 = first->u, streak.v0 = first->v, streak.u1 = last->u, streak.v1 = last->v;
  return true;
}

void draw_streaks(const std::vector<Streak>& streaks, const std::vector<float>& distances, int width, int height,
                  int threads, std::vector<float>& image) {
  std::vector<Shape> shapes(streaks.begin(), streaks.end());
  std::vector<std::vector<std::uint32_t>> bands(std::size_t((height + kBand - 1) / kBand));
  const auto reach = [&](std::size_t i) { return shapes[i].half + 0.5 * shapes[i].edge; };
  for (std::size_t i = 0; i < streaks.size(); ++i) {
    const double top = std::min(streaks[i].v0, streaks[i].v1) - reach(i);
    const double bottom = std::max(streaks[i].v0, streaks[i].v1) + reach(i);
    if (bottom < 0 || top > height - 1) continue;
    for (int b = int(std::max(top, 0.0)) / kBand; b <= int(std::min(bottom, height - 1.0)) / kBand; ++b)
      bands[std::size_t(b)].push_back(std::uint32_t(i));
  }
  parallel_for(bands.size(), threads, [&](std::size_t band) {
    const int first = int(band) * kBand, last = std::min(height, first + kBand) - 1;
    for (const std::uint32_t i : bands[band]) {
      const Streak& s = streaks[i];
      const Shape& shape = shapes[i];
      const double r = reach(i);
      const int top = std::max(first, int(std::ceil(std::max(std::min(s.v0, s.v1) - r, 0.0))));
      const int bottom = std::min(last, int(std::floor(std::min(std::max(s.v0, s.v1) + r, double(height)))));
      const int left = int(std::ceil(std::max(std::min(s.u0, s.u1) - r, 0.0)));
      const int right = int(std::floor(std::min(std::max(s.u0, s.u1) + r, width - 1.0)));
      for (int y = top; y <= bottom; ++y)
        for (int x = left; x <= right; ++x) {
          const double cover = shape.cover(x, y);
          const std::size_t at = std::size_t(y) * std::size_t(width) + std::size_t(x);
          if (cover <= 0 || double(distances[at]) < s.distance) continue;
          const float alpha = float(shape.share * cover);
          float* const to = image.data() + 3 * at;
          for (int c = 0; c < 3; ++c) to[c] += alpha * (s.radiance[c] - to[c]);
        }
    }
  });
}

}  // namespace rubble
