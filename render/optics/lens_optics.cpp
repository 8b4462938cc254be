#include "render/optics/lens_optics.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kernel/base/parallel.h"
#include "kernel/base/quick_math.h"
#include "render/optics/lens_surface.h"

namespace rubble {

namespace {

constexpr int kOctaves = 7;
constexpr double kInnermost = 1.0 / 256;  // standard deviation; unit: width of the picture
constexpr double kDropBlur = 0.004;       // likewise, of the picture in a drop

// Cubic convolution with a = -1/2 (Keys 1981): weights of the four pixels around a place.
struct Cubic {
  explicit Cubic(double at) : first(int(std::floor(at)) - 1) {
    const double t = at - std::floor(at), t2 = t * t, t3 = t2 * t;
    weights[0] = float(0.5 * (-t3 + 2 * t2 - t));
    weights[1] = float(0.5 * (3 * t3 - 5 * t2 + 2));
    weights[2] = float(0.5 * (-3 * t3 + 4 * t2 + t));
    weights[3] = float(0.5 * (t3 - t2));
  }
  int first;
  float weights[4];
};

float sample_cubic(const LinearImage& image, const Cubic& u, const Cubic& v, std::size_t colour) {
  float sum = 0;
  for (int j = 0; j < 4; ++j) {
    const std::size_t y = std::size_t(std::clamp(v.first + j, 0, image.height - 1));
    float row = 0;
    for (int i = 0; i < 4; ++i) {
      const std::size_t x = std::size_t(std::clamp(u.first + i, 0, image.width - 1));
      row += u.weights[i] * image.rgb[3 * (y * std::size_t(image.width) + x) + colour];
    }
    sum += v.weights[j] * row;
  }
  return std::max(sum, 0.0f);
}

double farthest_corner(const Intrinsics& k) {
  return quick::hypot(std::max(k.cx, k.width - 1 - k.cx), std::max(k.cy, k.height - 1 - k.cy));
}

}  // namespace

LinearImage spread_glare(const LinearImage& image, int threads) {
  LinearImage level = image, sum = image;
  std::fill(sum.rgb.begin(), sum.rgb.end(), 0.0f);
  double reached = 0;  // variance of `level`
  for (int i = 0; i < kOctaves; ++i) {
    const double sigma = kInnermost * image.width * quick::exp2(double(i));
    const int passes = i == 0 ? 3 : 2;  // what comes after is smooth already
    blur_boxes(level, (sigma * sigma - reached) / passes, passes, threads);
    reached = sigma * sigma;
    for (std::size_t k = 0; k < sum.rgb.size(); ++k) sum.rgb[k] += level.rgb[k] * (1.0f / kOctaves);
  }
  return sum;
}

LensOptics::LensOptics(const OpticsSpec& spec, double f_number, const Intrinsics& intrinsics,
                       std::uint64_t seed, int threads)
    : spec_(spec),
      intrinsics_(intrinsics),
      lens_{spec.focal_length / f_number, spec.focus_distance, intrinsics.fx},
      threads_(threads) {
  for (int eye = 0; eye < 2; ++eye)
    surfaces_[eye] = std::make_unique<LensSurface>(intrinsics.width, intrinsics.height, spec.dirt,
                                                   spec.drops, seed, eye);
}

LensOptics::~LensOptics() = default;

std::vector<float> LensOptics::defocus(std::vector<float> rgb, const std::vector<float>& depth) const {
  if (!defocuses()) return rgb;
  const LinearImage sharp{intrinsics_.width, intrinsics_.height, std::move(rgb)};
  return rubble::defocus(sharp, depth, lens_, threads_).rgb;
}

LinearImage LensOptics::shift_colours(const LinearImage& image) const {
  const double half = 0.5 * spec_.lateral_colour / farthest_corner(intrinsics_);
  LinearImage out = image;
  parallel_for(std::size_t(image.height), threads_, [&](std::size_t y) {
    for (const std::size_t colour : {0u, 2u}) {
      const double back = 1 / (1 + (colour == 0 ? half : -half));
      const Cubic v(intrinsics_.cy + (double(y) - intrinsics_.cy) * back);
      for (int x = 0; x < image.width; ++x) {
        const Cubic u(intrinsics_.cx + (x - intrinsics_.cx) * back);
        out.rgb[3 * (y * std::size_t(image.width) + std::size_t(x)) + colour] =
            sample_cubic(image, u, v, colour);
      }
    }
  });
  return out;
}

std::vector<float> LensOptics::spread(std::vector<float> rgb, int eye) const {
  LinearImage image{intrinsics_.width, intrinsics_.height, std::move(rgb)};
  const LensSurface& surface = *surfaces_[eye];
  if (spec_.drops > 0) {
    LinearImage soft = image;
    const double sigma = kDropBlur * image.width;
    blur_boxes(soft, sigma * sigma / 3, 3, threads_);
    surface.wet(image, soft);
  }
  if (spec_.dirt > 0) surface.soil(image, spread_glare(image, threads_));
  if (spec_.lateral_colour != 0) image = shift_colours(image);
  if (spec_.point_spread > 0) blur_gaussian(image, spec_.point_spread, threads_);
  if (spec_.glare > 0) {
    const LinearImage skirt = spread_glare(image, threads_);
    const float share = float(spec_.glare);
    for (std::size_t i = 0; i < image.rgb.size(); ++i)
      image.rgb[i] += share * (skirt.rgb[i] - image.rgb[i]);
  }
  return std::move(image.rgb);
}

}  // namespace rubble
