#include "render/passes/ground_truth.h"

#include <limits>

#include "kernel/base/parallel.h"
#include "kernel/base/portable_math.h"
#include "render/materials/surface_appearance.h"

namespace rubble {

namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr int kSkyRays = 64;
constexpr double kLift = 5e-4;      // rays to the sky start this far off the surface; unit: m
constexpr float kFarthest = 1e4f;   // unit: m

// Evenly spread and cosine-weighted about +Z, so that their mean is the sky view factor: Malley's
// method over a golden-ratio sequence.
const std::vector<Vec3>& sky_directions() {
  static const std::vector<Vec3> directions = [] {
    std::vector<Vec3> out;
    for (int i = 0; i < kSkyRays; ++i) {
      const double u = (i + 0.5) / kSkyRays, turns = i * 0.6180339887498949;
      const portable::SinCos a = portable::sincos(2 * portable::kPi * (turns - std::floor(turns)));
      out.push_back({std::sqrt(u) * a.cos, std::sqrt(u) * a.sin, std::sqrt(1 - u)});
    }
    return out;
  }();
  return directions;
}

// From 0 to 1, unlike for neighbours (Jimenez 2014).
double turn_of_pixel(int u, int v) {
  const double x = 0.06711056 * u + 0.00583715 * v, y = 52.9829189 * (x - std::floor(x));
  return y - std::floor(y);
}

// Where a world point is in an image that is taken row by row: the row at whose time it is seen
// there. Two rows' poses are enough once the row is known to within one.
std::optional<PixelPoint> project_rows(const Lens& lens, const ViewRays& view, const Vec3& world,
                                       double guess) {
  const auto at = [&](std::size_t row) {
    return lens.project(view.pose(int(row)).inverse() * world);
  };
  if (view.row_poses.size() < 2) return at(0);
  const double last = double(view.row_poses.size() - 1);
  std::optional<PixelPoint> found;
  double v = guess;
  for (int i = 0; i < 8; ++i) {
    const double row = std::min(std::max(std::floor(v), 0.0), last - 1);
    const auto upper = at(std::size_t(row)), lower = at(std::size_t(row) + 1);
    if (!upper || !lower) return std::nullopt;
    // v = upper + (v - row) (lower - upper), within the image.
    const double slope = lower->v - upper->v;
    const double solved = std::fabs(1 - slope) > 1e-6 ? (upper->v - row * slope) / (1 - slope) : v;
    const double share = std::min(std::max(solved, 0.0), last) - row;
    found = {upper->u + share * (lower->u - upper->u), upper->v + share * slope};
    if (std::fabs(found->v - v) < 1e-6) break;
    v = found->v;
  }
  return found;
}

void put(std::vector<float>& channel, std::size_t first, const Vec3& v) {
  for (int k = 0; k < 3; ++k) channel[first + std::size_t(k)] = float(v[k]);
}

}  // namespace

struct GroundTruthMaker::Pixel {
  int u = 0, v = 0;
  const PlacedMesh* piece = nullptr;
  std::uint32_t triangle = 0;  // of its prepared mesh
  Vec3 world;                  // the point that is seen
};

struct GroundTruthMaker::Corners {
  Vec3 points[3];
};

GroundTruthMaker::Corners GroundTruthMaker::corners_of(const Pixel& pixel) const {
  const PreparedMesh& mesh = scene_.meshes[pixel.piece->mesh];
  Corners corners;
  for (std::size_t i = 0; i < 3; ++i)
    corners.points[i] = Vec3(mesh.vertices[mesh.triangles[pixel.triangle].vertices[i]].position);
  return corners;
}

// Of the triangle, towards the camera; unit, in the world.
Vec3 GroundTruthMaker::find_normal(const Pixel& pixel, const Pose& world_from_optical) const {
  const Corners c = corners_of(pixel);
  const Vec3 area = cross(c.points[1] - c.points[0], c.points[2] - c.points[0]);
  const Vec3 normal = normalized(pixel.piece->world_from_mesh.rotation.rotate(area));
  return dot(normal, pixel.world - world_from_optical.translation) > 0 ? -normal : normal;
}

float GroundTruthMaker::find_sky_visibility(const Pixel& pixel, const Vec3& normal) const {
  const Vec3 side = std::fabs(normal.z) < 0.9 ? Vec3(0, 0, 1) : Vec3(1, 0, 0);
  const Vec3 a = normalized(cross(side, normal)), b = cross(normal, a);
  const portable::SinCos t =
      portable::sincos(2 * portable::kPi * turn_of_pixel(pixel.u, pixel.v));
  const Vec3 x = a * t.cos + b * t.sin, y = b * t.cos - a * t.sin;
  const Vec3f from(pixel.world + normal * kLift);
  int open = 0;
  for (const Vec3& d : sky_directions()) {
    const Vec3f ray(x * d.x + y * d.y + normal * d.z);
    open += ray.z > 0 && !rays_->blocked(from, ray, 0, kFarthest);
  }
  return float(open) / kSkyRays;
}

void GroundTruthMaker::fill_row(const ChannelSet& channels, const DrawnView& view, const Lens& lens,
                                int v, Frame& frame) const {
  const Pose pose = view.rays.pose(v);
  const std::size_t width = std::size_t(view.rays.intrinsics.width);
  for (std::size_t u = 0; u < width; ++u) {
    const std::size_t i = std::size_t(v) * width + u;
    const std::uint32_t placed = view.ids[i * 2];
    if (!placed || std::isnan(view.distances[i])) continue;
    Pixel pixel;
    pixel.u = int(u), pixel.v = v;
    pixel.piece = &scene_.placed[placed - 1];
    pixel.triangle = geometry_.triangle_of_name[view.ids[i * 2 + 1]];
    pixel.world = pose * (view.rays.direction(int(u), v) * double(view.distances[i]));
    if (channels.instance) frame.instance[i] = pixel.piece->id;
    if (channels.label) frame.label[i] = pixel.piece->label;
    if (channels.normals || channels.sky_visibility) {
      const Vec3 normal = find_normal(pixel, pose);
      if (channels.normals)
        put(frame.normals, i * 3, pose.rotation.conjugate().rotate(normal));
      if (channels.sky_visibility) frame.sky_visibility[i] = find_sky_visibility(pixel, normal);
    }
    if (!channels.flow || !view.next) continue;
    const auto later = where_next(view, placed - 1, pixel.world);
    if (!later) continue;
    if (const auto next = project_rows(lens, *view.next, *later, v)) {
      frame.flow[i * 2] = float(next->u - double(u));
      frame.flow[i * 2 + 1] = float(next->v - v);
    }
  }
}

// Where a point of a surface will be when the next image is taken.
std::optional<Vec3> GroundTruthMaker::where_next(const DrawnView& view, std::uint32_t placed,
                                                 const Vec3& world) const {
  if (view.shift.moves.empty() || !view.shift.moves[placed]) return world;
  const std::optional<Pose>& then = view.shift.then[placed];
  if (!then) return std::nullopt;
  return *then * (scene_.placed[placed].world_from_mesh.inverse() * world);
}

std::vector<Vec3f> GroundTruthMaker::shifts(const DrawnView& view) const {
  std::vector<Vec3f> out(view.distances.size());
  if (view.shift.moves.empty()) return out;
  parallel_for(std::size_t(view.rays.intrinsics.height), threads_, [&](std::size_t v) {
    const Pose pose = view.rays.pose(int(v));
    const std::size_t width = std::size_t(view.rays.intrinsics.width);
    for (std::size_t i = v * width; i < (v + 1) * width; ++i) {
      if (!view.ids[i * 2] || std::isnan(view.distances[i])) continue;
      const Vec3 world =
          pose * (view.rays.direction(int(i - v * width), int(v)) * double(view.distances[i]));
      if (const auto later = where_next(view, view.ids[i * 2] - 1, world)) out[i] = Vec3f(*later - world);
    }
  });
  return out;
}

const RayScene& GroundTruthMaker::rays() {
  if (!rays_) rays_ = std::make_unique<RayScene>(scene_, RayScene::Detail::finest);
  rays_->follow();
  return *rays_;
}

std::vector<std::uint8_t> GroundTruthMaker::line_of_sight_mask(const DrawnView& view,
                                                               const Vec3& place_in_camera) {
  const RayScene& free = rays();
  const Vec3 place = camera_from_optical.inverse() * place_in_camera;
  const std::size_t width = std::size_t(view.rays.intrinsics.width);
  std::vector<std::uint8_t> out(view.distances.size(), 0);
  parallel_for(std::size_t(view.rays.intrinsics.height), threads_, [&](std::size_t v) {
    const Pose pose = view.rays.pose(int(v));
    const Vec3f from(pose * place);
    for (std::size_t i = v * width; i < (v + 1) * width; ++i) {
      if (!view.ids[i * 2] || std::isnan(view.distances[i])) continue;
      const Vec3 world =
          pose * (view.rays.direction(int(i - v * width), int(v)) * double(view.distances[i]));
      const Vec3f way = Vec3f(world) - from;
      const float length = norm(way);
      out[i] = !free.blocked(from, way * (1 / length), 0, length - std::max(2e-3f, 2e-3f * length));
    }
  });
  return out;
}

std::vector<float> GroundTruthMaker::albedos(const DrawnView& view) const {
  std::vector<float> out(view.distances.size(), 0);
  parallel_for(std::size_t(view.rays.intrinsics.height), threads_, [&](std::size_t v) {
    const std::size_t width = std::size_t(view.rays.intrinsics.width);
    for (std::size_t i = v * width; i < (v + 1) * width; ++i) {
      if (!view.ids[i * 2]) continue;
      Pixel pixel;
      pixel.piece = &scene_.placed[view.ids[i * 2] - 1];
      pixel.triangle = geometry_.triangle_of_name[view.ids[i * 2 + 1]];
      const Corners c = corners_of(pixel);
      const Vec3 area = cross(c.points[1] - c.points[0], c.points[2] - c.points[0]);
      const Vec3 up = normalized(pixel.piece->world_from_mesh.rotation.rotate(area));
      const PreparedMesh& mesh = scene_.meshes[pixel.piece->mesh];
      out[i] = mean_red_albedo(all_surface_appearances()[mesh.triangles[pixel.triangle].material],
                               float(up.z));
    }
  });
  return out;
}

void GroundTruthMaker::fill(const ChannelSet& channels, const DrawnView& view, Frame& frame) {
  if (!channels.any()) return;
  const std::size_t size = view.distances.size();
  if (channels.normals) frame.normals.assign(size * 3, kNone);
  if (channels.instance) frame.instance.assign(size, kNoInstance);
  if (channels.label) frame.label.assign(size, kSkyLabel);
  if (channels.flow) frame.flow.assign(size * 2, kNone);
  if (channels.sky_visibility) {
    frame.sky_visibility.assign(size, 1);
    rays();
  }
  const Lens lens(view.rays.intrinsics);
  parallel_for(std::size_t(view.rays.intrinsics.height), threads_,
               [&](std::size_t v) { fill_row(channels, view, lens, int(v), frame); });
}

}  // namespace rubble
