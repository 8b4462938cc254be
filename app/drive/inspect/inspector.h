// A mission's world to be looked at: it settles, rests and, with robots, goes on by the mission, while a person flies
// through it, stops it, pulls at pieces and saves moments of it.
//
//   InspectedPile (settling) ──► at rest ──► Session (robots, by the mission)
//        step by step, at the speed of time or slower; between two steps: events -> camera -> picture -> window
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/drive/drive_request.h"
#include "app/drive/drive_screen.h"
#include "app/drive/driven_camera.h"
#include "app/drive/inspect/inspected_pile.h"
#include "app/drive/inspect/mouse_spring.h"
#include "app/drive/overlay/overlay.h"
#include "app/drive/overlay/sensor_frusta.h"
#include "app/drive/overlay/void_survey.h"
#include "app/session/session.h"
#include "io/image/drive_picture.h"
#include "render/device/device.h"
#include "render/renderer.h"
#include "render/sensors/camera.h"

namespace rubble {

// The rows of its help, and of docs/how_to/inspect.md.
const std::vector<KeyHelp>& all_inspector_help();

class Inspector {
 public:
  // Opens the window first, so that its absence is known before anything settles.
  explicit Inspector(const DriveRequest& request);
  ~Inspector();

  // Until the person quits, or the pictures that were asked for are drawn.
  void run();

 private:
  using Clock = std::chrono::steady_clock;

  void enter(std::optional<std::uint64_t> seed);
  void note_rest();
  void begin_robots();
  void draw_scene(const Scene& scene);
  void open_eye();
  const World& world() const { return robots_ ? robots_->world() : pile_->world(); }
  double step_time() const;
  bool leaving() const;

  // After each step; false: this world is done with.
  bool between();
  void turn();  // events, the camera and a picture
  void act(DriveAction action);
  void pull(const Pointer& pointer);
  void push_spring();
  void save_moment();
  void map_voids();
  void add_cameras(std::vector<OverlayLine>& lines);
  std::vector<PictureLine> draw_overlay();
  std::vector<PictureLabel> legend() const;
  std::vector<std::string> status() const;
  void show();

  DriveRequest request_;
  std::string folder_;
  Controls controls_;
  DriveScreen screen_;
  std::unique_ptr<Device> device_;  // none until there is something to draw
  std::unique_ptr<RunContext> run_;
  std::unique_ptr<ResolvedMission> mission_;
  std::unique_ptr<InspectedPile> pile_;
  PileState drawn_;   // what the scene is made of; of all pieces
  PileState rested_;  // with fines and surroundings, for the session
  std::unique_ptr<Session> robots_;  // once the pile rests, of a mission with robots
  std::unique_ptr<Renderer> renderer_;
  std::unique_ptr<Camera> eye_;
  std::unique_ptr<DrivenCamera> camera_;
  std::vector<CameraPose> flight_;      // of the rig, where no robot carries it; empty: not known yet
  std::unique_ptr<Overlay> overlay_;
  std::unique_ptr<VoidSurvey> voids_;
  OverlayChoice choice_;
  MouseSpring spring_;
  bool pressed_ = false;        // the mouse's button, as it was
  double held_depth_ = 0;       // of the target, along the optical axis; unit: m
  std::int64_t touched_ = 0;    // steps with the spring, so far
  Frame frame_;
  DrivePicture picture_;
  std::shared_ptr<const RangeScan> scan_;  // the last
  int frames_ = 0, moments_ = 0, turns_ = 0;
  double owed_ = 0;  // time of the world that the pictures so far ask for; unit: s
  double rate_ = 0;  // pictures a second that are reached
  ViewPace pace_;
  bool help_ = false, lamp_ = false, quit_ = false;
  std::optional<std::uint64_t> next_;  // seed of the world that comes instead
  Clock::time_point due_, counted_;
};

}  // namespace rubble
