// A rawlog of actions and sensory frames: the layout that rbpf-slam and other filters of MRPT read, which a rawlog of
// single observations is not. Internal to io/mrpt.
//
// All observations of one instant are one sensory frame. An action goes before each: how far the robot went since
// the frame before it, by its odometry, with the uncertainty of a Gaussian motion model. Inertial readings are in the
// frame that follows them.
#pragma once

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose2D.h>

#include <cstdint>
#include <deque>
#include <functional>
#include <vector>

namespace rubble {

class ActionFrames {
 public:
  using Write = std::function<void(const mrpt::obs::CActionCollection&, const mrpt::obs::CSensoryFrame&)>;

  // Both in order of their stamps; unit: ns.
  void note_odometry(std::int64_t stamp_ns, const mrpt::poses::CPose2D& odom_from_base);
  void add(std::int64_t stamp_ns, const mrpt::obs::CObservation& observation);
  // For the frame of the observation that comes next.
  void keep_for_next(const mrpt::obs::CObservation& observation);

  // Writes those whose odometry is known; all: the others as well, with the last odometry. What was kept for a next
  // frame that never came is dropped.
  void write(const Write& write, bool all);

 private:
  struct Reading {
    std::int64_t stamp_ns = 0;
    mrpt::poses::CPose2D pose;
  };
  struct Frame {
    std::int64_t stamp_ns = 0;
    mrpt::obs::CSensoryFrame observations;
  };
  mrpt::poses::CPose2D odometry_at(std::int64_t stamp_ns);

  std::deque<Reading> readings_;  // from the last one before the frames that wait on
  std::deque<Frame> waiting_;
  std::vector<mrpt::obs::CObservation::Ptr> kept_;
  mrpt::poses::CPose2D last_;  // odometry of the frame that was written last
  bool started_ = false;       // there was one
};

}  // namespace rubble
