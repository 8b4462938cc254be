// Lines over what a drive shows: collision hulls, contacts with their forces, frames of links, echoes of scans.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "io/image/drive_picture.h"
#include "kernel/base/math.h"
#include "kernel/geometry/shape.h"
#include "kernel/model/pile.h"
#include "kernel/model/pile_state.h"
#include "kernel/world/world.h"
#include "render/scene/frame.h"
#include "render/scene/range_scan.h"

namespace rubble {

struct OverlayChoice {
  bool hulls = false, contacts = false, frames = false, scans = false, cameras = false, voids = false;
  bool any() const { return hulls || contacts || frames || scans || cameras || voids; }
};

// A line in the world; unit: m. through: it is seen through what hides it.
struct OverlayLine {
  Vec3 from, to;
  std::array<std::uint8_t, 3> colour{};
  bool through = false;
};

class Overlay {
 public:
  // types: of the pile's pieces, as PieceState::type has them.
  explicit Overlay(const std::vector<PieceType>& types) : types_(types) {}

  static constexpr std::array<std::uint8_t, 3> kHullColour{90, 220, 255}, kContactColour{255, 70, 60};

  // Edges of the convex parts of pieces near `eye`, where the world has them (null: where they rest). reach: unit: m
  void add_hulls(const PileState& pile, const World* world, const Vec3& eye, std::vector<OverlayLine>& lines,
                 double reach = 4);
  // Of all robots: a line along the normal, a millimetre long for each newton, at least 2 cm.
  static void add_contacts(const World& world, std::vector<OverlayLine>& lines);
  // Of all pieces, the nearest to `eye` where there are many: a line along the force on the upper one, a tenth of a
  // millimetre long for each newton, from 2 to 60 cm, with a cross where it begins. step: of the world; unit: s
  static void add_all_contacts(const World& world, double step, const Vec3& eye, std::vector<OverlayLine>& lines);
  // X red, Y green, Z blue, 10 cm long, of every link.
  static void add_frames(const World& world, std::vector<OverlayLine>& lines);
  // Echoes as small crosses, by height from blue to red.
  static void add_scan(const RangeScan& scan, std::vector<OverlayLine>& lines);

 private:
  const Shape& shape_of(int type);

  const std::vector<PieceType>& types_;
  std::map<int, Shape> shapes_;  // compiled when they are first seen
};

// What of the lines the camera sees in its picture.
std::vector<PictureLine> project_overlay(const std::vector<OverlayLine>& lines, const Frame& frame);

}  // namespace rubble
