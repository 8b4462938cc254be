#include "app/drive/overlay/overlay.h"

#include <algorithm>
#include <cmath>

#include "kernel/world/world_robots.h"
#include "render/camera/lens.h"

namespace rubble {
namespace {

constexpr int kMostHulls = 150;       // pieces, the nearest
constexpr double kForceLength = 1e-3, kLeastForceLength = 0.02;  // unit: m/N, m
constexpr double kAxis = 0.1, kCross = 0.02;                     // unit: m
constexpr std::size_t kMostEchoes = 4000;
constexpr double kDashLength = 0.05;  // lines are hidden piece by piece; unit: m
constexpr int kMostDashes = 64;
constexpr double kSurface = 0.02;     // a line that lies on a surface is seen; unit: m

constexpr double kPileForceLength = 1e-4, kMostForceLength = 0.6;  // unit: m/N, m
constexpr std::size_t kMostContacts = 1500;

// Planar depth at a pixel; infinite where nothing is.
double depth_at(const Frame& frame, const PixelPoint& at) {
  const int u = int(std::lround(at.u)), v = int(std::lround(at.v));
  if (u < 0 || v < 0 || u >= frame.intrinsics.width || v >= frame.intrinsics.height) return -1;
  const float depth = frame.depth[std::size_t(v) * std::size_t(frame.intrinsics.width) + std::size_t(u)];
  return std::isfinite(depth) && depth > 0 ? double(depth) : 1e9;
}

}  // namespace

const Shape& Overlay::shape_of(int type) {
  const auto known = shapes_.find(type);
  if (known != shapes_.end()) return known->second;
  const PieceType& of = types_.at(std::size_t(type));
  return shapes_.emplace(type, compile_shape(of, of.name)).first->second;
}

void Overlay::add_hulls(const PileState& pile, const World* world, const Vec3& eye, std::vector<OverlayLine>& lines,
                        double reach) {
  std::vector<std::pair<double, PieceState>> near;
  for (std::size_t i = 0; i < pile.pieces.size(); ++i) {
    PieceState piece = pile.pieces[i];
    if (world) piece.world_from_body = world->piece(int(i)).world_from_body;
    if (piece.status == PieceStatus::lost) continue;
    const double away = distance(piece.world_from_body.translation, eye);
    if (away < reach) near.push_back({away, piece});
  }
  std::sort(near.begin(), near.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  if (near.size() > std::size_t(kMostHulls)) near.resize(kMostHulls);
  for (const auto& [away, piece] : near) {
    const Shape& shape = shape_of(piece.type);
    const Vec3 centre = shape.volume.centre_of_mass;
    for (const ConvexShape& part : shape.parts)
      for (const ConvexShape::Edge& edge : part.edges) {
        const auto corner = [&, &placed = piece](std::uint16_t i) {
          return placed.world_from_body * ((Vec3(part.corners[i]) + centre) * placed.scale);
        };
        lines.push_back({corner(edge.a), corner(edge.b), kHullColour, false});
      }
  }
}

void Overlay::add_contacts(const World& world, std::vector<OverlayLine>& lines) {
  for (int robot = 0; robot < world.robots().count(); ++robot)
    for (const RobotContact& contact : world.robots().contacts(robot))
      lines.push_back({contact.point,
                       contact.point + contact.normal * std::max(kLeastForceLength, kForceLength * contact.force),
                       kContactColour, true});
}

void Overlay::add_all_contacts(const World& world, double step, const Vec3& eye, std::vector<OverlayLine>& lines) {
  std::vector<ContactImpulse> contacts = world.contacts();
  if (contacts.size() > kMostContacts) {
    std::stable_sort(contacts.begin(), contacts.end(), [&eye](const ContactImpulse& a, const ContactImpulse& b) {
      return distance(a.point, eye) < distance(b.point, eye);
    });
    contacts.resize(kMostContacts);
  }
  for (const ContactImpulse& contact : contacts) {
    const Vec3 force = contact.impulse * ((contact.impulse.z < 0 ? -1 : 1) / step);
    const double newtons = norm(force);
    if (!(newtons > 0)) continue;
    const double length = std::clamp(kPileForceLength * newtons, kLeastForceLength, kMostForceLength);
    lines.push_back({contact.point, contact.point + force * (length / newtons), kContactColour, true});
    for (const Vec3& half : {Vec3{kCross / 2, 0, 0}, Vec3{0, kCross / 2, 0}})
      lines.push_back({contact.point - half, contact.point + half, kContactColour, true});
  }
}

void Overlay::add_frames(const World& world, std::vector<OverlayLine>& lines) {
  for (int robot = 0; robot < world.robots().count(); ++robot)
    for (const RobotState::Link& link : world.robots().state(robot).links)
      for (int axis = 0; axis < 3; ++axis) {
        Vec3 along;
        along[axis] = kAxis;
        std::array<std::uint8_t, 3> colour{60, 60, 60};
        colour[std::size_t(axis)] = 255;
        lines.push_back({link.world_from_link.translation, link.world_from_link * along, colour, true});
      }
}

void Overlay::add_scan(const RangeScan& scan, std::vector<OverlayLine>& lines) {
  if (scan.world_from_sensor.empty()) return;
  const std::size_t every = scan.points.size() / kMostEchoes + 1;
  for (std::size_t i = 0; i < scan.points.size(); i += every) {
    const Vec3 at = scan.place(scan.points[i]);
    const double share = std::clamp(at.z / 2, 0.0, 1.0);
    const std::array<std::uint8_t, 3> colour{std::uint8_t(255 * share), 160, std::uint8_t(255 * (1 - share))};
    for (const Vec3& half : {Vec3{kCross / 2, 0, 0}, Vec3{0, kCross / 2, 0}, Vec3{0, 0, kCross / 2}})
      lines.push_back({at - half, at + half, colour, false});
  }
}

std::vector<PictureLine> project_overlay(const std::vector<OverlayLine>& lines, const Frame& frame) {
  const Lens lens(frame.intrinsics);
  const Pose optical_from_world = (frame.world_from_camera * Pose{camera_from_optical.rotation, {}}).inverse();
  std::vector<PictureLine> seen;
  for (const OverlayLine& line : lines) {
    const Vec3 a = optical_from_world * line.from, b = optical_from_world * line.to;
    const int dashes = std::clamp(int(distance(a, b) / kDashLength) + 1, 1, kMostDashes);
    for (int i = 0; i < dashes; ++i) {
      const Vec3 from = a + (b - a) * (double(i) / dashes), to = a + (b - a) * (double(i + 1) / dashes), middle = (from + to) * 0.5;
      if (from.z <= 0.01 || to.z <= 0.01) continue;
      const auto begin = lens.project(from), end = lens.project(to), at = lens.project(middle);
      if (!begin || !end || !at) continue;
      const double depth = depth_at(frame, *at);
      if (depth < 0 || (!line.through && middle.z > depth + kSurface)) continue;
      seen.push_back({{begin->u, begin->v}, {end->u, end->v}, line.colour});
    }
  }
  return seen;
}

}  // namespace rubble
