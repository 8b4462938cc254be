#include "scripting/robots/crawler.h"

#include "kernel/robot/parts.h"

namespace rubble {
namespace {

constexpr double kTrackLength = 0.5;  // between the axles; unit: m
constexpr double kTrackWidth = 0.097, kWheelRadius = 0.089;
constexpr double kFlipperLength = 0.33, kFlipperWidth = 0.05, kHubRadius = 0.08, kTipRadius = 0.045;
constexpr double kFlipperGap = 0.015;  // between flipper and track; unit: m
constexpr double kCrawlerBodyMass = 22.88, kTrackMass = 6.06, kFlipperMass = 0.75;  // unit: kg
constexpr double kFlipperEffort = 17, kFlipperSpeed = 0.8;  // unit: N m, rad/s
constexpr double kFlipperStiffness = 500, kFlipperDamping = 25;
constexpr int kCrawlerFacets = 24, kTrackPads = 5;

// Short pads, each with friction of its own: a track that turns on the spot slides sideways at its ends
// and not in its middle.
RobotLink make_track(const char* name, double y, const CrawlerOptions& options) {
  RobotLink link;
  link.name = name;
  const double pad = kTrackLength / kTrackPads;
  for (int i = 0; i < kTrackPads; ++i) {
    link.parts.push_back(make_box({pad, kTrackWidth, 2 * kWheelRadius},
                                  {-0.5 * kTrackLength + (i + 0.5) * pad, y, kWheelRadius}));
  }
  for (double x : {-0.5 * kTrackLength, 0.5 * kTrackLength}) {
    link.parts.push_back(make_wheel(kWheelRadius, kTrackWidth, kCrawlerFacets, {x, y, kWheelRadius}));
  }
  link.friction = options.friction;
  link.belt_axis = {0, 1, 0};
  link.belt_speed_limit = options.speed;
  link.belt_side = y > 0 ? 1 : -1;
  RobotLink solid = link;  // the parts overlap: mass as of one prism
  solid.parts = {make_paddle(kWheelRadius, kWheelRadius, kTrackWidth, kCrawlerFacets,
                             {-0.5 * kTrackLength, y, kWheelRadius},
                             {0.5 * kTrackLength, y, kWheelRadius})};
  set_mass(kTrackMass, solid);
  link.mass = solid.mass;
  link.centre_of_mass = solid.centre_of_mass;
  link.inertia = solid.inertia;
  link.looks = make_track_looks({kTrackLength, kTrackWidth, kWheelRadius, kWheelRadius}, y, y > 0 ? 1 : -1);
  return link;
}

RobotLink make_flipper(const char* name, double direction, double side, const CrawlerOptions& options) {
  RobotLink link;
  link.name = name;
  link.parts = {make_paddle(kHubRadius, kTipRadius, kFlipperWidth, kCrawlerFacets, {},
                            {direction * kFlipperLength, 0, 0})};
  link.friction = options.friction;
  link.belt_axis = {0, 1, 0};
  link.belt_speed_limit = options.speed;
  link.belt_side = side > 0 ? 1 : -1;
  set_mass(kFlipperMass, link);
  link.looks = make_flipper_looks({kFlipperLength, kFlipperWidth, kTipRadius, kHubRadius}, direction, side);
  return link;
}

void hang(RobotModel& model, const RobotLink& link, const RobotJoint& like) {
  RobotJoint joint = like;
  joint.name = link.name + "_joint";
  joint.parent = 0;
  joint.child = int(model.links.size());
  model.links.push_back(link);
  model.joints.push_back(joint);
}

}  // namespace

RobotModel make_crawler(const CrawlerOptions& options) {
  RobotModel model;
  model.name = "crawler";
  RobotLink body;
  body.name = "base_link";
  body.parts = {make_box({0.56, 0.28, 0.14}, {0, 0, 0.12})};
  body.friction = 0.5;
  set_mass(kCrawlerBodyMass, body);
  body.looks = make_crawler_body_looks();
  model.links.push_back(body);
  model.headlamp.link_from_lamp.translation = {0.3, 0, 0.25};
  RobotJoint weld;
  weld.kind = JointKind::weld;
  const double y = 0.5 * kCrawlerTrackDistance;
  hang(model, make_track("left_track", y, options), weld);
  hang(model, make_track("right_track", -y, options), weld);
  model.sides = {{1}, {2}, true, 0, kCrawlerTrackDistance};
  if (!options.flippers) return model;
  const double out = y + 0.5 * kTrackWidth + kFlipperGap + 0.5 * kFlipperWidth;
  const struct {
    const char* name;
    double direction, side;
  } flippers[] = {{"front_left_flipper", 1, 1},
                  {"front_right_flipper", 1, -1},
                  {"rear_left_flipper", -1, 1},
                  {"rear_right_flipper", -1, -1}};
  for (const auto& f : flippers) {
    RobotJoint joint;
    joint.parent_from_child.translation = {f.direction * 0.5 * kTrackLength, f.side * out, kWheelRadius};
    joint.axis = {0, -f.direction, 0};
    joint.motor = {kFlipperEffort, kFlipperSpeed, kFlipperStiffness, kFlipperDamping};
    joint.start = options.flipper_start;
    hang(model, make_flipper(f.name, f.direction, f.side, options), joint);
  }
  return model;
}

}  // namespace rubble
