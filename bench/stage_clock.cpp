#include "bench/stage_clock.h"

namespace rubble {

StageClock::StageClock(World& world) : world_(world) {
  world_.diagnostics().set_on_stage([this](StepStage stage) { begin(stage); });
}

StageClock::~StageClock() { world_.diagnostics().set_on_stage({}); }

void StageClock::begin(StepStage stage) {
  const auto now = std::chrono::steady_clock::now();
  if (stage_ != StepStage::none) {
    times_[std::size_t(stage_)] += std::chrono::duration<double>(now - since_).count();
  }
  stage_ = stage, since_ = now;
}

}  // namespace rubble
