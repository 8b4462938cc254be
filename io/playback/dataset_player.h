// Gives the samples of a recorded dataset again, in the order in which its run gave them to its recorders, so that a
// recorder can write them in another format.
//
// Frames come from `frames`, which has every bit of them, else from mission.mcap or mission.bag; inertial readings from
// there as well; scans from `pcd`, with their true motion; readings of other sensors from `sensors`.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "io/recording/recording.h"
#include "render/scene/sample.h"

namespace rubble {

struct RecordedDataset {
  std::string folder;                  // of the run
  Recording recording;                 // what it recorded
  std::vector<Intrinsics> intrinsics;  // of each camera
};

// What the new recordings hold beside frames.
struct PlayedSamples {
  bool imus = false, scans = false, readings = false;
  bool biases = false;  // of inertial units, which are in `frames` alone
};

class DatasetPlayer {
 public:
  // Throws InputError: the dataset does not have what is wanted and its mission has, naming the key that records it; or a
  // list of it is damaged.
  DatasetPlayer(RecordedDataset dataset, const PlayedSamples& wanted);
  ~DatasetPlayer();

  // Throws InputError: a file is missing or damaged.
  void play(const std::function<void(Sample)>& take);
  // After play(): what was read, and what is not as the sensors gave it. A sentence each.
  const std::vector<std::string>& notes() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace rubble
