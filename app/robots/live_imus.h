// What inertial units on robots measure while the robots are driven.
//
// A reading is the mean over its period, half before and half after its stamp; it comes two steps after that. Readings
// have the bits of the recorded ones, noise included.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "app/robots/live_steps.h"
#include "render/scene/frame.h"
#include "scripting/scenario/scenario.h"
#include "scripting/trajectory/imu.h"
#include "scripting/trajectory/motion_path.h"

namespace rubble {

class LiveImus {
 public:
  // imus: numbers among all_imus() of the scenario, which must outlive this.
  LiveImus(const Scenario& scenario, const std::vector<RidingSensor>& imus, double step);

  void restart(const World& world);  // at the robots' time 0
  void note_step(const World& world) { steps_.note_step(world); }  // after each step
  // All since the last call, unit by unit in the order of stamps.
  std::vector<ImuSample> take();

 private:
  // The way of the carrier that measures.
  class Way : public MotionPath {
   public:
    explicit Way(const LiveSteps& steps) : steps_(steps) {}
    double duration() const override { return 1e9; }  // nobody knows when the drive ends
    Pose at(double t) const override { return steps_.carrier_after(t); }
    CameraMotion motion_at(double t) const override { return steps_.carrier_motion_after(t); }
    bool is_simulated() const override { return true; }

   private:
    const LiveSteps& steps_;
  };
  struct Unit {
    std::size_t number = 0, carrier = 0;
    std::int64_t half_ns = 0;  // of its period
    std::unique_ptr<Imu> imu;
  };

  const Scenario& scenario_;
  LiveSteps steps_;
  Way way_;
  std::vector<Unit> units_;
};

}  // namespace rubble
