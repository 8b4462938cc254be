// The stages of a run, with typed inputs and outputs. A finished stage leaves a file with a hash, and a killed run
// continues from these files:
//
//   stage      from                  to                           kept as
//   resolve    script or manifest    ResolvedMission              unfinished/run.json
//   settle     ResolvedMission       SettledPile                  pile.bin, track.bin
//   voids      PileSurvey            Metrics
//   files      SettledPile           meshes of the pile           pile.stl, track.glb
//   robots     SettledPile           DrivenRobots                 robots/
//   flight     both, PileSurvey      legs of the recording        flight.json
//   frames     all of these          RecordedFrames               every recorder's file
//   manifest   all                   hashes of all                manifest.json
//
// run_stages() in app/pipeline/run.h calls them in this order. `rubble drive` uses them without a folder.
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
#include "app/session/driven_robots.h"
#include "kernel/model/pile_state.h"
#include "kernel/model/track.h"
#include "kernel/settling/settle.h"
#include "kernel/world/world.h"

namespace rubble {

struct SettledPile {
  PileState state;  // settled, or the state at the time limit
  Track track;      // motion of the pieces; empty if the mission does not request it
  Metrics metrics;  // of the pile
};

struct RecordedFrames {
  FrameHashes hashes;                              // of every channel of every frame
  Metrics metrics;                                 // of the flight and the depth
  std::map<std::string, std::string> environment;  // driver, device, threads
};

// Uses an existing pile.bin that was made from the same pile and options, or continues from a checkpoint.
SettledPile settle(const ResolvedMission& mission, RunFolder& folder, RunContext& context);
// The same without a folder: no file is read or written. go_on: called repeatedly; if it returns false, Stopped is
// thrown.
SettledPile settle_in_memory(const ResolvedMission& mission, RunContext& context,
                             const std::function<bool()>& go_on);

// The first part of it, in a world of the caller: what falls, from the start or the mission's snapshot, until it rests.
// world: empty, with the types and assemblies of the pile, by make_pile(mission). Throws InputError, with the key, for a
// snapshot of another pile.
PileState settle_pieces(World& world, const ResolvedMission& mission, const Pile& pile, const SettleOptions& options,
                        const SettleCallback& step, const WorldObserver& observe = {});
// The second: all that comes when the pile rests, for runs, runs that go on, and drives: a warning of a building that
// stands, victims, fines, surroundings. loaded: the pile has its victims and fines already. folder: of the run, where there is
// one. Throws Stopped when a signal comes while fines are strewn.
void complete_pile(const ResolvedMission& mission, RunContext& context, PileState& pile, bool loaded = false,
                   const std::string& folder = {});

// Puts the mission's victims into a settled pile. Throws InputError, with the line of the script, when its voids have no
// room for them.
void add_victims(const ResolvedMission& mission, int threads, PileState& pile);

// Stores a pile of another run as the result of this run's first stage.
void keep_pile(const ResolvedMission& mission, const PileState& state, const RunFolder& folder);

// Measures voids if the mission requests it; else returns nothing.
Metrics measure_voids(const ResolvedMission& mission, PileSurvey& survey, const RunFolder& folder,
                      RunContext& context);

void write_pile_files(const ResolvedMission& mission, const SettledPile& pile, RunFolder& folder,
                      RunContext& context);

// Drives the mission's robots through the pile from the start of the flight on, and writes their results. Throws InputError
// for a robot that overlaps something at its start, for a function of the script that fails, and as plan_legs() does.
DrivenRobots drive_robots(const ResolvedMission& mission, const SettledPile& pile, RunFolder& folder,
                          RunContext& context);

// Finds the path if it depends on the pile. Warns of cameras inside pieces. Throws InputError, with the line of the
// script, as resolve_flight() and plan_legs() do. At least one leg is returned.
std::vector<Leg> plan_flight(const ResolvedMission& mission, const SettledPile& pile,
                          const DrivenRobots& robots, PileSurvey& survey, RunFolder& folder, RunContext& context);

RecordedFrames record_frames(const ResolvedMission& mission, const SettledPile& pile,
                             const DrivenRobots& robots, const std::vector<Leg>& legs,
                             RunFolder& folder, RunContext& context);

// The union of both, which have no name in common.
Metrics join(const Metrics& a, const Metrics& b);

// metrics: of all stages.
void write_manifest(const ResolvedMission& mission, const PileState& pile, const Metrics& metrics,
                    const RecordedFrames& frames, RunFolder& folder, const RunContext& context);

}  // namespace rubble
