#include "render/passes/ground_truth.h"

#include <type_traits>
#include <utility>

#include "kernel/base/parallel.h"
#include "kernel/base/portable_math.h"
#include "render/materials/surface_appearance.h"
#include "render/scene/seen_surface.h"

namespace rubble {

namespace {

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

}  // namespace

struct GroundTruthMaker::Pixel {
  std::uint32_t placed = 0;    // number of the piece's placed mesh
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

// One pixel of a drawn view, as the streams are told of it.
class GroundTruthMaker::Seen : public SeenSurface {
 public:
  Seen(const GroundTruthMaker& maker, const DrawnView& view, const Lens& lens)
      : maker_(maker), view_(view), lens_(lens) {}

  Pixel pixel;

  Vec3 normal() const override { return maker_.find_normal(pixel, world_from_optical); }
  bool blocked(const Vec3f& from, const Vec3f& direction, float farthest) const override {
    return maker_.free_->blocked(from, direction, 0, farthest);
  }
  std::optional<std::array<double, 2>> in_next_frame() const override {
    if (!view_.next) return std::nullopt;
    const auto later = maker_.where_next(view_, pixel.placed, point);
    if (!later) return std::nullopt;
    const auto next = project_rows(lens_, *view_.next, *later, v);
    return next ? std::optional(std::array<double, 2>{next->u, next->v}) : std::nullopt;
  }

 private:
  const GroundTruthMaker& maker_;
  const DrawnView& view_;
  const Lens& lens_;
};

std::vector<GroundTruthMaker::Seen> GroundTruthMaker::see_row(const DrawnView& view,
                                                              const Lens& lens, int v) const {
  const Pose pose = view.rays.pose(v);
  const std::size_t width = std::size_t(view.rays.intrinsics.width);
  std::vector<Seen> row;
  row.reserve(width);
  for (std::size_t u = 0; u < width; ++u) {
    const std::size_t i = std::size_t(v) * width + u;
    const std::uint32_t placed = view.ids[i * 2];
    if (!placed || std::isnan(view.distances[i])) continue;
    Seen& seen = row.emplace_back(*this, view, lens);
    seen.u = int(u), seen.v = v;
    seen.point = pose * (view.rays.direction(int(u), v) * double(view.distances[i]));
    seen.world_from_optical = pose;
    seen.pixel.placed = placed - 1;
    seen.pixel.piece = &scene_.placed[placed - 1];
    seen.pixel.triangle = names_.triangle_of_name[view.ids[i * 2 + 1]];
    seen.pixel.world = seen.point;
    seen.instance = seen.pixel.piece->id;
    seen.label = seen.pixel.piece->label;
  }
  return row;
}

void GroundTruthMaker::fill_row(const ImageStream& stream, const std::vector<Seen>& row,
                                std::size_t width, ImageValues& image) {
  const auto components = std::size_t(stream.components);
  std::visit(
      [&](auto& values) {
        using T = typename std::decay_t<decltype(values)>::value_type;
        const PixelMaker<T> make = std::get<PixelMaker<T>>(stream.make);
        for (const Seen& seen : row)
          make(seen, &values[(std::size_t(seen.v) * width + std::size_t(seen.u)) * components]);
      },
      image);
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

std::vector<std::uint8_t> GroundTruthMaker::line_of_sight_mask(const DrawnView& view,
                                                               const Vec3& place_in_camera) {
  const RayScene& free = rays_.all();
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
      pixel.triangle = names_.triangle_of_name[view.ids[i * 2 + 1]];
      const Corners c = corners_of(pixel);
      const Vec3 area = cross(c.points[1] - c.points[0], c.points[2] - c.points[0]);
      const Vec3 up = normalized(pixel.piece->world_from_mesh.rotation.rotate(area));
      const PreparedMesh& mesh = scene_.meshes[pixel.piece->mesh];
      const bool painted = !mesh.paint.empty() && mesh.paint[pixel.triangle].paint >= 0;
      out[i] = painted ? mesh.paint[pixel.triangle].red
                       : mean_red_albedo(all_surface_appearances()[mesh.triangles[pixel.triangle].material],
                                         float(up.z));
    }
  });
  return out;
}

void GroundTruthMaker::fill(const StreamSet& streams, const DrawnView& view, TruthImages& truth) {
  std::vector<std::pair<const ImageStream*, ImageValues*>> images;
  for (const ImageStream* stream : streams) {
    ImageValues& image = truth[stream->name];
    image = stream->blank(view.distances.size());
    images.emplace_back(stream, &image);
    if (stream->casts_rays) free_ = &rays_.all();
  }
  const Lens lens(view.rays.intrinsics);
  const std::size_t width = std::size_t(view.rays.intrinsics.width);
  parallel_for(std::size_t(view.rays.intrinsics.height), threads_, [&](std::size_t v) {
    const std::vector<Seen> row = see_row(view, lens, int(v));
    for (const auto& [stream, image] : images) fill_row(*stream, row, width, *image);
  });
}

}  // namespace rubble
