#include "render/devices/software/shadow_raster.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace rubble {

namespace {

constexpr int kGridSteps = TriangleRecord::kGrid;
constexpr int kRowsABand = 64;
constexpr std::uint32_t kClustersAJob = 64;
constexpr std::size_t kJobsATime = 64;  // so that memory for triangles is limited
constexpr std::size_t kMostCorners = 256;  // of a cluster
constexpr double kGuard = 8;  // halves of the map from its middle beyond which a triangle is clipped
constexpr double kLeastW = 1e-5;  // in front of a light that is no sun; unit: m

// x, y and z over w are places on the map, from -1 to 1, and depth from 0 to 1.
struct ClipPoint {
  double x = 0, y = 0, z = 0, w = 0;
};

ClipPoint between(const ClipPoint& a, const ClipPoint& b, double share) {
  return {a.x + (b.x - a.x) * share, a.y + (b.y - a.y) * share, a.z + (b.z - a.z) * share, a.w + (b.w - a.w) * share};
}

using ClipPolygon = std::array<ClipPoint, 9>;

// The planes that bound what is drawn: positive inside.
double side_of(int plane, const ClipPoint& p) {
  switch (plane) {
    case 0:
      return p.w - kLeastW;
    case 1:
      return kGuard * p.w + p.x;
    case 2:
      return kGuard * p.w - p.x;
    case 3:
      return kGuard * p.w + p.y;
    default:
      return kGuard * p.w - p.y;
  }
}

bool is_inside(const ClipPoint& p) {
  return p.w >= kLeastW && std::fabs(p.x) <= kGuard * p.w && std::fabs(p.y) <= kGuard * p.w;
}

// Sutherland and Hodgman. A new corner is found from the inner end of its edge, the same for both triangles at the edge.
int clip_polygon(ClipPolygon& polygon) {
  int count = 3;
  for (int plane = 0; plane < 5 && count > 0; ++plane) {
    ClipPolygon out;
    int kept = 0;
    for (int i = 0; i < count; ++i) {
      const ClipPoint& p = polygon[std::size_t(i)];
      const ClipPoint& q = polygon[std::size_t((i + 1) % count)];
      const double dp = side_of(plane, p), dq = side_of(plane, q);
      if (dp >= 0) out[std::size_t(kept++)] = p;
      if ((dp >= 0) == (dq >= 0)) continue;
      out[std::size_t(kept++)] = dp >= 0 ? between(p, q, dp / (dp - dq)) : between(q, p, dq / (dq - dp));
    }
    polygon = out, count = kept;
  }
  return count;
}

// Depth z / w is linear on the map. False where the light sees the triangle edge-on.
bool set_depth_plane(const ClipPoint& a, const ClipPoint& b, const ClipPoint& c, int side, TriangleRecord& out) {
  const Vec3 p(a.x, a.y, a.w), q(b.x, b.y, b.w), r(c.x, c.y, c.w);
  const Vec3 qr = cross(q, r), rp = cross(r, p), pq = cross(p, q);
  const double volume = dot(p, qr);
  if (volume == 0) return false;
  const Vec3 slope = (qr * a.z + rp * b.z + pq * c.z) * (1 / volume);
  // Texel u lies at 2 (u + 0.5) / side - 1.
  const double step = 2.0 / side, first = 1.0 / side - 1;
  out.a = slope.x * step, out.b = slope.y * step, out.c = slope.z + (slope.x + slope.y) * first;
  return true;
}

// On the grid, with texels' centres at whole numbers.
std::int32_t grid_place(double over_w, int side) {
  return std::int32_t(std::floor(((over_w * 0.5 + 0.5) * side - 0.5) * kGridSteps + 0.5));
}

// Turned so that it faces the light. False: it covers nothing.
bool turn_to_light(TriangleRecord& t, int side) {
  const std::int64_t area = std::int64_t(t.x[1] - t.x[0]) * (t.y[2] - t.y[0]) -
                            std::int64_t(t.y[1] - t.y[0]) * (t.x[2] - t.x[0]);
  if (area == 0) return false;
  if (area < 0) std::swap(t.x[1], t.x[2]), std::swap(t.y[1], t.y[2]);
  const auto covers = [side](const std::int32_t (&v)[3]) {
    const auto [low, high] = std::minmax({v[0], v[1], v[2]});
    return std::max((low + kGridSteps - 1) >> 8, 0) <= std::min(high >> 8, side - 1);
  };
  return covers(t.x) && covers(t.y);
}

void append_triangle(const std::array<ClipPoint, 3>& corners, int side, std::vector<TriangleRecord>& out) {
  TriangleRecord t{};
  if (!set_depth_plane(corners[0], corners[1], corners[2], side, t)) return;
  ClipPolygon polygon{corners[0], corners[1], corners[2]};
  int count = 3;
  t.least = 0, t.most = 1;
  if (is_inside(corners[0]) && is_inside(corners[1]) && is_inside(corners[2])) {
    const auto [low, high] =
        std::minmax({corners[0].z / corners[0].w, corners[1].z / corners[1].w, corners[2].z / corners[2].w});
    t.least = float(std::clamp(low, 0.0, 1.0)), t.most = float(std::clamp(high, 0.0, 1.0));
  } else {
    count = clip_polygon(polygon);
  }
  std::array<std::int32_t, 9> u{}, v{};
  for (std::size_t i = 0; i < std::size_t(count); ++i)
    u[i] = grid_place(polygon[i].x / polygon[i].w, side), v[i] = grid_place(polygon[i].y / polygon[i].w, side);
  for (std::size_t i = 1; i + 1 < std::size_t(count); ++i) {
    t.x[0] = u[0], t.x[1] = u[i], t.x[2] = u[i + 1];
    t.y[0] = v[0], t.y[1] = v[i], t.y[2] = v[i + 1];
    if (turn_to_light(t, side)) out.push_back(t);
  }
}

// Whether the light may see something of the piece.
bool in_view(const ShadowViews::Rows& rows, const PlacedMesh& piece) {
  const auto outside = [&](double x, double y, double w) {
    Vec3 normal;
    for (int k = 0; k < 3; ++k)
      normal[k] = x * rows[0][std::size_t(k)] + y * rows[1][std::size_t(k)] + w * rows[3][std::size_t(k)];
    const double offset = x * rows[0][3] + y * rows[1][3] + w * rows[3][3];
    return dot(normal, Vec3(piece.centre)) + offset < -(double(piece.radius) * 1.001 + 1e-4) * norm(normal);
  };
  return !outside(1, 0, 1) && !outside(-1, 0, 1) && !outside(0, 1, 1) && !outside(0, -1, 1) && !outside(0, 0, 1);
}

}  // namespace

void ShadowRaster::find_clusters(const ShadowViews::Rows& rows, ShadowPart part) {
  clusters_.clear();
  for (std::uint32_t i = 0; i < scene_.placed.size(); ++i) {
    const PlacedMesh& piece = scene_.placed[i];
    if (!casts_shadow(piece, part) || !in_view(rows, piece)) continue;
    const PreparedLevel& level = scene_.meshes[piece.mesh].levels.front();
    const std::uint32_t last = level.first_cluster + level.cluster_count;
    for (std::uint32_t first = level.first_cluster; first < last; first += kClustersAJob)
      clusters_.push_back({i, first, std::min(first + kClustersAJob, last)});
  }
}

void ShadowRaster::set_up(const Clusters& clusters, const ShadowViews::Rows& rows, int side, Job& job) const {
  const PlacedMesh& piece = scene_.placed[clusters.placed];
  const PreparedMesh& mesh = scene_.meshes[piece.mesh];
  const ClusterShapes& shapes = shapes_[piece.mesh];
  const auto m = clip_from_mesh(rows, piece);
  float x[kMostCorners], y[kMostCorners], z[kMostCorners], w[kMostCorners];
  for (std::uint32_t c = clusters.first; c < clusters.last; ++c) {
    const ClusterShapes::Range& range = shapes.clusters[c];
    const float* mx = shapes.x.data() + range.first_vertex;
    const float* my = shapes.y.data() + range.first_vertex;
    const float* mz = shapes.z.data() + range.first_vertex;
    for (std::uint32_t i = 0; i < range.vertex_count; ++i) {
      x[i] = m[0][0] * mx[i] + m[0][1] * my[i] + m[0][2] * mz[i] + m[0][3];
      y[i] = m[1][0] * mx[i] + m[1][1] * my[i] + m[1][2] * mz[i] + m[1][3];
      z[i] = m[2][0] * mx[i] + m[2][1] * my[i] + m[2][2] * mz[i] + m[2][3];
      w[i] = m[3][0] * mx[i] + m[3][1] * my[i] + m[3][2] * mz[i] + m[3][3];
    }
    const std::uint8_t* corner = shapes.corners.data() + 3 * range.first_triangle;
    for (std::uint32_t t = 0; t < range.triangle_count; ++t, corner += 3) {
      if (!is_opaque(mesh, mesh.clusters[c].first_triangle + t)) continue;
      std::array<ClipPoint, 3> corners;
      for (std::size_t k = 0; k < 3; ++k)
        corners[k] = {double(x[corner[k]]), double(y[corner[k]]), double(z[corner[k]]), double(w[corner[k]])};
      append_triangle(corners, side, job.triangles);
    }
  }
}

void ShadowRaster::draw(const ShadowViews::Rows& rows, ShadowPart part, int side, float* depth) {
  find_clusters(rows, part);
  const int bands = (side + kRowsABand - 1) / kRowsABand;
  jobs_.resize(std::min(kJobsATime, clusters_.size()));
  for (std::size_t first = 0; first < clusters_.size(); first += kJobsATime) {
    const int count = int(std::min(kJobsATime, clusters_.size() - first));
    pool_.run(count, 1, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) {
        Job& job = jobs_[std::size_t(i)];
        job.triangles.clear();
        set_up(clusters_[first + std::size_t(i)], rows, side, job);
        job.bands.resize(std::size_t(bands));
        for (auto& band : job.bands) band.clear();
        for (std::size_t k = 0; k < job.triangles.size(); ++k) {
          const TriangleRecord& t = job.triangles[k];
          const auto [low, high] = std::minmax({t.y[0], t.y[1], t.y[2]});
          const int last = std::min(high >> 8, side - 1) / kRowsABand;
          for (int band = std::max(low >> 8, 0) / kRowsABand; band <= last; ++band)
            job.bands[std::size_t(band)].push_back(std::uint32_t(k));
        }
      }
    });
    pool_.run(bands, 1, [&](int begin, int end) {
      for (int band = begin; band < end; ++band) {
        const DepthTarget target{depth, side, band * kRowsABand, std::min((band + 1) * kRowsABand, side)};
        for (std::size_t i = 0; i < std::size_t(count); ++i)
          for (const std::uint32_t k : jobs_[i].bands[std::size_t(band)]) fill_triangle(jobs_[i].triangles[k], target);
      }
    });
  }
  if (part == ShadowPart::resting) jobs_.clear();  // it is drawn once, and is most of the scene
}

}  // namespace rubble
