#include <algorithm>
#include <cmath>
#include <cstdint>
#include <queue>

#include "assets/generator/surface_mesh.h"

namespace rubble::generator {
namespace {

// Sum of squared distances to planes, as x'Ax + 2 b'x + c.
struct Quadric {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
  Vec3 b;
  double c = 0;

  void add_plane(const Vec3& n, double offset, double weight) {
    xx += weight * n.x * n.x, xy += weight * n.x * n.y, xz += weight * n.x * n.z;
    yy += weight * n.y * n.y, yz += weight * n.y * n.z, zz += weight * n.z * n.z;
    b += n * (-offset * weight);
    c += offset * offset * weight;
  }
  // The squared distance to a point: keeps the minimum defined where planes alone do not.
  void add_point(const Vec3& p, double weight) {
    xx += weight, yy += weight, zz += weight;
    b += p * -weight;
    c += dot(p, p) * weight;
  }
  Quadric operator+(const Quadric& q) const {
    Quadric r = *this;
    r.xx += q.xx, r.xy += q.xy, r.xz += q.xz, r.yy += q.yy, r.yz += q.yz, r.zz += q.zz;
    r.b += q.b, r.c += q.c;
    return r;
  }
  double weight() const { return xx + yy + zz; }  // of all planes together
  Mat3 matrix() const { return {{{xx, xy, xz}, {xy, yy, yz}, {xz, yz, zz}}}; }
  double error(const Vec3& p) const { return dot(p, matrix() * p) + 2 * dot(b, p) + c; }
  Vec3 minimum() const {
    const Mat3 m = matrix();
    const Vec3 u = cross(m.rows[1], m.rows[2]), v = cross(m.rows[2], m.rows[0]),
               w = cross(m.rows[0], m.rows[1]);
    return (u * b.x + v * b.y + w * b.z) * (-1 / dot(m.rows[0], u));
  }
};

struct Candidate {
  double cost;
  int u, v;
  int age;  // of both ends together, to tell an outdated candidate

  bool operator<(const Candidate& o) const {  // the queue gives the largest first
    if (cost != o.cost) return cost > o.cost;
    return u != o.u ? u > o.u : v > o.v;
  }
};

constexpr double kBorderWeight = 0.04;  // of the line between surfaces against the surface itself
constexpr int kSweeps = 4;
constexpr double kSweepError = 1e-4;  // root mean square distance; unit: m

class Decimator {
 public:
  Decimator(const SurfaceMesh& mesh, const DecimateOptions& options)
      : mesh_(mesh), options_(options), live_(static_cast<int>(mesh.triangles.size())) {
    around_.resize(mesh.positions.size());
    ages_.assign(mesh.positions.size(), 0);
    stays_.assign(mesh.positions.size(), 0);
    marks_.assign(mesh.positions.size(), 0);
    dead_.assign(mesh.triangles.size(), false);
    for (int t = 0; t < live_; ++t) {
      for (const int v : mesh_.triangles[t]) around_[v].push_back(t);
    }
    add_quadrics();
  }

  SurfaceMesh run() {
    for (int i = 0; i < kSweeps; ++i) sweep();
    for (int v = 0; v < static_cast<int>(around_.size()); ++v) push_edges(v, true);
    while (live_ > options_.triangles && !queue_.empty()) {
      const Candidate best = queue_.top();
      queue_.pop();
      if (ages_[best.u] < 0 || ages_[best.v] < 0) continue;
      if (ages_[best.u] + ages_[best.v] != best.age) continue;
      const Vec3 target = calc_target(best.u, best.v, quadrics_[best.u] + quadrics_[best.v]);
      if (!allowed(best, target)) continue;
      collapse(best, target);
      push_edges(best.u, false);
    }
    return compact();
  }

 private:
  const Vec3& at(int v) const { return mesh_.positions[v]; }

  Vec3 area_vector(int t) const {
    const auto& c = mesh_.triangles[t];
    return cross(at(c[1]) - at(c[0]), at(c[2]) - at(c[0])) * 0.5;
  }

  void add_quadrics() {
    quadrics_.resize(mesh_.positions.size());
    for (int t = 0; t < live_; ++t) {
      const Vec3 area = area_vector(t), n = normalized(area);
      const auto& c = mesh_.triangles[t];
      for (int i = 0; i < 3; ++i) {
        quadrics_[c[i]].add_plane(n, dot(n, at(c[0])), norm(area) / 3);
        add_border(t, c[i], c[(i + 1) % 3], n, norm(area));
      }
    }
  }

  // A plane across the triangle along an edge where the surface changes holds the line there.
  void add_border(int t, int a, int b, const Vec3& normal, double area) {
    for (const int other : around_[a]) {
      const auto& c = mesh_.triangles[other];
      if (other == t || std::find(c.begin(), c.end(), b) == c.end()) continue;
      if (mesh_.surfaces[other] == mesh_.surfaces[t]) return;
      const Vec3 across = normalized(cross(at(b) - at(a), normal));
      quadrics_[a].add_plane(across, dot(across, at(a)), kBorderWeight * area);
      quadrics_[b].add_plane(across, dot(across, at(a)), kBorderWeight * area);
    }
  }

  // In any order, into `result`: lists that are kept spare an allocation for each of millions of calls.
  // Until the next call, is_neighbour() tells them from others.
  void find_neighbours(int v, std::vector<int>& result) {
    result.clear();
    ++mark_;
    for (const int t : around_[v]) {
      for (const int w : mesh_.triangles[t]) {
        if (w == v || marks_[w] == mark_) continue;
        marks_[w] = mark_;
        result.push_back(w);
      }
    }
  }
  bool is_neighbour(int w) const { return marks_[w] == mark_; }

  void push_edges(int v, bool upward_only) {
    find_neighbours(v, around_v_);
    for (const int w : around_v_) {
      if (!upward_only || w > v) push(std::min(v, w), std::max(v, w));
    }
  }

  // Collapses, in order of the vertices, what changes the surface by next to nothing. Most of a
  // freshly sampled mesh goes this way at a fraction of the queue's cost. A vertex that stayed is asked
  // again only after something near it has changed.
  void sweep() {
    for (int v = 0; v < static_cast<int>(around_.size()); ++v) {
      if (live_ <= 2 * options_.triangles) return;
      if (ages_[v] < 0 || stays_[v]) continue;
      Candidate best{kSweepError * kSweepError, -1, v, 0};
      Vec3 best_target;
      find_neighbours(v, around_v_);
      for (const int w : around_v_) {
        const Quadric sum = quadrics_[v] + quadrics_[w];
        const Vec3 target = calc_target(w, v, sum);
        const double error = sum.error(target) / sum.weight();
        if (error < best.cost || (error == best.cost && w < best.u)) {
          best.cost = error, best.u = w, best_target = target;
        }
      }
      stays_[v] = best.u < 0 || !allowed(best, best_target);
      if (stays_[v]) continue;
      collapse(best, best_target);
      ask_again_around(best.u);
    }
  }

  // Whether a vertex stays depends on what is two edges away at most.
  void ask_again_around(int u) {
    find_neighbours(u, ring_u_);
    for (const int w : ring_u_) {
      for (const int t : around_[w]) {
        for (const int x : mesh_.triangles[t]) stays_[x] = 0;
      }
    }
  }

  Vec3 calc_target(int u, int v, const Quadric& sum) const {
    Quadric solvable = sum;
    solvable.add_point((at(u) + at(v)) * 0.5, 1e-3 * sum.weight() + 1e-15);
    return solvable.minimum();
  }

  void push(int u, int v) {
    const Quadric sum = quadrics_[u] + quadrics_[v];
    const Vec3 edge = at(v) - at(u);
    // A small price on length evens out the triangles where the surface is flat.
    const double cost =
        std::fmax(0.0, sum.error(calc_target(u, v, sum))) + 2e-4 * sum.weight() * dot(edge, edge);
    queue_.push({cost, u, v, ages_[u] + ages_[v]});
  }

  bool allowed(const Candidate& c, const Vec3& target) {
    find_neighbours(c.v, ring_v_);
    find_neighbours(c.u, ring_u_);
    const auto shared = std::count_if(ring_v_.begin(), ring_v_.end(), [&](int w) { return is_neighbour(w); });
    if (shared != 2 || ring_u_.size() + ring_v_.size() < 9) return false;  // stays manifold
    for (const auto* ring : {&ring_u_, &ring_v_}) {
      for (const int w : *ring) {
        if (w != c.u && w != c.v && distance(at(w), target) > options_.max_edge) return false;
      }
    }
    return keeps_facing(c.u, c.v, target) && keeps_facing(c.v, c.u, target);
  }

  // No triangle around `v` may turn over or become a needle when v moves to the target.
  bool keeps_facing(int v, int other, const Vec3& target) const {
    for (const int t : around_[v]) {
      const auto& c = mesh_.triangles[t];
      if (std::find(c.begin(), c.end(), other) != c.end()) continue;
      const int i = static_cast<int>(std::find(c.begin(), c.end(), v) - c.begin());
      const Vec3& p = at(c[(i + 1) % 3]);
      const Vec3& q = at(c[(i + 2) % 3]);
      const Vec3 before = cross(p - at(v), q - at(v)), after = cross(p - target, q - target);
      if (dot(before, after) < options_.facing * norm(before) * norm(after)) return false;
      const double longest = std::fmax(norm(q - p), std::fmax(norm(p - target), norm(q - target)));
      if (norm(after) < 0.16 * options_.facing * longest * longest) return false;
    }
    return true;
  }

  void collapse(const Candidate& c, const Vec3& target) {
    mesh_.positions[c.u] = target;
    quadrics_[c.u] = quadrics_[c.u] + quadrics_[c.v];
    ring_u_.clear();  // of vertices that lose a triangle
    for (const int t : around_[c.v]) {
      auto& corners = mesh_.triangles[t];
      if (std::find(corners.begin(), corners.end(), c.u) != corners.end()) {
        remove(t);
        for (const int w : corners) {
          if (w != c.u && w != c.v) ring_u_.push_back(w);
        }
      } else {
        std::replace(corners.begin(), corners.end(), c.v, c.u);
        around_[c.u].push_back(t);
      }
    }
    around_[c.v].clear();
    ages_[c.v] = -1;
    ages_[c.u] += 1;
    forget_dead(c.u);
    for (const int w : ring_u_) forget_dead(w);
  }

  void forget_dead(int v) {
    auto& list = around_[v];
    const auto gone = [&](int t) { return dead_[t]; };
    list.erase(std::remove_if(list.begin(), list.end(), gone), list.end());
  }

  void remove(int t) {
    dead_[t] = true;
    --live_;
  }

  SurfaceMesh compact() const {
    SurfaceMesh result;
    std::vector<int> numbers(mesh_.positions.size(), -1);
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (dead_[t]) continue;
      std::array<int, 3> corners = mesh_.triangles[t];
      for (int& v : corners) {
        if (numbers[v] < 0) {
          numbers[v] = static_cast<int>(result.positions.size());
          result.positions.push_back(at(v));
        }
        v = numbers[v];
      }
      result.triangles.push_back(corners);
      result.surfaces.push_back(mesh_.surfaces[t]);
    }
    return result;
  }

  SurfaceMesh mesh_;
  DecimateOptions options_;
  int live_;
  std::vector<std::vector<int>> around_;  // triangles at each vertex
  std::vector<int> ages_;                 // -1: gone
  std::vector<std::uint8_t> stays_;       // 1: a sweep finds nothing to do
  std::vector<bool> dead_;
  std::vector<Quadric> quadrics_;
  std::priority_queue<Candidate> queue_;
  std::vector<int> around_v_, ring_u_, ring_v_;  // of the call at hand
  std::vector<int> marks_;  // mark_: found by the last find_neighbours()
  int mark_ = 0;
};

}  // namespace

SurfaceMesh decimate(const SurfaceMesh& mesh, const DecimateOptions& options) {
  return Decimator(mesh, options).run();
}

}  // namespace rubble::generator
