#include "render/devices/software/triangle_setup.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "kernel/base/error.h"

namespace rubble {

namespace {

constexpr std::size_t kMostVertices = 256;  // of a cluster: local numbers are bytes
constexpr std::size_t kMostTriangles = 256;
constexpr int kGrid = TriangleRecord::kGrid;

// The same function for wide vectors where the processor has them, chosen as the program starts;
// not under the sanitizers, which are not ready by then.
#if defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define RUBBLE_WIDE __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define RUBBLE_WIDE
#endif

// A cluster's vertices as the camera sees them.
struct Moved {
  float x[kMostVertices], y[kMostVertices], z[kMostVertices];  // optical frame; unit: m
  float value[kMostVertices];                                  // near / Z
  std::int32_t u[kMostVertices], v[kMostVertices];             // on the grid
  std::int32_t inside[kMostVertices];                          // of the guard band
};

RUBBLE_WIDE
void move_vertices(const ClusterShapes& shapes, const ClusterShapes::Range& range,
                   const MeshView& view, Moved& out) {
  const float* mx = shapes.x.data() + range.first_vertex;
  const float* my = shapes.y.data() + range.first_vertex;
  const float* mz = shapes.z.data() + range.first_vertex;
  const auto& r = view.rows;
  const float fx = float(view.fx * kGrid), fy = float(view.fy * kGrid);
  const float cx = float(view.cx * kGrid), cy = float(view.cy * kGrid);
  const float guard = float(view.guard * kGrid);
  const std::int32_t shift = view.guard * kGrid;
  for (std::uint32_t i = 0; i < range.vertex_count; ++i) {
    out.x[i] = r[0][0] * mx[i] + r[0][1] * my[i] + r[0][2] * mz[i] + r[0][3];
    out.y[i] = r[1][0] * mx[i] + r[1][1] * my[i] + r[1][2] * mz[i] + r[1][3];
    out.z[i] = r[2][0] * mx[i] + r[2][1] * my[i] + r[2][2] * mz[i] + r[2][3];
  }
  for (std::uint32_t i = 0; i < range.vertex_count; ++i) {
    const float inverse = 1 / std::max(out.z[i], kNearPlane);
    out.value[i] = kNearPlane * inverse;
    const float u = fx * out.x[i] * inverse + cx, v = fy * out.y[i] * inverse + cy;
    out.inside[i] = (out.z[i] >= kNearPlane) & (std::fabs(u) < guard) & (std::fabs(v) < guard);
    // A shift keeps the number positive, so that cutting off rounds down: as vectors can.
    out.u[i] = std::int32_t(std::min(std::max(u, -guard), guard) + (guard + 0.5f)) - shift;
    out.v[i] = std::int32_t(std::min(std::max(v, -guard), guard) + (guard + 0.5f)) - shift;
  }
}

// Positive for a triangle that faces the camera, on an image whose rows run downwards.
std::int64_t area_of(const TriangleRecord& t) {
  return std::int64_t(t.x[1] - t.x[0]) * (t.y[2] - t.y[0]) -
         std::int64_t(t.y[1] - t.y[0]) * (t.x[2] - t.x[0]);
}

inline bool covers_a_centre(const TriangleRecord& t, const MeshView& view) {
  const std::int32_t low_x = std::min(t.x[0], std::min(t.x[1], t.x[2]));
  const std::int32_t high_x = std::max(t.x[0], std::max(t.x[1], t.x[2]));
  const std::int32_t low_y = std::min(t.y[0], std::min(t.y[1], t.y[2]));
  const std::int32_t high_y = std::max(t.y[0], std::max(t.y[1], t.y[2]));
  const int x0 = std::max((low_x + kGrid - 1) >> 8, 0);
  const int x1 = std::min(high_x >> 8, view.width - 1);
  const int y0 = std::max((low_y + kGrid - 1) >> 8, 0);
  const int y1 = std::min(high_y >> 8, view.height - 1);
  return x0 <= x1 && y0 <= y1;
}

// What comes of a triangle of a cluster: nothing, a record, or one to be clipped first.
enum Fate : std::int32_t { kDropped, kWhole, kToClip };

// area_of() and covers_a_centre() of all triangles of a cluster, in a loop that vectors can take.
RUBBLE_WIDE
void judge(const std::uint8_t* corners, std::uint32_t count, const Moved& m, const MeshView& view,
           std::int32_t* fates) {
  const std::int32_t right = (view.width - 1) * kGrid, bottom = (view.height - 1) * kGrid;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t c0 = corners[3 * i], c1 = corners[3 * i + 2], c2 = corners[3 * i + 1];
    const std::int32_t x0 = m.u[c0], x1 = m.u[c1], x2 = m.u[c2];
    const std::int32_t y0 = m.v[c0], y1 = m.v[c1], y2 = m.v[c2];
    const std::int64_t area = std::int64_t(x1 - x0) * (y2 - y0) - std::int64_t(y1 - y0) * (x2 - x0);
    const std::int32_t low_x = std::max(std::min(x0, std::min(x1, x2)) + (kGrid - 1), 0) >> 8;
    const std::int32_t low_y = std::max(std::min(y0, std::min(y1, y2)) + (kGrid - 1), 0) >> 8;
    const std::int32_t high_x = std::min(std::max(x0, std::max(x1, x2)), right) >> 8;
    const std::int32_t high_y = std::min(std::max(y0, std::max(y1, y2)), bottom) >> 8;
    const std::int32_t shows = (area > 0) & (low_x <= high_x) & (low_y <= high_y);
    const std::int32_t whole = m.inside[c0] & m.inside[c1] & m.inside[c2];
    fates[i] = whole ? (shows ? kWhole : kDropped) : kToClip;
  }
}

// Depth over the image is near (n.ray) / (n.p) for a plane of normal n through p: linear in the
// pixel. False for a plane seen edge-on or from behind.
bool set_plane(const Vec3& p0, const Vec3& p1, const Vec3& p2, const MeshView& view,
               TriangleRecord& t) {
  const Vec3 n = cross(p1 - p0, p2 - p0);
  const double reach = dot(n, p0);
  if (!(reach < 0)) return false;
  const double scale = double(kNearPlane) / reach;
  t.a = n.x * scale * view.inverse_fx;
  t.b = n.y * scale * view.inverse_fy;
  t.c = n.z * scale - t.a * view.cx - t.b * view.cy;
  return true;
}

using Polygon = std::array<Vec3, 10>;

// Sutherland and Hodgman: keeps the part of the polygon where dot(plane, p) >= offset. A new corner
// is reckoned from the inner end of its edge, the same for both triangles that share the edge.
int clip(const Polygon& in, int count, const Vec3& plane, double offset, Polygon& out) {
  int kept = 0;
  for (int i = 0; i < count; ++i) {
    const Vec3& p = in[std::size_t(i)];
    const Vec3& q = in[std::size_t((i + 1) % count)];
    const double dp = dot(plane, p) - offset, dq = dot(plane, q) - offset;
    if (dp >= 0) out[std::size_t(kept++)] = p;
    if ((dp >= 0) == (dq >= 0)) continue;
    const Vec3& from = dp >= 0 ? p : q;
    const Vec3& to = dp >= 0 ? q : p;
    const double near = dp >= 0 ? dp : dq, far = dp >= 0 ? dq : dp;
    out[std::size_t(kept++)] = from + (to - from) * (near / (near - far));
  }
  return kept;
}

void append_clipped(const Vec3& p0, const Vec3& p1, const Vec3& p2, const MeshView& view,
                    TriangleRecord t, std::vector<TriangleRecord>& out) {
  Polygon a{p0, p1, p2}, b;
  int count = clip(a, 3, {0, 0, 1}, double(kNearPlane), b);
  const double reach = 0.9 * view.guard;
  const Vec3 sides[4] = {{view.fx, 0, reach + view.cx},
                         {-view.fx, 0, reach - view.cx},
                         {0, view.fy, reach + view.cy},
                         {0, -view.fy, reach - view.cy}};
  for (const Vec3& side : sides) {
    if (count == 0) return;
    std::swap(a, b);
    count = clip(a, count, side, 0, b);
  }
  std::array<std::int32_t, 10> u{}, v{};
  for (std::size_t i = 0; i < std::size_t(count); ++i) {
    const double z = std::max(b[i].z, double(kNearPlane));
    u[i] = std::int32_t(std::floor((view.fx * b[i].x / z + view.cx) * kGrid + 0.5));
    v[i] = std::int32_t(std::floor((view.fy * b[i].y / z + view.cy) * kGrid + 0.5));
  }
  t.least = 0, t.most = 1;
  for (std::size_t i = 1; i + 1 < std::size_t(count); ++i) {
    const std::size_t corners[3] = {0, i + 1, i};
    for (std::size_t k = 0; k < 3; ++k) t.x[k] = u[corners[k]], t.y[k] = v[corners[k]];
    if (area_of(t) > 0 && covers_a_centre(t, view)) out.push_back(t);
  }
}

}  // namespace

ClusterShapes make_cluster_shapes(const PreparedMesh& mesh) {
  ClusterShapes out;
  for (const Cluster& c : mesh.clusters) {
    ClusterShapes::Range range{std::uint32_t(out.x.size()), 0,
                               std::uint32_t(out.corners.size() / 3), c.triangle_count};
    std::vector<std::uint32_t> vertices;
    for (std::uint32_t t = 0; t < c.triangle_count; ++t) {
      for (const std::uint32_t v : mesh.triangles[c.first_triangle + t].vertices) {
        // Vertices that differ by their normals alone are one here.
        const auto at = std::find_if(vertices.begin(), vertices.end(), [&](std::uint32_t w) {
          return mesh.vertices[w].position == mesh.vertices[v].position;
        });
        out.corners.push_back(std::uint8_t(at - vertices.begin()));
        if (at == vertices.end()) vertices.push_back(v);
      }
    }
    if (vertices.size() > kMostVertices || c.triangle_count > kMostTriangles)
      throw RunError("a cluster of triangles is too large");
    for (const std::uint32_t v : vertices) {
      const Vec3f& p = mesh.vertices[v].position;
      out.x.push_back(p.x), out.y.push_back(p.y), out.z.push_back(p.z);
    }
    range.vertex_count = std::uint32_t(vertices.size());
    out.clusters.push_back(range);
  }
  return out;
}

MeshView::MeshView(const ViewProjection& view, const Pose& world_from_mesh, double scale)
    : fx(view.intrinsics.fx),
      fy(view.intrinsics.fy),
      cx(view.intrinsics.cx),
      cy(view.intrinsics.cy),
      inverse_fx(1 / fx),
      inverse_fy(1 / fy),
      width(view.intrinsics.width),
      height(view.intrinsics.height),
      guard(std::max(8192, std::max(width, height) * 5 / 4)) {
  const Pose optical_from_mesh = view.optical_from_world * world_from_mesh;
  const Mat3 r = optical_from_mesh.rotation.matrix();
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) rows[i][k] = float(r.rows[std::size_t(i)][k] * scale);
    rows[i][3] = float(optical_from_mesh.translation[i]);
  }
}

void set_up_cluster(const ClusterShapes& shapes, std::uint32_t cluster, const MeshView& view,
                    std::uint32_t placed, const std::uint32_t* names,
                    std::vector<TriangleRecord>& out) {
  const ClusterShapes::Range& range = shapes.clusters[cluster];
  Moved m;
  move_vertices(shapes, range, view, m);
  const std::uint8_t* corner = shapes.corners.data() + 3 * range.first_triangle;
  std::int32_t fates[kMostTriangles];
  judge(corner, range.triangle_count, m, view, fates);
  for (std::uint32_t i = 0; i < range.triangle_count; ++i, corner += 3) {
    if (fates[i] == kDropped) continue;
    // Seen from its front a triangle runs the other way round on an image of downward rows.
    const std::size_t c0 = corner[0], c1 = corner[2], c2 = corner[1];
    TriangleRecord t;
    const bool easy = fates[i] == kWhole;
    if (easy) {
      t.x[0] = m.u[c0], t.x[1] = m.u[c1], t.x[2] = m.u[c2];
      t.y[0] = m.v[c0], t.y[1] = m.v[c1], t.y[2] = m.v[c2];
    } else if (m.z[c0] < kNearPlane && m.z[c1] < kNearPlane && m.z[c2] < kNearPlane) {
      continue;
    }
    const Vec3 p0(m.x[c0], m.y[c0], m.z[c0]), p1(m.x[c2], m.y[c2], m.z[c2]),
        p2(m.x[c1], m.y[c1], m.z[c1]);
    if (!set_plane(p0, p1, p2, view, t)) continue;
    t.id = std::uint64_t(placed + 1) | std::uint64_t(names[i]) << 32;
    if (!easy) {
      append_clipped(p0, p1, p2, view, t, out);
      continue;
    }
    t.least = std::min(m.value[c0], std::min(m.value[c1], m.value[c2]));
    t.most = std::max(m.value[c0], std::max(m.value[c1], m.value[c2]));
    out.push_back(t);
  }
}

}  // namespace rubble
