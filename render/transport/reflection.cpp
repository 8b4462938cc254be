#include "render/transport/reflection.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "kernel/base/portable_math.h"
#include "kernel/base/quick_math.h"

namespace rubble {

namespace {

constexpr float kLeastCosine = 1e-4f;
constexpr float kLeastRoughness = 0.02f;

float power5(float x) {
  const float x2 = x * x;
  return x2 * x2 * x;
}

// Density of half vectors, per solid angle.
float distribution(float cos_h, float alpha) {
  const float a2 = alpha * alpha, t = cos_h * cos_h * (a2 - 1) + 1;
  return a2 / (portable::kPiF * t * t);
}

// Smith's lambda.
float hidden(float cosine, float alpha) {
  const float c2 = std::max(cosine * cosine, 1e-8f);
  return 0.5f * (std::sqrt(1 + alpha * alpha * (1 - c2) / c2) - 1);
}

// A normal that is seen from `out` (Heitz 2018, "Sampling the GGX Distribution of Visible Normals").
Vec3f sample_visible_normal(const Vec3f& out, float alpha, SamplePair u) {
  const Vec3f v = normalized(Vec3f(alpha * out.x, alpha * out.y, out.z));
  const float flat2 = v.x * v.x + v.y * v.y;
  const Vec3f t1 =
      flat2 > 1e-12f ? Vec3f(-v.y, v.x, 0) * (1 / std::sqrt(flat2)) : Vec3f(1, 0, 0);
  const Vec3f t2 = cross(v, t1);
  const float r = std::sqrt(u.x), turn = 2 * portable::kPiF * u.y;
  const float p1 = r * quick::cos(turn), s = 0.5f * (1 + v.z);
  const float p2 = (1 - s) * std::sqrt(std::max(0.0f, 1 - p1 * p1)) + s * r * quick::sin(turn);
  const Vec3f n = t1 * p1 + t2 * p2 + v * std::sqrt(std::max(0.0f, 1 - p1 * p1 - p2 * p2));
  return normalized(Vec3f(alpha * n.x, alpha * n.y, std::max(1e-6f, n.z)));
}

float visible_normal_density(const Vec3f& out, const Vec3f& h, float alpha) {
  return distribution(h.z, alpha) * std::max(0.0f, dot(out, h)) /
         ((1 + hidden(out.z, alpha)) * std::max(out.z, kLeastCosine));
}

// E(cosine) of a layer of reflectance F0 is F0 first + second.
struct Share {
  float first = 0, second = 0;
};

class ShareTable {
 public:
  static constexpr int kCosines = 64, kRoughnesses = 32;

  ShareTable() {
    for (int j = 0; j < kRoughnesses; ++j)
      for (int i = 0; i < kCosines; ++i)
        values_[std::size_t(j * kCosines + i)] = integrate(cosine_at(i), roughness_at(j));
    for (int j = 0; j < kRoughnesses; ++j) {
      Share mean;  // cosine-weighted
      constexpr int kSteps = 256;
      for (int k = 0; k < kSteps; ++k) {
        const float c = (float(k) + 0.5f) / kSteps;
        const Share s = at(c, roughness_at(j));
        mean.first += 2 * c * s.first / kSteps, mean.second += 2 * c * s.second / kSteps;
      }
      means_[std::size_t(j)] = mean;
    }
  }

  Share at(float cosine, float roughness) const {
    const float x = std::sqrt(std::clamp(cosine, 0.0f, 1.0f)) * (kCosines - 1);
    const float y = row_of(roughness);
    const int i = std::min(int(x), kCosines - 2), j = std::min(int(y), kRoughnesses - 2);
    const Share* p = &values_[std::size_t(j * kCosines + i)];
    const Share low = blend(p[0], p[1], x - float(i));
    return blend(low, blend(p[kCosines], p[kCosines + 1], x - float(i)), y - float(j));
  }
  Share mean(float roughness) const {
    const float y = row_of(roughness);
    const int j = std::min(int(y), kRoughnesses - 2);
    return blend(means_[std::size_t(j)], means_[std::size_t(j) + 1], y - float(j));
  }

 private:
  static float cosine_at(int i) {
    const float t = float(i) / (kCosines - 1);
    return std::max(t * t, kLeastCosine);
  }
  static float roughness_at(int j) {
    const float t = float(j) / (kRoughnesses - 1);
    return kLeastRoughness + (1 - kLeastRoughness) * t * t;
  }
  static float row_of(float roughness) {
    const float t = (roughness - kLeastRoughness) / (1 - kLeastRoughness);
    return std::sqrt(std::clamp(t, 0.0f, 1.0f)) * (kRoughnesses - 1);
  }
  static Share blend(const Share& a, const Share& b, float t) {
    return {a.first + (b.first - a.first) * t, a.second + (b.second - a.second) * t};
  }
  static Share integrate(float cosine, float alpha) {
    constexpr int kSide = 32;
    const Vec3f out(std::sqrt(std::max(0.0f, 1 - cosine * cosine)), 0, cosine);
    Share sum;
    for (int a = 0; a < kSide; ++a) {
      for (int b = 0; b < kSide; ++b) {
        // Finer steps towards 1: the distribution has a long tail, much of it below the horizon.
        const float rest = 1 - (float(a) + 0.5f) / kSide, weight = 3 * rest * rest;
        const SamplePair u{1 - rest * rest * rest, (float(b) + 0.5f) / kSide};
        const Vec3f h = sample_visible_normal(out, alpha, u);
        const Vec3f in = h * (2 * dot(out, h)) - out;
        if (in.z <= 0) continue;
        const float lambda = hidden(out.z, alpha);
        const float g = (1 + lambda) / (1 + lambda + hidden(in.z, alpha));
        const float fresnel = power5(1 - std::clamp(dot(out, h), 0.0f, 1.0f));
        sum.first += weight * g * (1 - fresnel), sum.second += weight * g * fresnel;
      }
    }
    return {sum.first / (kSide * kSide), sum.second / (kSide * kSide)};
  }

  std::array<Share, std::size_t(kCosines) * kRoughnesses> values_;
  std::array<Share, kRoughnesses> means_;
};

const ShareTable& shares() {
  static const ShareTable table;
  return table;
}

float mean_mirrored(const MirrorLayer& layer) {
  if (layer.cover <= 0) return 0;
  const Share s = shares().mean(layer.roughness);
  return layer.cover * (layer.reflectance * s.first + s.second);
}

// Of light between o and the base; the two layers side by side.
float passes(const Reflection& r, float cosine) {
  return std::max(0.0f, 1 - mirrored_share(r.gloss, cosine) - mirrored_share(r.film, cosine));
}

float mirror(const MirrorLayer& layer, const Vec3f& out, const Vec3f& in) {  // f cos_i
  if (layer.cover <= 0) return 0;
  const Vec3f h = normalized(out + in);
  const float fresnel =
      layer.reflectance + (1 - layer.reflectance) * power5(1 - std::clamp(dot(out, h), 0.0f, 1.0f));
  const float shadowing =
      1 / (1 + hidden(out.z, layer.roughness) + hidden(in.z, layer.roughness));
  return layer.cover * fresnel * distribution(h.z, layer.roughness) * shadowing /
         (4 * std::max(out.z, kLeastCosine));
}

float mirror_density(const MirrorLayer& layer, const Vec3f& out, const Vec3f& in) {
  if (layer.cover <= 0) return 0;
  const Vec3f h = normalized(out + in);
  return visible_normal_density(out, h, layer.roughness) /
         (4 * std::max(dot(out, h), kLeastCosine));
}

// How often each part is chosen: by the light it gives back.
struct Chances {
  float gloss = 0, film = 0;  // the rest: the base
};
Chances chances(const Reflection& r, float cosine) {
  const float gloss = mirrored_share(r.gloss, cosine), film = mirrored_share(r.film, cosine);
  const float base = std::max(r.base.x, std::max(r.base.y, r.base.z)) * passes(r, cosine);
  const float sum = gloss + film + base;
  return sum > 0 ? Chances{gloss / sum, film / sum} : Chances{};
}

Vec3f mirrored_about(const Vec3f& out, const Vec3f& h) { return h * (2 * dot(out, h)) - out; }

}  // namespace

float mirrored_share(const MirrorLayer& layer, float cosine) {
  if (layer.cover <= 0) return 0;
  const Share s = shares().at(cosine, layer.roughness);
  return layer.cover * (layer.reflectance * s.first + s.second);
}

Vec3f mean_albedo(const Reflection& r) {
  const float mirrored = mean_mirrored(r.gloss) + mean_mirrored(r.film);
  return Vec3f(1, 1, 1) * mirrored + r.base * std::max(0.0f, 1 - mirrored);
}

Vec3f reflect_share(const Reflection& r, const Vec3f& out, const Vec3f& in) {
  if (in.z <= 0) return {};
  if (r.matt()) return r.base * (in.z / portable::kPiF);
  if (out.z <= 0) return {};
  const float left = 1 - mean_mirrored(r.gloss) - mean_mirrored(r.film);
  const float base =
      left > 1e-6f ? passes(r, out.z) * passes(r, in.z) / left * (in.z / portable::kPiF) : 0;
  const float mirrored = mirror(r.gloss, out, in) + mirror(r.film, out, in);
  return r.base * base + Vec3f(1, 1, 1) * mirrored;
}

float reflection_density(const Reflection& r, const Vec3f& out, const Vec3f& in) {
  if (in.z <= 0) return 0;
  if (r.matt()) return in.z / portable::kPiF;
  if (out.z <= 0) return 0;
  const Chances c = chances(r, out.z);
  return c.gloss * mirror_density(r.gloss, out, in) + c.film * mirror_density(r.film, out, in) +
         (1 - c.gloss - c.film) * in.z / portable::kPiF;
}

ReflectedSample sample_reflection(const Reflection& r, const Vec3f& out, SamplePair u, float choice) {
  ReflectedSample sample;
  const Chances c = r.matt() || out.z <= 0 ? Chances{} : chances(r, out.z);
  if (choice < c.gloss) {
    sample.in = mirrored_about(out, sample_visible_normal(out, r.gloss.roughness, u));
  } else if (choice < c.gloss + c.film) {
    sample.in = mirrored_about(out, sample_visible_normal(out, r.film.roughness, u));
  } else {
    const float radius = std::sqrt(u.x), turn = 2 * portable::kPiF * u.y;
    sample.in = {radius * quick::cos(turn), radius * quick::sin(turn), std::sqrt(1 - u.x)};
  }
  if (r.matt()) {
    sample.weight = r.base, sample.density = sample.in.z / portable::kPiF;
    return sample;
  }
  sample.density = reflection_density(r, out, sample.in);
  if (sample.density > 0) sample.weight = reflect_share(r, out, sample.in) * (1 / sample.density);
  return sample;
}

}  // namespace rubble
