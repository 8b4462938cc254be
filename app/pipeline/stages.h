// The stages of a run: typed inputs, typed outputs. What a stage has finished is a file with a
// hash, from which a run that was killed goes on:
//
//   stage      from                  to                           kept as
//   resolve    script or manifest    ResolvedMission              unfinished/run.json
//   settle     ResolvedMission       SettledPile                  pile.bin, track.bin
//   voids      PileSurvey            Metrics
//   files      SettledPile           meshes of the pile           pile.stl, track.glb
//   robots     SettledPile           DrivenRobots                 robots/
//   flight     both, PileSurvey      PlannedFlight                flight.json
//   frames     all of these          RecordedFrames               every recorder's file
//   manifest   all                   hashes of all                manifest.json
//
// run_stages() in app/pipeline/run.h is their order. `rubble drive` uses them without a folder.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <memory>
#include <string>
#include <vector>

#include "app/measures/metrics.h"
#include "app/mission/resolved_mission.h"
#include "app/pipeline/legs.h"
#include "app/planning/pile_survey.h"
#include "app/provenance/frame_hashes.h"
#include "app/scene/moving_scene.h"
#include "app/sensors/robot_readings.h"
#include "io/recording/recording.h"
#include "kernel/model/pile_state.h"
#include "kernel/model/track.h"
#include "render/renderer.h"

namespace rubble {

struct SettledPile {
  PileState state;  // settled, or as the time limit left it
  Track track;      // who moved when; empty where the mission does not ask for it
  Metrics metrics;  // of the pile
};

// What the robots of a mission did; empty without robots.
struct DrivenRobots {
  RobotTrack moved;                  // the robots and the pieces that they moved
  RobotReadings readings;            // what they sensed, and the way of the rig that one carries
  std::vector<RobotRecord> records;  // for recorders
  std::optional<RigMount> mount;     // likewise
  Metrics metrics;                   // robot_distance_m and so on
};

// The mission with the path that is flown, and its legs, each with the stamps and poses of all cameras.
struct PlannedFlight {
  Scenario flown;         // every leg's scenario is made from it
  std::vector<Leg> legs;  // one after the other; at least one
};

struct RecordedFrames {
  FrameHashes hashes;                              // of every channel of every frame
  Metrics metrics;                                 // of the flight and the depth
  std::map<std::string, std::string> environment;  // what drew them: driver, device, threads
};

// Takes pile.bin if it is there and was made from the same pile and options, and goes on from a
// checkpoint if one is.
SettledPile settle(const ResolvedMission& mission, RunFolder& folder, RunContext& context);
// The same pile without a folder: nothing is read, nothing is kept on the way. go_on: asked now and then;
// false: Stopped is thrown.
SettledPile settle_in_memory(const ResolvedMission& mission, RunContext& context,
                             const std::function<bool()>& go_on);

// Puts the mission's victims into a pile that has settled. Throws InputError, with the line of the script, when
// its voids have no room for them.
void add_victims(const ResolvedMission& mission, int threads, PileState& pile);

// Keeps a pile that another run settled as the product of this run's first stage.
void keep_pile(const ResolvedMission& mission, const PileState& state, const RunFolder& folder);

// Of the voids, where the mission asks for them; none otherwise.
Metrics measure_voids(const ResolvedMission& mission, PileSurvey& survey, const RunFolder& folder,
                      RunContext& context);

void write_pile_files(const ResolvedMission& mission, const SettledPile& pile, RunFolder& folder,
                      RunContext& context);

// Drives the mission's robots through the pile and writes what they did. Throws InputError for a robot that
// stands in something and for a function of the script that fails.
DrivenRobots drive_robots(const ResolvedMission& mission, const PileState& pile, RunFolder& folder,
                          RunContext& context);

// Finds the way where it depends on the pile. Warns of cameras inside of pieces. Throws InputError, with
// the line of the script, as resolve_flight() and plan_legs() do.
PlannedFlight plan_flight(const ResolvedMission& mission, const SettledPile& pile,
                          const DrivenRobots& robots, PileSurvey& survey, RunFolder& folder, RunContext& context);

// The scene, lit, on the device of `gl`, for the scenario's cameras. on_light: 0 to 1; on_image: the same,
// while a path-traced image is drawn; may throw to stop.
std::unique_ptr<Renderer> prepare_renderer(const Scene& scene, const Scenario& scenario,
                                           GlContext& gl, int threads,
                                           const std::function<void(double)>& on_light,
                                           const std::function<void(double)>& on_image = {});

RecordedFrames record_frames(const ResolvedMission& mission, const SettledPile& pile,
                             const DrivenRobots& robots, const PlannedFlight& flight,
                             RunFolder& folder, RunContext& context);

// Of both: no name is in both.
Metrics join(const Metrics& a, const Metrics& b);

// metrics: of all stages.
void write_manifest(const ResolvedMission& mission, const PileState& pile, const Metrics& metrics,
                    const RecordedFrames& frames, RunFolder& folder, const RunContext& context);

}  // namespace rubble
