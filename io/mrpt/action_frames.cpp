#include "io/mrpt/action_frames.h"

#include <mrpt/obs/CActionRobotMovement2D.h>

#include <memory>

#include "io/mrpt/mrpt_types.h"
#include "kernel/base/portable_math.h"

namespace rubble {
namespace {

using mrpt::obs::CActionRobotMovement2D;
using mrpt::poses::CPose2D;

// Standard deviation of a turn by its own angle. What skids turns less than its tracks say, by as much as this and
// more, and a filter must be allowed to find that; unit: 1.
constexpr double kTurnByTurn = 0.3;

CActionRobotMovement2D::TMotionModelOptions motion_model() {
  CActionRobotMovement2D::TMotionModelOptions options;  // the rest: MRPT's defaults
  options.modelSelection = CActionRobotMovement2D::mmGaussian;
  options.gaussianModel.a4 = kTurnByTurn;
  return options;
}

mrpt::obs::CObservation::Ptr copy_of(const mrpt::obs::CObservation& observation) {
  return std::dynamic_pointer_cast<mrpt::obs::CObservation>(observation.duplicateGetSmartPtr());
}

}  // namespace

void ActionFrames::note_odometry(std::int64_t stamp_ns, const CPose2D& odom_from_base) {
  readings_.push_back({stamp_ns, odom_from_base});
}

void ActionFrames::add(std::int64_t stamp_ns, const mrpt::obs::CObservation& observation) {
  if (waiting_.empty() || waiting_.back().stamp_ns != stamp_ns) {
    waiting_.emplace_back();
    waiting_.back().stamp_ns = stamp_ns;
    for (const auto& kept : kept_) waiting_.back().observations.insert(kept);
    kept_.clear();
  }
  waiting_.back().observations.insert(copy_of(observation));
}

void ActionFrames::keep_for_next(const mrpt::obs::CObservation& observation) { kept_.push_back(copy_of(observation)); }

// Between the readings before and after it, evenly in time.
CPose2D ActionFrames::odometry_at(std::int64_t stamp_ns) {
  while (readings_.size() > 1 && readings_[1].stamp_ns <= stamp_ns) readings_.pop_front();
  if (readings_.empty()) return {};
  const Reading& before = readings_.front();
  if (readings_.size() == 1 || stamp_ns <= before.stamp_ns) return before.pose;
  const Reading& after = readings_[1];
  const double share = double(stamp_ns - before.stamp_ns) / double(after.stamp_ns - before.stamp_ns);
  double turn = after.pose.phi() - before.pose.phi();
  if (turn > portable::kPi) turn -= 2 * portable::kPi;
  if (turn < -portable::kPi) turn += 2 * portable::kPi;
  return {before.pose.x() + share * (after.pose.x() - before.pose.x()),
          before.pose.y() + share * (after.pose.y() - before.pose.y()), before.pose.phi() + share * turn};
}

void ActionFrames::write(const Write& write, bool all) {
  while (!waiting_.empty()) {
    Frame& frame = waiting_.front();
    if (!all && (readings_.empty() || readings_.back().stamp_ns <= frame.stamp_ns)) return;
    const CPose2D here = odometry_at(frame.stamp_ns);
    CActionRobotMovement2D movement;
    movement.timestamp = mrpt_time(frame.stamp_ns);
    movement.computeFromOdometry(started_ ? here - last_ : CPose2D(), motion_model());
    mrpt::obs::CActionCollection actions;
    actions.insert(movement);
    write(actions, frame.observations);
    last_ = here, started_ = true;
    waiting_.pop_front();
  }
}

}  // namespace rubble
