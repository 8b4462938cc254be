// How long the stages of a world's steps take.
#pragma once

#include <array>
#include <chrono>

#include "kernel/world/world_diagnostics.h"

namespace rubble {

using StageTimes = std::array<double, int(StepStage::none)>;  // by StepStage; wall time; unit: s

// Measures the steps of a world for as long as both live.
class StageClock {
 public:
  explicit StageClock(World& world);
  ~StageClock();
  StageClock(const StageClock&) = delete;
  StageClock& operator=(const StageClock&) = delete;

  const StageTimes& times() const { return times_; }

 private:
  void begin(StepStage stage);

  World& world_;
  StepStage stage_ = StepStage::none;
  std::chrono::steady_clock::time_point since_;
  StageTimes times_{};
};

}  // namespace rubble
