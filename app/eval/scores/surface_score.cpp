#include "app/eval/scores/surface_score.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <unordered_set>

#include "app/eval/scores/point_grid.h"
#include "app/eval/scores/space_key.h"
#include "kernel/base/error.h"
#include "kernel/base/quick_math.h"
#include "kernel/base/random.h"

namespace rubble {
namespace {

constexpr int kRaysPerRow = 64;
constexpr double kRange = 12;    // unit: m
constexpr double kCell = 0.05;   // unit: m
constexpr double kCover = 0.05;  // unit: m
constexpr double kMostSamples = 1e8;

double calc_area(const PlyMesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
  const Vec3& a = mesh.positions[triangle[0]];
  return norm(cross(mesh.positions[triangle[1]] - a, mesh.positions[triangle[2]] - a)) / 2;
}

// The ray of a pixel in the optical frame; u and v in COLMAP's pixels.
Vec3 ray_of(const ColmapCamera& camera, double u, double v) {
  const bool one_focal = camera.model.find("SIMPLE") == 0 || camera.model.find("RADIAL") == 0;
  const std::size_t c = one_focal ? 1 : 2;
  const double fx = camera.params[0], fy = camera.params[one_focal ? 0 : 1];
  const double x = (u - camera.params[c]) / fx, y = (v - camera.params[c + 1]) / fy;
  if (camera.model.find("FISHEYE") == std::string::npos) return {x, y, 1};
  const double angle = quick::hypot(x, y);
  if (angle == 0) return {0, 0, 1};
  return {quick::sin(angle) * x / angle, quick::sin(angle) * y / angle, quick::cos(angle)};
}

const ColmapCamera& camera_of(const ColmapModel& model, std::uint32_t id) {
  for (const ColmapCamera& camera : model.cameras)
    if (camera.id == id) return camera;
  return model.cameras.front();  // load_colmap_model let no other pass
}

}  // namespace

std::vector<Vec3> find_visible_surface(const PileQueries& queries, const ColmapModel& truth) {
  std::vector<Vec3> visible;
  std::unordered_set<std::int64_t> taken;
  for (const ColmapImage& image : truth.images) {
    const ColmapCamera& camera = camera_of(truth, image.camera);
    const Pose world_from_optical = image.camera_from_world.inverse();
    const double step = double(camera.width) / kRaysPerRow;
    for (double v = step / 2; v < double(camera.height); v += step)
      for (double u = step / 2; u < double(camera.width); u += step) {
        const Vec3 direction = world_from_optical.rotation.rotate(ray_of(camera, u, v));
        const auto hit = queries.cast_ray(world_from_optical.translation, direction, kRange);
        if (hit && taken.insert(space_key_of(hit->point, kCell)).second) visible.push_back(hit->point);
      }
  }
  return visible;
}

void check_area(const PlyMesh& mesh, double spacing, const std::string& path) {
  double area = 0;
  for (const auto& triangle : mesh.triangles) area += calc_area(mesh, triangle);
  const double most = kMostSamples * spacing * spacing;
  if (area <= most) return;
  char expected[64], found[64];
  std::snprintf(expected, sizeof expected, "at most %.0f m2, with a sample every %g m", most, spacing);
  std::snprintf(found, sizeof found, "%.4g m2", area);
  throw InputError({path, 0, "", "the surface is too large", expected, found, "is it in metres?"});
}

std::vector<Vec3> sample_surface(const PlyMesh& mesh, double spacing) {
  if (mesh.triangles.empty()) return mesh.positions;
  RandomStream random(0, "surface");
  std::vector<Vec3> samples;
  double owed = 0;  // samples that small triangles have not had yet
  for (const auto& triangle : mesh.triangles) {
    const Vec3& a = mesh.positions[triangle[0]];
    const Vec3 ab = mesh.positions[triangle[1]] - a, ac = mesh.positions[triangle[2]] - a;
    for (owed += calc_area(mesh, triangle) / (spacing * spacing); owed >= 1; --owed) {
      const double s = std::sqrt(random.uniform(0, 1)), t = random.uniform(0, 1);
      samples.push_back(a + ab * (s * (1 - t)) + ac * (s * t));
    }
  }
  if (samples.empty()) return mesh.positions;  // a mesh too small, or without any area
  return samples;
}

std::optional<SurfaceScore> calc_surface_score(const std::vector<Vec3>& points,
                                               const PileQueries& queries,
                                               const std::vector<Vec3>& visible) {
  if (points.empty()) return std::nullopt;
  SurfaceScore score;
  score.samples = std::int64_t(points.size());
  std::vector<double> distances;
  for (const Vec3& p : points) {
    const auto closest = queries.find_closest(p, kFarthest);
    distances.push_back(closest ? closest->distance : kFarthest);
  }
  std::sort(distances.begin(), distances.end());
  const auto share = [&](double limit) {
    const auto end = std::upper_bound(distances.begin(), distances.end(), limit);
    return double(end - distances.begin()) / double(distances.size());
  };
  score.within_1cm = share(0.01), score.within_2cm = share(0.02), score.within_5cm = share(0.05);
  score.median = distances[distances.size() / 2];
  const PointGrid grid(points, 1.000001 * kCover);  // a point at kCover sharp covers, too
  const auto covered =
      std::count_if(visible.begin(), visible.end(),
                    [&](const Vec3& p) { return grid.find_distance(p) <= kCover; });
  if (!visible.empty()) score.completeness_5cm = double(covered) / double(visible.size());
  return score;
}

}  // namespace rubble
