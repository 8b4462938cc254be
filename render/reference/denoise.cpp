#include "render/reference/denoise.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "kernel/base/parallel.h"
#include "kernel/base/quick_math.h"

namespace rubble {

namespace {

constexpr int kPasses = 5;               // the last reaches 2 * 16 pixels
constexpr float kLeastAlbedo = 0.02f;    // darker surfaces count as this dark
constexpr float kBrightness = 3;         // standard deviations that still count as noise
constexpr float kNormal = 0.25f;         // length of the difference of two normals
constexpr float kDistance = 1.5f;        // slopes of the distance, across the pixels between
constexpr float kLeastDistance = 2e-3f;  // as a share of the distance
constexpr float kMatt = 0.999f;          // cover from which on a pixel is all surface
constexpr float kOutlier = 0.25f;        // error of a pixel, as a share of itself, that makes it suspect
constexpr int kBrighter = 4;             // of 24 neighbours that a suspect may not outshine
constexpr float kKernel[3] = {0.375f, 0.25f, 0.0625f};  // of the cubic B-spline

float luminance_of(const Vec3f& c) { return dot(c, Vec3f(0.2126f, 0.7152f, 0.0722f)); }

Vec3f divided(const Vec3f& a, const Vec3f& b) { return {a.x / b.x, a.y / b.y, a.z / b.z}; }
Vec3f times(const Vec3f& a, const Vec3f& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

class Denoiser {
 public:
  Denoiser(const TracedImage& image, int threads) : image_(image), threads_(threads) {
    const Vec3f least(kLeastAlbedo, kLeastAlbedo, kLeastAlbedo);
    for (std::size_t i = 0; i < image.size(); ++i) {
      albedo_.push_back(max(image.albedo[i], least));
      light_.push_back(divided(image.light[i], albedo_.back()));
      const float grey = luminance_of(albedo_.back());
      variance_.push_back(image.variance[i] / (grey * grey));
    }
    slope_.resize(image.size());
    over_rows([&](int y) {
      for (int x = 0; x < image_.width; ++x) slope_[at(x, y)] = find_slope(x, y);
    });
  }

  std::vector<Vec3f> run() {
    limit_outliers();
    for (int pass = 0; pass < kPasses; ++pass) {
      std::vector<Vec3f> light = light_;
      std::vector<float> variance = variance_;
      over_rows([&](int y) {
        for (int x = 0; x < image_.width; ++x)
          if (filtered(at(x, y))) filter(x, y, 1 << pass, light[at(x, y)], variance[at(x, y)]);
      });
      light_.swap(light), variance_.swap(variance);
    }
    std::vector<Vec3f> out = image_.light;
    for (std::size_t i = 0; i < out.size(); ++i)
      if (filtered(i)) out[i] = times(light_[i], albedo_[i]);
    return out;
  }

 private:
  std::size_t at(int x, int y) const { return std::size_t(y) * std::size_t(image_.width) + std::size_t(x); }
  // Sky and its edges are not noisy, or not of one surface.
  bool filtered(std::size_t i) const { return image_.cover[i] >= kMatt; }
  template <typename Work>
  void over_rows(const Work& work) {
    parallel_for(std::size_t(image_.height), threads_, [&](std::size_t y) { work(int(y)); });
  }

  // A path of small chance and great light leaves a speck that no average of its surroundings hides. A
  // pixel of large error becomes at most as bright as the fifth brightest of the 24 around it.
  void limit_outliers() {
    const std::vector<Vec3f> before = light_;
    over_rows([&](int y) {
      for (int x = 0; x < image_.width; ++x) {
        const std::size_t i = at(x, y);
        const float grey = luminance_of(before[i]);
        if (!filtered(i) || variance_[i] < kOutlier * kOutlier * grey * grey) continue;
        std::vector<float> around;
        for (int v = std::max(y - 2, 0); v <= std::min(y + 2, image_.height - 1); ++v)
          for (int u = std::max(x - 2, 0); u <= std::min(x + 2, image_.width - 1); ++u)
            if (at(u, v) != i && filtered(at(u, v))) around.push_back(luminance_of(before[at(u, v)]));
        if (around.size() <= std::size_t(kBrighter)) continue;
        std::nth_element(around.begin(), around.begin() + kBrighter, around.end(), std::greater<float>());
        const float share = around[kBrighter] / grey;
        if (!(share < 1)) continue;
        light_[i] = before[i] * share, variance_[i] *= share * share;
      }
    });
  }

  // How much the distance changes from a pixel to the next: of both sides the smaller.
  float find_slope(int x, int y) const {
    const float here = image_.distance[at(x, y)];
    const auto step = [&](int dx, int dy) {
      float least = here;
      for (const int side : {-1, 1}) {
        const int u = x + side * dx, v = y + side * dy;
        if (u < 0 || v < 0 || u >= image_.width || v >= image_.height) continue;
        least = std::min(least, std::fabs(image_.distance[at(u, v)] - here));
      }
      return least;
    };
    return std::max(step(1, 0), step(0, 1));
  }

  // The noise of one pixel is itself noisy: that of the 3 by 3 around it.
  float noise_around(int x, int y) const {
    float sum = 0, weights = 0;
    for (int v = std::max(y - 1, 0); v <= std::min(y + 1, image_.height - 1); ++v) {
      for (int u = std::max(x - 1, 0); u <= std::min(x + 1, image_.width - 1); ++u) {
        const float w = kKernel[std::abs(u - x)] * kKernel[std::abs(v - y)];
        if (filtered(at(u, v))) sum += w * variance_[at(u, v)], weights += w;
      }
    }
    return std::sqrt(sum / weights);
  }

  void filter(int x, int y, int step, Vec3f& light, float& variance) const {
    const std::size_t i = at(x, y);
    const float grey = luminance_of(light_[i]);
    const float noise = kBrightness * noise_around(x, y) + 1e-10f;
    Vec3f sum;
    float weights = 0, squares = 0;
    for (int dy = -2; dy <= 2; ++dy) {
      const int v = y + dy * step;
      if (v < 0 || v >= image_.height) continue;
      for (int dx = -2; dx <= 2; ++dx) {
        const int u = x + dx * step;
        if (u < 0 || u >= image_.width || !filtered(at(u, v))) continue;
        const std::size_t k = at(u, v);
        const Vec3f turn = image_.normal[k] - image_.normal[i];
        const float pixels = float(step) * std::sqrt(float(dx * dx + dy * dy));
        const float reach = kDistance * slope_[i] * pixels + kLeastDistance * image_.distance[i];
        const float exponent =
            dot(turn, turn) / (kNormal * kNormal) +
            std::fabs(image_.distance[k] - image_.distance[i]) / reach +
            (k == i ? 0 : std::fabs(luminance_of(light_[k]) - grey) / noise);
        const float w =
            kKernel[std::abs(dx)] * kKernel[std::abs(dy)] * quick::exp(-std::min(exponent, 80.0f));
        sum += light_[k] * w, weights += w, squares += w * w * variance_[k];
      }
    }
    light = sum * (1 / weights);
    variance = squares / (weights * weights);
  }

  const TracedImage& image_;
  int threads_;
  std::vector<Vec3f> albedo_, light_;  // light: over the albedo
  std::vector<float> variance_, slope_;
};

}  // namespace

std::vector<Vec3f> denoise_image(const TracedImage& image, int threads) {
  return Denoiser(image, threads).run();
}

}  // namespace rubble
