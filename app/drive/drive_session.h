// A drive from the first step to the last: events -> step -> frame -> window -> log.
#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "app/drive/drive_leg.h"
#include "app/drive/drive_link.h"
#include "app/drive/drive_screen.h"
#include "app/drive/drive_world.h"
#include "app/drive/overlay/overlay.h"
#include "app/drive/overlay/void_survey.h"
#include "io/live/complaints.h"

namespace rubble {

class DriveSession {
 public:
  // Opens the window first, so that its absence is known before anything settles.
  explicit DriveSession(const DriveRequest& request);
  ~DriveSession();

  // Until the person quits, or the steps that were asked for are done. Prints the missions.
  void run();

 private:
  using Clock = std::chrono::steady_clock;

  bool stay();  // looks at events while something takes long
  void enter(std::optional<std::uint64_t> seed);
  void act(DriveAction action);
  void change_lamp_and_air();
  void end_leg();
  FrameListener listener();
  std::vector<Sample> take_sensed();
  bool waits(const DriveInput& input);
  void step(const DriveInput& input);
  void step_robot(const DriveInput& input);
  void follow(const std::vector<JointTrajectoryCommand>& trajectories);
  void show();
  void map_voids();
  std::vector<PictureLine> draw_overlay();
  std::vector<std::string> status() const;

  DriveRequest request_;
  std::string folder_;
  Controls controls_;
  DriveScreen screen_;
  std::unique_ptr<DriveWorld> world_;
  std::unique_ptr<DrivenCamera> camera_;
  std::unique_ptr<DriveLink> link_;  // none unless asked for
  std::unique_ptr<DriveLeg> leg_;  // none until its first step
  MapFrame map_frame_;
  DrivePicture picture_;
  RgbImage map_;
  int legs_ = 0, steps_ = 0;
  double fog_ = 0.15;  // what the fog is turned on to; unit: 1/m
  double rate_ = 0;    // steps a second that are reached
  ViewPace pace_;
  bool help_ = false, quit_ = false;
  bool going_ = false;  // somebody asked for something since this leg began
  OverlayChoice choice_;
  std::unique_ptr<Overlay> overlay_;  // of this world
  std::unique_ptr<VoidSurvey> voids_;  // likewise
  std::shared_ptr<const RangeScan> scan_;  // the last
  Complaints complaints_{[this](const std::string& line) { screen_.say(line); }};
};

}  // namespace rubble
