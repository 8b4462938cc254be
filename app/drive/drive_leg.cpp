#include "app/drive/drive_leg.h"

#include <cstdio>
#include <filesystem>
#include <utility>

#include "app/mission/scenario_lua.h"
#include "app/pipeline/recorders.h"
#include "app/sensors/build_camera.h"
#include "io/base/atomic_file.h"
#include "io/state/track_file.h"
#include "kernel/base/system/file_sandbox.h"
#include "kernel/base/system/output_files.h"

namespace rubble {
namespace {

namespace fs = std::filesystem;

constexpr int kSaveEvery = 300;  // frames; a program that dies loses no more

std::string number_name(int number) {
  char text[32];
  std::snprintf(text, sizeof text, "leg_%03d", number);
  return text;
}

// "leg_003", the folder of a recording, and files of that name.
bool is_of_a_drive(const fs::path& path) {
  const std::string name = path.stem().string(), end = path.extension().string();
  const bool numbered = name.size() >= 7 && name.rfind("leg_", 0) == 0 &&
                        name.find_first_not_of("0123456789", 4) == std::string::npos;
  return numbered && (end.empty() || end == ".lua" || end == ".track" || end == ".hashes" || end == ".part");
}

// How many frames will come is not known, so there is no contact sheet.
std::unique_ptr<RecordingQueue> start_recording(const DriveWorld& world,
                                                const std::string& folder) {
  Scenario scenario = world.scenario;
  scenario.outputs.preview = false;
  make_output_folder(folder);
  const Recording recording = describe_recording(scenario, world.assets, world.pile);
  RecorderSet set = make_recorders({scenario, recording, {}, ""}, folder);
  return std::make_unique<RecordingQueue>(std::move(set.recorders));
}

}  // namespace

DriveLeg::DriveLeg(DriveWorld& world, const std::string& folder, int number, bool record,
                   FrameListener listener)
    : world_(world),
      folder_(folder),
      name_(number_name(number)),
      log_(world.scenario, world.steps_per_frame),
      camera_(*world.renderer,
              build_camera(world.scenario.cameras.front(), world.scenario.seed, world.threads),
              Flight{}),
      between_(*world.renderer,
               build_camera(world.scenario.cameras.front(), world.scenario.seed, world.threads),
               Flight{}),
      listener_(std::move(listener)) {
  if (record) queue_ = start_recording(world, folder_ + "/" + name_);
}

const Frame& DriveLeg::step(const DrivenPose& pose) {
  log_.add(pose);
  pass_on();
  const Pose place = world_.robots ? world_.robots->world_from_rig() : pose.world_from_camera();
  if (!log_.at_frame()) {
    const int shown = log_.steps() - log_.frames() - 1;
    between_.fly_on(world_.scenario.start_ns + std::int64_t(1e9 * log_.time(log_.steps() - 1)), place);
    shown_between_ = between_.take(shown);
    return *(shown_ = &shown_between_);
  }
  const int index = log_.frames() - 1;
  camera_.fly_on(log_.stamp_ns(index), place);
  frame_ = camera_.take(index);
  pending_ = true;
  // Whoever closes a loop over what is published waits for nothing; the velocity of a carried camera is not told.
  if (world_.robots && listener_) listener_(frame_);
  if ((index + 1) % kSaveEvery == 0) save();
  return *(shown_ = &frame_);
}

// With robots nothing is recorded, and it was passed on at once.
void DriveLeg::pass_on() {
  if (!std::exchange(pending_, false) || world_.robots) return;
  frame_.rig_velocity = frame_.linear_velocity = log_.velocity(frame_.index);
  hashes_.add(frame_);
  if (queue_) queue_->push(frame_);
  if (listener_) listener_(frame_);
}

void DriveLeg::save() {
  if (world_.robots) {
    write_text_file(folder_ + "/" + name_ + ".lua",
                    scenario_to_lua(world_.robots->scenario(world_.scenario),
                                    "The robot " + world_.robots->name() + " was driven by hand with `rubble drive`.\n"
                                    "`rubble run` on this moves all robots and pieces with the same bits."));
    return;
  }
  write_text_file(folder_ + "/" + name_ + ".lua",
                  log_.mission("Driven by hand with `rubble drive`: " +
                               std::to_string(log_.frames()) + " frames.\n`rubble run` on this "
                               "gives the frames that were seen."));
}

void DriveLeg::finish() {
  pass_on();
  save();
  if (world_.robots) return save_track(world_.robots->finish(), folder_ + "/" + name_ + ".track");
  const FrameHashes hashes = hashes_.compact();
  std::string text;
  for (const std::string& channel : hashes.channels) text += (text.empty() ? "" : " ") + channel;
  text += "\n";
  for (const auto& frame : hashes.frames) text += format_hashes(frame) + "\n";
  write_text_file(folder_ + "/" + name_ + ".hashes", text);
  if (queue_) queue_->finish();
}

void prepare_drive_folder(const std::string& folder, bool force) {
  allow_output(folder);
  make_output_folder(folder);
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (!is_of_a_drive(entry.path())) continue;
    if (!force)
      throw InputError({folder, 0, "--out", "an earlier drive is in it", "",
                        entry.path().filename().string(),
                        "choose another folder, or --force to replace it"});
    if (entry.is_directory())
      remove_output_folder(entry.path().string());
    else
      remove_output_file(entry.path().string());
  }
}

}  // namespace rubble
