#include "kernel/collision/gjk.h"

namespace rubble {
namespace {

constexpr int kMaxIterations = 32;  // what has not converged by then keeps the best bound so far
constexpr float kRelativeTolerance = 1e-4F;  // of the distance: 0.01 mm at 0.1 m
// A distance is accepted if its proven lower bound differs by less than this share: the rest is rounding.
// Without this test, pieces at rest lost contacts at times, and piles crept. unit: 1
constexpr float kAcceptedShare = 1e-2F;
// A distance is also accepted if its proven lower bound differs by less than this. unit: m
constexpr float kAcceptedGap = 5e-4F;
constexpr float kTouching2 = 1e-10F;  // below this squared distance, (10 micrometres)^2, parts touch; unit: m2

struct Vertex {
  Vec3f w;  // a - b
  int a = 0, b = 0;
};

struct Simplex {
  Vertex v[4];
  float weight[4] = {1, 0, 0, 0};
  int size = 0;

  Vec3f closest() const {
    Vec3f sum;
    for (int i = 0; i < size; ++i) sum += v[i].w * weight[i];
    return sum;
  }
  void keep(int i) { v[0] = v[i], weight[0] = 1, size = 1; }
  void keep(int i, int j, float wi, float wj) {
    const Vertex a = v[i], b = v[j];
    v[0] = a, v[1] = b, weight[0] = wi, weight[1] = wj, size = 2;
  }
};

void solve_segment(Simplex& s) {
  const Vec3f d = s.v[1].w - s.v[0].w;
  const float t = -dot(s.v[0].w, d), length2 = dot(d, d);
  if (t <= 0) return s.keep(0);
  if (t >= length2) return s.keep(1);
  s.weight[1] = t / length2;
  s.weight[0] = 1 - s.weight[1];
}

void solve_triangle(Simplex& s) {
  const Vec3f &a = s.v[0].w, &b = s.v[1].w, &c = s.v[2].w;
  const Vec3f ab = b - a, ac = c - a;
  const float d1 = -dot(ab, a), d2 = -dot(ac, a);
  if (d1 <= 0 && d2 <= 0) return s.keep(0);
  const float d3 = -dot(ab, b), d4 = -dot(ac, b);
  if (d3 >= 0 && d4 <= d3) return s.keep(1);
  const float vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return s.keep(0, 1, d3 / (d3 - d1), d1 / (d1 - d3));
  const float d5 = -dot(ab, c), d6 = -dot(ac, c);
  if (d6 >= 0 && d5 <= d6) return s.keep(2);
  const float vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return s.keep(0, 2, d6 / (d6 - d2), d2 / (d2 - d6));
  const float va = d3 * d6 - d5 * d4;
  if (va <= 0 && (d4 - d3) >= 0 && (d5 - d6) >= 0) {
    const float t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return s.keep(1, 2, 1 - t, t);
  }
  const float scale = 1 / (va + vb + vc);
  s.weight[1] = vb * scale;
  s.weight[2] = vc * scale;
  s.weight[0] = 1 - s.weight[1] - s.weight[2];
}

// Returns true when the origin is inside. `rounded`: the tetrahedron is so flat that rounding decides
// on which side of a face the origin is; then it is outside, and every face counts.
bool solve_tetrahedron(Simplex& s, bool rounded) {
  static constexpr int kFaces[4][4] = {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 3, 2, 0}};
  Simplex best;
  float best2 = 1e30F;
  bool inside = true;
  for (const auto& f : kFaces) {
    const Vec3f &a = s.v[f[0]].w, &b = s.v[f[1]].w, &c = s.v[f[2]].w, &d = s.v[f[3]].w;
    const Vec3f n = cross(b - a, c - a);
    // The origin is not strictly on the same side as the fourth corner.
    if (!rounded && -dot(n, a) * dot(n, d - a) > 0) continue;
    inside = false;
    Simplex t;
    t.v[0] = s.v[f[0]], t.v[1] = s.v[f[1]], t.v[2] = s.v[f[2]], t.size = 3;
    solve_triangle(t);
    const Vec3f p = t.closest();
    if (dot(p, p) < best2) best2 = dot(p, p), best = t;
  }
  if (!inside) s = best;
  return inside;
}

bool solve(Simplex& s) {
  if (s.size == 1) s.weight[0] = 1;
  if (s.size == 2) solve_segment(s);
  if (s.size == 3) solve_triangle(s);
  return s.size == 4 && solve_tetrahedron(s, false);
}

struct SimplexSearch {
  const PointSet& a;
  const PointSet& b;
  Vec3f offset;

  Vertex make(int ia, int ib) const { return {a.points[ia] - (b.points[ib] + offset), ia, ib}; }
  Vertex support(const Vec3f& d) const { return make(find_support(a, d), find_support(b, -d)); }

  Simplex start(const GjkCache& cache) const {
    Simplex s;
    for (int i = 0; i < cache.size; ++i) s.v[i] = make(cache.a[i], cache.b[i]);
    s.size = cache.size;
    if (s.size == 0) s.v[0] = make(0, 0), s.size = 1;
    return s;
  }
};

void store(const Simplex& s, GjkCache& cache) {
  cache.size = std::uint8_t(s.size < 3 ? s.size : 3);
  for (int i = 0; i < cache.size; ++i) {
    cache.a[i] = std::uint16_t(s.v[i].a);
    cache.b[i] = std::uint16_t(s.v[i].b);
  }
}

GjkResult finish(const SimplexSearch& search, const Simplex& s, const Vec3f& v, float v2) {
  GjkResult result;
  result.distance = std::sqrt(v2);
  result.normal = v * (-1 / result.distance);
  for (int i = 0; i < s.size; ++i) {
    result.point_a += search.a.points[s.v[i].a] * s.weight[i];
    result.point_b += (search.b.points[s.v[i].b] + search.offset) * s.weight[i];
  }
  return result;
}

// False when the descent ended short of the closest points: the simplex was too flat for it.
bool descend(const SimplexSearch& search, float margin, GjkCache& cache, GjkResult& result) {
  Simplex s = search.start(cache), whole;
  result = {};
  Vec3f v;
  float v2 = 0, vw = 0, last2 = 1e30F;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    if (s.size == 4) whole = s;
    const bool flat = s.size == 4, inside = solve(s);
    v = s.closest();
    v2 = dot(v, v);
    if (inside || v2 < kTouching2) {
      result.kind = GjkResult::Kind::overlapping;
      return true;
    }
    if (flat && v2 >= last2) {
      s = whole;
      solve_tetrahedron(s, true);
      v = s.closest();
      v2 = dot(v, v);
    }
    if (v2 >= last2 && iteration > 3) break;  // rounding ends the descent
    last2 = v2;
    const Vertex w = search.support(-v);
    vw = dot(v, w.w);
    if (vw > 0 && vw * vw > v2 * margin * margin) {
      store(s, cache);
      result = finish(search, s, v, v2);
      result.kind = GjkResult::Kind::beyond_margin;
      result.distance = vw / std::sqrt(v2);
      return true;
    }
    if (v2 - vw <= kRelativeTolerance * v2) break;
    bool known = false;
    for (int i = 0; i < s.size; ++i) known = known || (s.v[i].a == w.a && s.v[i].b == w.b);
    if (known) break;
    s.v[s.size++] = w;
  }
  store(s, cache);
  result = finish(search, s, v, v2);
  return v2 - vw <= kAcceptedShare * v2 + kAcceptedGap * result.distance;
}

}  // namespace

int find_support(const PointSet& set, const Vec3f& direction) {
  int best = 0;
  float best_dot = dot(set.points[0], direction);
  for (int i = 1; i < set.count; ++i) {
    const float d = dot(set.points[i], direction);
    if (d > best_dot) best_dot = d, best = i;
  }
  return best;
}

GjkResult calc_distance(const PointSet& a, const PointSet& b, const Vec3f& offset, float margin,
                        GjkCache& cache) {
  const SimplexSearch search{a, b, offset};
  GjkResult result;
  if (descend(search, margin, cache, result)) return result;
  cache.size = 0;
  if (descend(search, margin, cache, result)) return result;
  // Parts that hardly touch, most likely: the exact fallback decides.
  cache.size = 0;
  result.kind = GjkResult::Kind::overlapping;
  return result;
}

}  // namespace rubble
