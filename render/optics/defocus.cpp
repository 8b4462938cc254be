#include "render/optics/defocus.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/math.h"
#include "kernel/base/parallel.h"
#include "kernel/base/quick_math.h"

namespace rubble {

namespace {

constexpr int kTile = 16;       // unit: pixel
constexpr double kFine = 16;    // radii are multiples of 1 / kFine of a pixel
constexpr float kLayer = 1.0f;  // radii that differ by less are of one surface; unit: pixel

// How much of a pixel at the distance d a disc covers.
float disc_cover(float radius, float d) { return std::clamp(radius + 0.5f - d, 0.0f, 1.0f); }

// One over the sum of a disc's weights, by its radius: what is spread stays as much as it was.
std::vector<float> make_shares() {
  std::vector<float> shares;
  for (int i = 0; i <= int(kMostDefocus * kFine); ++i) {
    const float radius = float(i / kFine);
    const int reach = int(std::ceil(radius)) + 1;
    double sum = 0;
    for (int y = -reach; y <= reach; ++y)
      for (int x = -reach; x <= reach; ++x)
        sum += double(disc_cover(radius, std::sqrt(float(x * x + y * y))));
    shares.push_back(float(1 / sum));
  }
  return shares;
}

// Light of some pixels, and how much of the pixel asked it covers.
struct Layer {
  Vec3f light;
  float cover = 0;
  void add(const Vec3f& value, float weight) { light += value * weight, cover += weight; }
  Vec3f mean() const { return cover > 0 ? light * (1 / cover) : Vec3f(); }
};

class Spreader {
 public:
  Spreader(const LinearImage& sharp, const std::vector<float>& depth, const ThinLens& lens)
      : sharp_(sharp) {
    static const std::vector<float> shares = make_shares();
    radius_.resize(depth.size()), share_.resize(depth.size());
    for (std::size_t i = 0; i < depth.size(); ++i) {
      const double steps = std::nearbyint(lens.signed_radius(double(depth[i])) * kFine);
      radius_[i] = float(steps / kFine);
      share_[i] = shares[std::size_t(std::fabs(steps))];
    }
    for (int y = 0; y <= 2 * kReach; ++y)
      for (int x = 0; x <= 2 * kReach; ++x)
        distance_.push_back(quick::hypot(float(x - kReach), float(y - kReach)));
    find_largest();
  }

  int tiles_across() const { return (sharp_.width + kTile - 1) / kTile; }
  int tiles_down() const { return (sharp_.height + kTile - 1) / kTile; }

  void fill_tile(int tx, int ty, LinearImage& out) const {
    const int reach = int(std::ceil(reach_of(tx, ty)));
    for (int y = ty * kTile; y < std::min((ty + 1) * kTile, sharp_.height); ++y) {
      for (int x = tx * kTile; x < std::min((tx + 1) * kTile, sharp_.width); ++x) {
        const Vec3f value = reach > 0 ? gather(x, y, reach) : value_at(place(x, y));
        float* const to = out.rgb.data() + 3 * place(x, y);
        to[0] = value.x, to[1] = value.y, to[2] = value.z;
      }
    }
  }

 private:
  static constexpr int kReach = int(kMostDefocus) + 1;

  std::size_t place(int x, int y) const {
    return std::size_t(y) * std::size_t(sharp_.width) + std::size_t(x);
  }
  Vec3f value_at(std::size_t i) const {
    return {sharp_.rgb[3 * i], sharp_.rgb[3 * i + 1], sharp_.rgb[3 * i + 2]};
  }

  void find_largest() {
    largest_.assign(std::size_t(tiles_across()) * std::size_t(tiles_down()), 0);
    for (int y = 0; y < sharp_.height; ++y)
      for (int x = 0; x < sharp_.width; ++x) {
        float& most = largest_[tile(x / kTile, y / kTile)];
        most = std::max(most, std::fabs(radius_[place(x, y)]));
      }
  }
  std::size_t tile(int tx, int ty) const {
    return std::size_t(ty) * std::size_t(tiles_across()) + std::size_t(tx);
  }

  // How far from its pixels a tile must look: discs of other tiles reach into it.
  float reach_of(int tx, int ty) const {
    constexpr int kFar = kReach / kTile + 1;
    float reach = 0;
    for (int y = std::max(ty - kFar, 0); y <= std::min(ty + kFar, tiles_down() - 1); ++y)
      for (int x = std::max(tx - kFar, 0); x <= std::min(tx + kFar, tiles_across() - 1); ++x) {
        const int apart = std::max({std::abs(x - tx), std::abs(y - ty), 1}) - 1;  // tiles between
        const float most = largest_[tile(x, y)];
        if (most >= 0.5f && most + 0.5f > float(apart * kTile)) reach = std::max(reach, most + 0.5f);
      }
    return reach;
  }

  Vec3f gather(int x, int y, int reach) const {
    const float here = radius_[place(x, y)], own_share = share_[place(x, y)];
    Layer nearer, own, farther;
    for (int v = std::max(y - reach, 0); v <= std::min(y + reach, sharp_.height - 1); ++v) {
      const float* const d = distance_.data() + (v - y + kReach) * (2 * kReach + 1) + kReach - x;
      for (int u = std::max(x - reach, 0); u <= std::min(x + reach, sharp_.width - 1); ++u) {
        const std::size_t i = place(u, v);
        const float there = radius_[i];
        if (there > here + kLayer) {
          const float weight = disc_cover(std::fabs(here), d[u]) * own_share;
          if (weight > 0) farther.add(value_at(i), weight);
        } else {
          const float weight = disc_cover(std::fabs(there), d[u]) * share_[i];
          if (weight > 0) (there < here - kLayer ? nearer : own).add(value_at(i), weight);
        }
      }
    }
    Vec3f under = own.cover > 0 ? own.mean() : farther.mean();
    if (own.cover > 0 && farther.cover > 0) {
      const float covered = std::min(1.0f, own.cover);
      under = under * covered + farther.mean() * (1 - covered);
    }
    const float covered = std::min(1.0f, nearer.cover);
    return nearer.mean() * covered + under * (1 - covered);
  }

  const LinearImage& sharp_;
  std::vector<float> radius_;    // signed, of each pixel; unit: pixel
  std::vector<float> share_;     // of a fully covered pixel
  std::vector<float> distance_;  // of the places around the middle of a square
  std::vector<float> largest_;   // of each tile
};

}  // namespace

double ThinLens::signed_radius(double depth) const {
  const double inverse = depth > 0 ? 1 / depth : 0;  // NaN: none
  return std::clamp(0.5 * focal * aperture * (1 / focus - inverse), -kMostDefocus, kMostDefocus);
}

LinearImage defocus(const LinearImage& sharp, const std::vector<float>& depth, const ThinLens& lens,
                    int threads) {
  LinearImage out = sharp;
  const Spreader spreader(sharp, depth, lens);
  parallel_for(std::size_t(spreader.tiles_down()), threads, [&](std::size_t row) {
    for (int tx = 0; tx < spreader.tiles_across(); ++tx) spreader.fill_tile(tx, int(row), out);
  });
  return out;
}

}  // namespace rubble
