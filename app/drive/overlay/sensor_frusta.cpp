#include "app/drive/overlay/sensor_frusta.h"

#include "app/sensors/build_camera.h"
#include "render/camera/lens.h"

namespace rubble {
namespace {

constexpr double kLeastForward = 0.26;  // along the axis, of the rays that a plane still meets; cosine of 75 degrees
constexpr int kSidePoints = 12;  // of each side of an image's border; unit: 1
constexpr std::array<std::uint8_t, 3> kPathColour{255, 150, 40};
constexpr std::array<std::array<std::uint8_t, 3>, 6> kCameraColours{
    {{255, 225, 60}, {255, 120, 220}, {120, 255, 120}, {255, 170, 90}, {150, 190, 255}, {255, 255, 255}}};

}  // namespace

std::vector<PlacedCamera> place_cameras(const std::vector<MountedCamera>& cameras,
                                        const std::function<std::optional<Pose>(const MountedCamera&)>& carrier_of) {
  std::vector<PlacedCamera> placed;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const std::optional<Pose> carrier = carrier_of(cameras[i]);
    if (!carrier) continue;
    placed.push_back({cameras[i].name, cameras[i].camera.intrinsics(), place_on_mount(cameras[i], *carrier),
                      kCameraColours[i % kCameraColours.size()]});
  }
  return placed;
}

void add_frustum(const PlacedCamera& camera, double distance, std::vector<OverlayLine>& lines) {
  const Lens lens(camera.intrinsics);
  const Pose world_from_optical = camera.world_from_camera * Pose{camera_from_optical.rotation, {}};
  // Pixels have their centres at whole numbers.
  const double right = camera.intrinsics.width - 0.5, bottom = camera.intrinsics.height - 0.5;
  bool plane = true;
  const auto at = [&](double u, double v) -> std::optional<Vec3> {
    const std::optional<Vec3> ray = lens.direction(u, v);
    if (!ray) return std::nullopt;
    return world_from_optical * (*ray * (plane ? distance / ray->z : distance));
  };
  for (const double u : {-0.5, 0.5 * (right - 0.5), right})
    for (const double v : {-0.5, 0.5 * (bottom - 0.5), bottom}) {
      const std::optional<Vec3> ray = lens.direction(u, v);
      plane = plane && ray && ray->z > kLeastForward;
    }
  const double corners[5][2] = {{-0.5, -0.5}, {right, -0.5}, {right, bottom}, {-0.5, bottom}, {-0.5, -0.5}};
  for (int side = 0; side < 4; ++side) {
    std::optional<Vec3> last = at(corners[side][0], corners[side][1]);
    if (last) lines.push_back({world_from_optical.translation, *last, camera.colour, true});
    for (int i = 1; i <= kSidePoints; ++i) {
      const double share = double(i) / kSidePoints;
      const std::optional<Vec3> next = at(corners[side][0] + share * (corners[side + 1][0] - corners[side][0]),
                                          corners[side][1] + share * (corners[side + 1][1] - corners[side][1]));
      if (last && next) lines.push_back({*last, *next, camera.colour, true});
      last = next;
    }
  }
  // Which side is up.
  const std::optional<Vec3> top = at((right - 0.5) / 2, -0.5);
  const Vec3 up = camera.world_from_camera.rotation.rotate({0, 0, 0.12 * distance});
  if (top) lines.push_back({*top, *top + up, camera.colour, true});
}

void add_path(const std::vector<Vec3>& points, double least, std::vector<OverlayLine>& lines) {
  if (points.empty()) return;
  Vec3 last = points.front();
  for (const Vec3& point : points) {
    if (distance(last, point) < least) continue;
    lines.push_back({last, point, kPathColour, true});
    last = point;
  }
}

}  // namespace rubble
