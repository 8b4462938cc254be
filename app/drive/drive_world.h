// What is driven through: one seed's settled pile, ready to be asked and drawn; also from above.
#pragma once

#include <functional>
#include <memory>

#include "app/drive/drive_request.h"
#include "app/drive/driven_camera.h"
#include "app/drive/robots/robot_drive.h"
#include "app/pipeline/stages.h"
#include "app/planning/pile_survey.h"
#include "io/image/image_file.h"
#include "kernel/queries/queries.h"
#include "render/renderer.h"

namespace rubble {

// A square of the world, north (Y) up in the picture.
struct MapFrame {
  Vec3 centre;      // unit: m; z is not used
  double side = 1;  // unit: m
  int pixels = 1;   // a side

  // Column and row of a place, also outside.
  double column(const Vec3& p) const;
  double row(const Vec3& p) const;
};

// Around all pieces and `camera`, with a margin.
MapFrame frame_map(const PileState& pile, const Vec3& camera, int pixels);

// Heights as colours from dark (the ground) to light, shaded by their slope.
RgbImage draw_height_map(const PileQueries& queries, const MapFrame& frame, int threads);

struct DriveWorld {
  Scenario scenario;                   // of the camera's size that was asked for, adapted to driving
  int steps_per_frame = 1;             // more where frames are too rare to steer by
  Plan plan = Plan::ghost;             // whether the camera collides
  AssetLibrary assets;                 // of the mission
  PileState pile;                      // settled
  std::unique_ptr<RunContext> run;     // of the robots
  DrivenPose entry;                    // the first waypoint of the mission
  DriveLimits limits;                  // the mission's speed limits, where it has any
  std::unique_ptr<PileSurvey> survey;  // of that pile
  std::unique_ptr<RobotDrive> robots;  // driven instead of the camera; none: it flies
  std::unique_ptr<Renderer> renderer;  // of the scene, lit
  int threads = 1;                     // at least 1

  double step_hz() const { return scenario.trajectory.rate_hz * steps_per_frame; }
  const PileQueries& queries() const { return survey->geometry().queries; }  // of clearance
};

// Asked now and then while that takes long; false: the person wants to leave.
using GoOn = std::function<bool()>;

// Loads the mission with that seed (none: its own) and settles its pile. The context must outlive
// the world. Throws as `rubble run` does, Stopped when `go_on` was false, and InputError when the
// camera's body has no room at the entry.
std::unique_ptr<DriveWorld> make_drive_world(const DriveRequest& request,
                                             std::optional<std::uint64_t> seed, GlContext& context,
                                             const GoOn& go_on);

}  // namespace rubble
