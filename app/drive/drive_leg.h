// One leg of a drive: steps under unchanged lamp, air and pile, the frames among them, and the files about them.
//
//   DIR/leg_001.lua      the mission that gives these frames again
//   DIR/leg_001.hashes   the hashes of the frames that were seen, as in a manifest; of driven robots instead:
//   DIR/leg_001.track    who moved when, as robots/track.bin of a run
//   DIR/leg_001/         with --record: the mission's recordings
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "app/drive/drive_log.h"
#include "app/drive/drive_world.h"
#include "app/provenance/frame_hashes.h"
#include "io/recording/recording_queue.h"
#include "render/sensors/camera.h"

namespace rubble {

// Told of each frame once all is known of it, in order.
using FrameListener = std::function<void(const Frame&)>;

class DriveLeg {
 public:
  // The renderer must be new, or restarted. World and renderer must outlive the leg.
  DriveLeg(DriveWorld& world, const std::string& folder, int number, bool record,
           FrameListener listener = {});

  // The view from there, one step after the one before. With robots, from where the camera rides. Steps between two frames
  // are shown alone.
  const Frame& step(const DrivenPose& pose);
  const Frame& shown() const { return *shown_; }
  int frames() const { return log_.frames(); }
  int steps() const { return log_.steps(); }
  bool at_frame() const { return log_.at_frame(); }           // whether the last step was a frame
  double next_time() const { return log_.time(log_.steps()); }  // of the next step, since the first; unit: s
  const std::string& name() const { return name_; }
  // Completes the files. Nothing can be added afterwards.
  void finish();

 private:
  void pass_on();  // the last frame, now that its velocity is known
  void save();

  DriveWorld& world_;
  std::string folder_, name_;
  DriveLog log_;
  Camera camera_, between_;  // of frames; of what is only shown
  FrameHashes hashes_;
  Frame frame_, shown_between_;
  const Frame* shown_ = &frame_;
  bool pending_ = false;  // the frame, whose velocity is not known yet
  std::unique_ptr<RecordingQueue> queue_;
  FrameListener listener_;
};

// Makes the folder. Throws InputError when legs of an earlier drive are in it; with `force` they are
// removed, and nothing else.
void prepare_drive_folder(const std::string& folder, bool force);

}  // namespace rubble
