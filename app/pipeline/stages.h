// The stages of a run: typed inputs, typed outputs. What a stage has finished is a file with a
// hash, from which a run that was killed goes on:
//
//   stage      from                  to                           kept as
//   resolve    script or manifest    ResolvedMission              unfinished/run.json
//   settle     ResolvedMission       SettledPile                  pile.bin, track.bin
//   files      SettledPile           meshes of the pile           pile.stl, track.glb
//   robots     SettledPile           DrivenRobots                 robots/
//   frames     both                  RecordedFrames               every recorder's file
//   manifest   all                   hashes of all                manifest.json
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/measures/metrics.h"
#include "app/pipeline/moving_scene.h"
#include "app/pipeline/resolved_mission.h"
#include "app/provenance/frame_hashes.h"
#include "app/sensors/robot_readings.h"
#include "io/recording/recording.h"
#include "kernel/model/pile_state.h"
#include "kernel/model/track.h"
#include "render/renderer.h"

namespace rubble {

struct SettledPile {
  PileState state;
  Track track;      // who moved when; empty where the mission does not ask for it
  Metrics metrics;  // of the pile and, where the mission asks for them, its voids
};

// What the robots of a mission did; empty without robots.
struct DrivenRobots {
  RobotTrack moved;
  RobotReadings readings;            // what they sensed, and the way of the rig that one carries
  std::vector<RobotRecord> records;  // for recorders
  std::optional<RigMount> mount;     // likewise
  Metrics metrics;
};

struct RecordedFrames {
  FrameHashes hashes;
  Metrics metrics;                                 // of the flight and the depth
  std::map<std::string, std::string> environment;  // what drew them: driver, device, threads
};

// Takes pile.bin if it is there and was made from the same pile and options, and goes on from a
// checkpoint if one is.
SettledPile settle(const ResolvedMission& mission, RunFolder& folder, RunContext& context);

// Keeps a pile that another run settled as the product of this run's first stage.
void keep_pile(const ResolvedMission& mission, const PileState& state, const RunFolder& folder);

void write_pile_files(const ResolvedMission& mission, const SettledPile& pile, RunFolder& folder,
                      RunContext& context);

// Drives the mission's robots through the pile and writes what they did. Throws InputError for a robot that
// stands in something and for a function of the script that fails.
DrivenRobots drive_robots(const ResolvedMission& mission, const PileState& pile, RunFolder& folder,
                          RunContext& context);

// The scene of the pile, lit, on the device of `gl`. on_light: 0 to 1; on_image: the same, while a
// path-traced image is drawn; may throw to stop.
Renderer prepare_renderer(const Scenario& scenario, const AssetLibrary& assets,
                          const PileState& pile, GlContext& gl, int threads,
                          const std::function<void(double)>& on_light,
                          const std::function<void(double)>& on_image = {});

RecordedFrames record_frames(const ResolvedMission& mission, const SettledPile& pile,
                             const DrivenRobots& robots, RunFolder& folder, RunContext& context);

// Of both: no name is in both.
Metrics join(const Metrics& of_pile, const Metrics& of_frames);

void write_manifest(const ResolvedMission& mission, const SettledPile& pile,
                    const RecordedFrames& frames, RunFolder& folder, const RunContext& context);

}  // namespace rubble
