#include "app/robots/urdf_parts.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <utility>

#include "kernel/base/inertia.h"
#include "kernel/base/number_text.h"
#include "kernel/base/portable_math.h"
#include "kernel/geometry/shape.h"
#include "kernel/robot/parts.h"

namespace rubble {
namespace {

constexpr double kDensity = 1000;      // of what has no mass in the file: that of water; unit: kg/m3
constexpr double kLeastMass = 1e-3;    // of what has no shape either: a frame of sheet metal; unit: kg
constexpr double kLeastRadius = 0.01;  // unit: m

// The corner of the looks that is farthest in each of the directions to the points of a golden-angle spiral.
ConvexPart hull_of(const TriangleMesh& looks) {
  constexpr int kDirections = 96;
  ConvexPart part;
  const double golden = portable::kPi * (3 - std::sqrt(5.0));
  for (int i = 0; i < kDirections; ++i) {
    const double z = 1 - 2 * (i + 0.5) / kDirections, level = std::sqrt(1 - z * z);
    const auto [s, c] = portable::sincos(golden * i);
    const Vec3 direction{level * c, level * s, z};
    Vec3 farthest(looks.positions.front());
    for (const Vec3f& p : looks.positions)
      if (dot(Vec3(p), direction) > dot(farthest, direction)) farthest = Vec3(p);
    part.points.push_back(farthest);
  }
  return part;
}

// What stands for the body: its parts, else a hull of its looks; empty: it has no shape.
RobotLink solid_of(const RobotLink& body) {
  RobotLink solid;
  solid.parts = body.parts;
  if (solid.parts.empty() && !body.looks.positions.empty()) solid.parts.push_back(hull_of(body.looks));
  return solid;
}

double volume_of(const RobotLink& solid) {
  double volume = 0;
  try {
    for (const ConvexPart& part : solid.parts) volume += calc_volume_properties(part).volume;
  } catch (const std::invalid_argument&) {
    return 0;  // flat
  }
  return volume;
}

Mat3 inertia_of_ball(double mass, double radius) {
  const double moment = 0.4 * mass * radius * radius;
  return Mat3::diagonal({moment, moment, moment});
}

// Also what rounding leaves of zeros.
bool is_nothing(const Mat3& inertia, double mass) {
  constexpr double kRadius = 1e-6;  // of a ball that weighs as much; unit: m
  return std::max({norm(inertia.rows[0]), norm(inertia.rows[1]), norm(inertia.rows[2])}) < mass * kRadius * kRadius;
}

// The second moments of the mass, trace(I) / 2 - I, cannot be below 0: rounding and programs for drawing make such
// moments; masses in points of one line have none about it. Where some are below or 0, they become small ones of their
// body's size, which changes the inertia least. False: nothing was to do, or moments themselves are below 0.
bool repair(Mat3& inertia) {
  constexpr double kLeastShare = 1e-3;  // of the largest second moment
  constexpr double kRounding = 1e-9;    // of the largest moment
  Mat3 axes;
  const Vec3 moments = find_principal_axes(inertia, axes);
  const double half = (moments.x + moments.y + moments.z) / 2;
  Vec3 second{half - moments.x, half - moments.y, half - moments.z};
  const double least = kLeastShare * std::max({second.x, second.y, second.z});
  const double largest = std::max({moments.x, moments.y, moments.z}), smallest = std::min({moments.x, moments.y, moments.z});
  if (smallest < -kRounding * largest || std::min({second.x, second.y, second.z}) > kRounding * largest) return false;
  second = max(second, Vec3{least, least, least});
  const Vec3 better{second.y + second.z, second.z + second.x, second.x + second.y};
  inertia = axes * Mat3::diagonal(better) * axes.transposed();
  for (int r = 0; r < 3; ++r)
    for (int s = 0; s < r; ++s) inertia.rows[r][s] = inertia.rows[s][r];
  return true;
}

std::string text_of(const char* form, double number) {
  char text[64];
  std::snprintf(text, sizeof text, form, number);
  return text;
}

class Masses {
 public:
  Masses(const UrdfFile& file, const std::vector<UrdfPlace>& places, std::vector<std::string>& warnings,
         std::vector<Diagnostic>& mistakes)
      : file_(file), places_(places), warnings_(warnings), mistakes_(mistakes) {}

  void set(std::size_t number, int line, RobotLink& body) {
    sum(number, body);
    if (!std::isfinite(body.mass) || body.mass < 0)
      return mistakes_.push_back({file_.path, line, body.name, "its mass is no number", "more than 0 kg",
                                  plain_text(body.mass), ""});
    const bool stands = number == 0 && file_.fixed;  // its mass counts in sums alone
    if (body.mass == 0)  // also with moments alone
      infer_mass(line, stands, body);
    else if (is_nothing(body.inertia, body.mass))
      infer_inertia(line, body);
    else if (repair(body.inertia))
      warn(line, "no body has the moments of inertia of `" + body.name + "`: one of them is above the sum of the others. They "
                 "are changed as little as makes them possible");
    check(line, body);
  }

 private:
  template <typename Use>
  void each_link_of(std::size_t number, const Use& use) const {
    for (std::size_t i = 0; i < file_.links.size(); ++i)
      if (places_[i].body == int(number) && file_.links[i].has_inertial)
        use(file_.links[i], places_[i].body_from_link * file_.links[i].link_from_inertial);
  }

  void sum(std::size_t number, RobotLink& body) const {
    body.mass = 0;
    Vec3 moment;
    each_link_of(number, [&](const UrdfLink& link, const Pose& at) {
      body.mass += link.mass;
      moment += at.translation * link.mass;
    });
    body.inertia = Mat3::diagonal({0, 0, 0});
    if (!(body.mass > 0)) return;
    body.centre_of_mass = moment * (1 / body.mass);
    each_link_of(number, [&](const UrdfLink& link, const Pose& at) {
      const Mat3 r = at.rotation.matrix();
      const Vec3 d = at.translation - body.centre_of_mass;
      const Mat3 square{{d * d.x, d * d.y, d * d.z}};
      body.inertia = body.inertia + r * link.inertia * r.transposed() +
                     Mat3::diagonal({dot(d, d), dot(d, d), dot(d, d)}) * link.mass + square * -link.mass;
    });
  }

  void warn(int line, const std::string& text) {
    warnings_.push_back(file_.path + ":" + std::to_string(line) + ": " + text);
  }

  void infer_mass(int line, bool stands, RobotLink& body) {
    RobotLink solid = solid_of(body);
    const double volume = volume_of(solid);
    if (volume * kDensity > kLeastMass) {
      set_mass(volume * kDensity, solid);
      body.mass = solid.mass, body.centre_of_mass = solid.centre_of_mass, body.inertia = solid.inertia;
    } else {
      body.mass = kLeastMass, body.inertia = inertia_of_ball(kLeastMass, kLeastRadius);
    }
    warn(line, "the link `" + body.name + "` " + (stands ? "" : "moves and ") + "has no mass: it gets " + text_of("%.3g kg", body.mass) +
                   (body.mass > kLeastMass ? ", that of its shape in water" : ", as it has no shape either") +
                   "; <inertial> gives it one");
  }

  void infer_inertia(int line, RobotLink& body) {
    RobotLink solid = solid_of(body);
    if (volume_of(solid) > 0) {
      set_mass(body.mass, solid);
      body.inertia = solid.inertia;
    } else {
      body.inertia = inertia_of_ball(body.mass, kLeastRadius);
    }
    warn(line, "the link `" + body.name + "` has no moments of inertia: it gets those of its shape");
  }

  void check(int line, const RobotLink& body) {
    RobotModel alone;
    alone.links = {body};
    try {
      validate(alone, body.name);
    } catch (const InputError& error) {
      for (const Diagnostic& d : error.diagnostics())
        mistakes_.push_back({file_.path, line, body.name, d.message, d.expected, d.found, ""});
    }
  }

  const UrdfFile& file_;
  const std::vector<UrdfPlace>& places_;
  std::vector<std::string>& warnings_;
  std::vector<Diagnostic>& mistakes_;
};

}  // namespace

void set_urdf_masses(const UrdfFile& file, const std::vector<UrdfPlace>& places, const std::vector<int>& lines,
                     RobotModel& model, std::vector<std::string>& warnings, std::vector<Diagnostic>& mistakes) {
  Masses masses(file, places, warnings, mistakes);
  for (std::size_t b = 0; b < model.links.size(); ++b) masses.set(b, lines[b], model.links[b]);
}

}  // namespace rubble
