// The scene of a pile while it settles, from the track of who moved when.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "app/assets/asset_library.h"
#include "kernel/model/pile_state.h"
#include "kernel/model/robot.h"
#include "kernel/model/track.h"
#include "render/scene/scene.h"
#include "scripting/scenario/scenario.h"

namespace rubble {

// From when to when a track is shown; unit: s of the track.
struct TrackWindow {
  double from = 0, to = 0;  // from <= to
};

// The scene of the settled pile, in which every piece is where the track has it: those that move at any
// time of the window move, the others rest. Pieces look as in the scene of the settled pile.
// zero_ns: the stamp of the track's time 0. track: must live as long as the scene.
Scene build_moving_scene(const Scenario& scenario, const AssetLibrary& assets, const PileState& pile,
                         const Track& track, const TrackWindow& window, std::int64_t zero_ns);

// Robots that were driven through a pile, and what they moved.
struct RobotTrack {
  Track track;                     // ids: pieces of the pile, then links, robot by robot
  std::vector<RobotModel> models;  // in the order of the mission's robots
  std::vector<int> first_piece;    // id of each robot's first link

  bool empty() const { return models.empty(); }
};

// The scene of the settled pile with the robots, and all that they move. start_ns: the stamp of their time 0. robots: must live as long as the scene.
Scene build_robot_scene(const Scenario& scenario, const AssetLibrary& assets, const PileState& pile,
                        const RobotTrack& robots, std::int64_t start_ns);

// Where a piece or a link is, by its id, in what is drawn or scanned of that time; nothing: it is not there.
using LivePose = std::function<std::optional<Pose>(int id, std::int64_t stamp_ns)>;
// pose_of by a track that may still grow. since_ns: since its time 0.
std::optional<Pose> pose_in_track(const Track& track, int id, std::int64_t since_ns);
// The same while they are driven: nobody knows yet what will move. All that is not fixed is lit anew for every
// picture. start_ns: the stamp of their time 0, for which pose_of is asked at once. robots: models and ids alone are looked at.
Scene build_live_scene(const Scenario& scenario, const AssetLibrary& assets, const PileState& pile,
                       const RobotTrack& robots, std::int64_t start_ns, LivePose pose_of);

}  // namespace rubble
