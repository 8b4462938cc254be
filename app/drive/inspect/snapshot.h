// A moment of a pile that settles, as a mission that goes on from there:
//
//   FOLDER/NAME.state  the world, as a checkpoint of settling (io/state/checkpoint_file.h)
//   FOLDER/NAME.lua    the mission with pile.snapshot = "NAME.state"
#pragma once

#include <string>

#include "app/mission/resolved_mission.h"
#include "kernel/settling/settle_checkpoint.h"

namespace rubble {

// comment: of the script, lines of it. Returns the path of the script; of a mission whose robots are driven by functions,
// which no file but its script can hold, that of the state: `rubble run MISSION --set pile.snapshot=PATH` goes on from it.
// packs: see with_whole_paths(). Throws RunError when a file cannot be written.
std::string save_snapshot(const ResolvedMission& mission, const SettleCheckpoint& moment, const std::string& folder,
                          const std::string& name, const std::string& comment, bool packs = false);

}  // namespace rubble
