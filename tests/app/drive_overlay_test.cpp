// Lines over what a drive shows, where they ought to be in the picture.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/drive/overlay/overlay.h"
#include "scripting/robots/rover.h"
#include "kernel/robot/parts.h"
#include "kernel/robot/robot_run.h"

namespace rubble {
namespace drive_overlay_test {

// A pinhole at the origin that looks along X, with a wall `depth` before it.
Frame make_frame(float depth) {
  Frame frame;
  frame.intrinsics.width = 100, frame.intrinsics.height = 80;
  frame.intrinsics.fx = frame.intrinsics.fy = 50;
  frame.intrinsics.cx = 49.5, frame.intrinsics.cy = 39.5;
  frame.depth.assign(100 * 80, depth);
  return frame;
}

TEST(DriveOverlay, ALineIsWhereItsEndsAre) {
  const Frame frame = make_frame(std::numeric_limits<float>::infinity());
  // From 0.2 m to the left to 0.2 m to the right and 0.1 m up, 2 m ahead: left is -u, up is -v.
  const std::vector<PictureLine> lines = project_overlay({{{2, 0.2, 0}, {2, -0.2, 0.1}, {1, 2, 3}, false}}, frame);
  ASSERT_FALSE(lines.empty());
  EXPECT_NEAR(lines.front().from[0], 49.5 - 5, 1e-9);
  EXPECT_NEAR(lines.front().from[1], 39.5, 1e-9);
  EXPECT_NEAR(lines.back().to[0], 49.5 + 5, 1e-9);
  EXPECT_NEAR(lines.back().to[1], 39.5 - 2.5, 1e-9);
  for (std::size_t i = 1; i < lines.size(); ++i) EXPECT_NEAR(lines[i].from[0], lines[i - 1].to[0], 1e-9);
  EXPECT_EQ(lines.front().colour[2], 3);
}

TEST(DriveOverlay, WhatIsHiddenIsNotDrawn) {
  const OverlayLine line{{2, 0.2, 0}, {2, -0.2, 0}, {}, false};
  EXPECT_FALSE(project_overlay({line}, make_frame(2.0f)).empty()) << "on the surface";
  EXPECT_TRUE(project_overlay({line}, make_frame(1.5f)).empty()) << "behind it";
  OverlayLine through = line;
  through.through = true;
  EXPECT_FALSE(project_overlay({through}, make_frame(1.5f)).empty());
  EXPECT_TRUE(project_overlay({{{-2, 0.2, 0}, {-2, -0.2, 0}, {}, true}}, make_frame(9)).empty()) << "behind the camera";
}

TEST(DriveOverlay, HullsAreThoseOfThePiecesWhereTheyAre) {
  PieceType box;
  box.name = "box";
  box.parts = {make_box({0.4, 0.2, 0.6}, {0.1, 0, 0})};  // beside the origin of its frame
  PileState pile;
  PieceState piece;
  piece.world_from_body = {{}, {1, 0, 0.3}}, piece.scale = 2;
  pile.pieces = {piece};
  piece.world_from_body.translation.x = 30;  // too far to be shown
  pile.pieces.push_back(piece);
  const std::vector<PieceType> types{box};
  std::vector<OverlayLine> lines;
  Overlay(types).add_hulls(pile, nullptr, {}, lines);
  EXPECT_EQ(lines.size(), 12u);
  Aabb reach;
  for (const OverlayLine& line : lines) reach.include(line.from), reach.include(line.to);
  EXPECT_NEAR(reach.min.x, 1 + 2 * (0.1 - 0.2), 1e-5);
  EXPECT_NEAR(reach.max.x, 1 + 2 * (0.1 + 0.2), 1e-5);
  EXPECT_NEAR(reach.max.z, 0.3 + 2 * 0.3, 1e-5);
}

TEST(DriveOverlay, ForcesOfContactsCarryTheRobot) {
  RobotRunOptions options;
  options.duration = 1, options.threads = 1;
  RobotRun run({}, {}, options);
  const RobotModel rover = make_rover();
  run.add(rover, {{}, {0, 0, 0.001}}, [](const RobotSense&) { return RobotCommand(); });
  run.run();
  std::vector<OverlayLine> contacts, frames;
  Overlay::add_contacts(run.world(), contacts);
  ASSERT_GE(contacts.size(), 4u);
  double newtons = 0;
  for (const OverlayLine& line : contacts) newtons += (line.to - line.from).z * 1000;
  EXPECT_NEAR(newtons, rover.mass() * options.gravity, 0.1 * rover.mass() * options.gravity);
  Overlay::add_frames(run.world(), frames);
  EXPECT_EQ(frames.size(), 3 * rover.links.size());
}

}  // namespace drive_overlay_test
}  // namespace rubble
