#include "render/transport/air_transfer.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/portable_math.h"
#include "kernel/base/quick_math.h"
#include "render/lighting/light_packing.h"

namespace rubble {

namespace {

constexpr float kMostResponse = 4;
constexpr float kMean = 0.2820948f;  // from the first term to the mean over all directions
constexpr float kAngle = 4 * portable::kPiF / AirLinks::kDirections;
constexpr float kLeastShare = 0.02f;  // of what the corners weigh that a place sees, for them to stand for all eight

Vec3f mean_of(const RadianceTerms& terms) { return terms[0] * kMean; }

}  // namespace

AirTransfer::AirTransfer(AirLinks links) : links_(std::move(links)) {
  for (const Vec3f& d : links_.directions) harmonics_.push_back(harmonics_of(d));
  ends_in_.resize(links_.ends.size()), air_in_.resize(links_.ends.size());
  const std::size_t count = links_.grid.count();
  total_.resize(count), response_.resize(count), lit_.resize(count);
}

// The darkest, or the brightest, of what a point does not see about it; of points inside a piece, of all about it.
std::vector<std::uint32_t> AirTransfer::choose_sides(bool brighter) const {
  constexpr float kClearly = 0.7f;
  std::vector<float> light;
  for (const Terms& terms : total_) light.push_back(luminance({terms[0].c[0], terms[0].c[1], terms[0].c[2]}));
  std::vector<std::uint32_t> out = links_.nearest;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const bool open = links_.nearest[i] == i;
    float chosen = light[out[i]];
    for (int k = 0; k < 27; ++k) {
      const std::size_t j = links_.neighbour(i, k);
      if (links_.nearest[j] != j || (open && !(links_.hidden[i] >> k & 1u))) continue;
      if (brighter ? light[j] * kClearly <= chosen : light[j] >= kClearly * chosen) continue;
      chosen = light[j], out[i] = std::uint32_t(j);
    }
  }
  return out;
}

AirGrid::Corners AirTransfer::Result::shown(AirGrid::Corners corners) const {
  for (std::uint32_t& i : corners.at) i = stand_in[i];
  return corners;
}

// What arrives at each point from anywhere, to the second order: what is scattered has hardly more.
void AirTransfer::gather_total(const Sources& sources, ThreadPool& pool) {
  const std::size_t count = links_.grid.count();
  pool.run(int(count), 256, [&](int begin, int end) {
    for (std::size_t i = std::size_t(begin); i < std::size_t(end); ++i) {
      Terms& sum = total_[i];
      for (std::size_t t = 0; t < kTerms; ++t) {
        const Vec3f& direct = sources.direct[i][t];
        sum[t].c = Four{direct.x, direct.y, direct.z, 0};
      }
      for (std::size_t k = 0; lit_[i] && k < AirLinks::kDirections; ++k) {
        const Four in = (ends_in_[k * count + i].c + air_in_[k * count + i].c) * kAngle;
        for (std::size_t t = 0; t < kTerms; ++t) sum[t].c += in * harmonics_[k][t];
      }
    }
  });
}

void AirTransfer::find_response(const std::vector<Vec3f>& usual) {
  for (std::size_t i = 0; i < response_.size(); ++i) {
    const Vec3f& before = usual[i];
    for (int c = 0; c < 3; ++c)
      response_[i].c[c] = before[c] > 0 ? std::clamp(total_[i][0].c[c] * kMean / before[c], 0.0f, kMostResponse) : 1.0f;
  }
}

// What the air at each point sends on against this direction, of all that it takes; the last: its extinction.
void AirTransfer::emit(const AirMatter& air, const Sources& sources, std::size_t direction, Emitted& out) const {
  const Harmonics& y = harmonics_[direction];
  const auto four = [](const Vec3f& v) { return Four{v.x, v.y, v.z, 0}; };
  out.light.resize(total_.size()), out.beams.resize(sources.beams.size());
  for (std::size_t i = 0; i < total_.size(); ++i) {
    Colour& sum = out.light[i] = {};
    for (std::size_t t = 0; t < kTerms; ++t) {
      const Four light = sources.beams.empty() ? total_[i][t].c : total_[i][t].c - four(sources.direct[i][t]);
      sum.c += light * (y[t] * air.scattered[i][order_of(t)]);
    }
    sum.c[3] = air.extinction[i];
  }
  for (std::size_t l = 0; l < out.beams.size(); ++l) {
    out.beams[l].resize(total_.size());
    for (std::size_t i = 0; i < total_.size(); ++i) {
      Colour& sum = out.beams[l][i] = {};
      for (std::size_t t = 0; t < kTerms; ++t)
        sum.c += four(sources.beams[l][i][t]) * (y[t] * air.scattered[i][order_of(t)]);
    }
  }
}

// Of the corners about a place, in cells, that it sees; `otherwise`: a point that stands for them where it sees none.
AirTransfer::Colour AirTransfer::between(const std::vector<Colour>& grid, const Vec3f& at, std::uint8_t seen,
                                         std::size_t otherwise, bool in_stops) const {
  const auto [nx, ny, nz] = links_.grid.size;
  const auto low = [](float a, int n) { return std::clamp(int(a), 0, n - 2); };
  const int x = low(at.x, nx), y = low(at.y, ny), z = low(at.z, nz);
  const float u = at.x - float(x), v = at.y - float(y), w = at.z - float(z);
  const Colour* corner = grid.data() + (z * ny + y) * nx + x;
  const float weight[8] = {(1 - u) * (1 - v) * (1 - w), u * (1 - v) * (1 - w), (1 - u) * v * (1 - w), u * v * (1 - w),
                           (1 - u) * (1 - v) * w,       u * (1 - v) * w,       (1 - u) * v * w,       u * v * w};
  const std::ptrdiff_t row = nx, layer = std::ptrdiff_t(nx) * ny;
  const std::ptrdiff_t off[8] = {0, 1, row, row + 1, layer, layer + 1, layer + row, layer + row + 1};
  Colour out;
  std::array<float, 8> light{}, weights{};
  float sum = 0;
  for (std::size_t k = 0; k < 8; ++k) {
    if (!(seen >> k & 1u)) continue;
    sum += weight[k];
    out.c += corner[off[k]].c * weight[k];
    light[k] = corner[off[k]].c[1], weights[k] = weight[k];
  }
  if (sum < kLeastShare) return grid[otherwise];
  out.c *= 1 / sum;
  if (!in_stops) return out;
  for (float& share : weights) share *= 1 / sum;
  const float factor = factor_in_stops(light, weights);
  out.c *= Four{factor, factor, factor, 1};
  return out;
}

// emitted: by the air; none: it only weakens what lies at the ends.
void AirTransfer::follow(const AirMatter& air, const Sources& sources, std::size_t direction,
                         const Emitted* emitted) {
  const AirGrid& grid = links_.grid;
  const std::size_t count = grid.count(), first = direction * count;
  const Vec3f& d = links_.directions[direction];
  const Vec3f way(d.x / grid.cell.x, d.y / grid.cell.y, d.z / grid.cell.z);  // in cells for each metre
  for (std::size_t i = 0; i < count; ++i) {
    if (!lit_[i]) {
      air_in_[first + i] = ends_in_[first + i] = {};
      continue;
    }
    const Vec3f from(float(i % std::size_t(grid.size[0])), float(i / std::size_t(grid.size[0]) % std::size_t(grid.size[1])),
                     float(i / std::size_t(grid.size[0] * grid.size[1])));
    const AirLinks::End& end = links_.ends[first + i];
    const float length = links_.length(direction, i);
    std::size_t place = links_.first_place[i * AirLinks::kDirections + direction];
    float passed = 1;
    Colour sum;
    if (!emitted) passed = quick::exp(-air.extinction[i] * length);
    if (emitted) {
      links_.cut(length, [&](float middle, float step) {
        const Vec3f at = from + way * middle;
        Colour here = between(emitted->light, at, links_.seen[place], i, !sources.brighter);
        for (std::size_t l = 0; l < emitted->beams.size(); ++l) {
          const float reached = (*sources.reached)[l][place];
          if (reached > 0) here.c += between(emitted->beams[l], at, links_.seen[place], i, false).c * reached;
        }
        ++place;
        const float through = quick::exp(-here.c[3] * step), share = passed * (1 - through);
        sum.c += here.c * share;
        passed *= through;
      });
    }
    sum.c[3] = 0;
    air_in_[first + i] = sum;
    Vec3f far;
    if (end.point == AirLinks::kSky) {
      if (sources.sky) far = sources.sky[direction];
    } else if (end.point != AirLinks::kDark) {
      const Colour& surface = sources.surfaces[end.point];
      far = Vec3f(surface.c[0], surface.c[1], surface.c[2]);
      if (emitted && end.distance <= length) {
        const Colour response = between(response_, from + way * links_.place_before_end(length), links_.seen[place], i, false);
        far = Vec3f(far.x * response.c[0], far.y * response.c[1], far.z * response.c[2]);
      }
    }
    far *= passed;
    ends_in_[first + i].c = Four{far.x, far.y, far.z, 0};
  }
}

void AirTransfer::sweep(const AirMatter& air, const Sources& sources, bool scatters, ThreadPool& pool) {
  pool.run(int(AirLinks::kDirections), 1, [&](int begin, int end) {
    Emitted emitted;
    for (std::size_t k = std::size_t(begin); k < std::size_t(end); ++k) {
      if (scatters) emit(air, sources, k, emitted);
      follow(air, sources, k, scatters ? &emitted : nullptr);
    }
  });
}

void AirTransfer::project(const std::vector<Colour>& incoming, std::vector<RadianceTerms>& out, ThreadPool& pool) const {
  const std::size_t count = links_.grid.count();
  out.resize(count);
  pool.run(int(count), 256, [&](int begin, int end) {
    for (std::size_t i = std::size_t(begin); i < std::size_t(end); ++i) {
      std::array<Four, kHarmonics> sum{};
      for (std::size_t k = 0; lit_[i] && k < AirLinks::kDirections; ++k) {
        const Four light = incoming[k * count + i].c * kAngle;
        for (std::size_t t = 0; t < kHarmonics; ++t) sum[t] += light * harmonics_[k][t];
      }
      for (std::size_t t = 0; t < kHarmonics; ++t) out[i][t] = {sum[t][0], sum[t][1], sum[t][2]};
    }
  });
}

// Where nothing comes from a light, nor from what it lights, little of it is scattered to, but for the first few cells.
void AirTransfer::find_lit(const Sources& sources, const std::vector<RadianceTerms>& ends) {
  constexpr float kDark = 1e-6f;  // of the brightest
  constexpr int kRings = 3;
  std::vector<float> light;
  for (std::size_t i = 0; i < lit_.size(); ++i)
    light.push_back(luminance(mean_of(ends[i]) + mean_of(sources.direct[i])));
  const float least = kDark * *std::max_element(light.begin(), light.end());
  const std::vector<std::uint8_t> open = lit_;
  for (std::size_t i = 0; i < lit_.size(); ++i) lit_[i] = open[i] && light[i] > least;
  for (int ring = 0; ring < kRings; ++ring) {
    const std::vector<std::uint8_t> before = lit_;
    for (std::size_t i = 0; i < lit_.size(); ++i)
      for (const int place : {4, 10, 12, 14, 16, 22})
        if (open[i] && before[links_.neighbour(i, place)] && !(links_.hidden[i] >> place & 1u)) lit_[i] = 1;
  }
}

AirTransfer::Result AirTransfer::solve(const AirMatter& air, const Sources& sources, ThreadPool& pool) {
  for (std::size_t i = 0; i < lit_.size(); ++i) lit_[i] = links_.nearest[i] == i;
  sweep(air, sources, false, pool);
  Result out;
  project(ends_in_, out.ends, pool);
  find_lit(sources, out.ends);
  std::vector<Vec3f> usual = sources.usual;
  if (usual.empty())
    for (std::size_t i = 0; i < out.ends.size(); ++i) usual.push_back(mean_of(out.ends[i]) + mean_of(sources.direct[i]));
  const auto all_light = [&] {
    double sum = 0;
    for (const Terms& terms : total_) sum += double(terms[0].c[0] + terms[0].c[1] + terms[0].c[2]);
    return sum;
  };
  const bool empty = std::all_of(air.extinction.begin(), air.extinction.end(), [](float e) { return e <= 0; });
  gather_total(sources, pool);
  double before = all_light();
  for (int n = 0; n < sources.most && !empty; ++n) {
    find_response(usual);
    sweep(air, sources, true, pool);
    gather_total(sources, pool);
    const double now = all_light();
    if (std::fabs(now - before) <= sources.tolerance * now) break;
    before = now;
  }
  project(ends_in_, out.ends, pool);
  project(air_in_, out.air, pool);
  out.stand_in = choose_sides(sources.brighter);
  return out;
}

}  // namespace rubble
