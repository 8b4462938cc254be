#include "app/drive/drive_screen.h"

#include "app/support/print.h"

namespace rubble {
namespace {

constexpr std::chrono::seconds kNoticeTime{4};
constexpr int kQuickCompression = 6;

}  // namespace

DriveScreen::DriveScreen(const std::string& program, int width, int height)
    : program_(program), window_("rubble " + program, width, height) {}

void DriveScreen::set_title(const std::string& text) { window_.set_title("rubble " + program_ + ": " + text); }

void DriveScreen::poll(Controls& controls) {
  for (const std::string& heard : window_.poll(controls)) say(heard);
}

void DriveScreen::say(const std::string& text) {
  print_err("%s: %s\n", program_.c_str(), text.c_str());
  notice_ = text;
  notice_until_ = std::chrono::steady_clock::now() + kNoticeTime;
}

void DriveScreen::show(DrivePicture& picture, const std::vector<KeyHelp>* help) {
  picture.notice = !help && std::chrono::steady_clock::now() < notice_until_ ? notice_ : "";
  picture.help.clear();
  if (help) {
    picture.help.push_back({"", "keys", "gamepad"});
    for (const KeyHelp& row : *help) picture.help.push_back({row.what, row.keys, row.gamepad});
  }
  shown_ = draw_drive_picture(picture);
  window_.show(shown_);
}

void DriveScreen::save_picture(const std::string& folder) {
  if (shown_.rgb.empty()) return;
  const std::string path = folder + words("/picture_%03d.png", ++pictures_);
  write_png(path, shown_, kQuickCompression);
  say(path);
}

bool ViewPace::act(DriveAction action) {
  if (action == DriveAction::pause) return paused = !paused, true;
  if (action == DriveAction::one_step) return one_step = paused = true;
  if (action == DriveAction::slow) return slowness = slowness == 16 ? 1 : 4 * slowness, true;
  return false;
}

const char* ViewPace::describe() const {
  return paused ? "PAUSED" : slowness == 4 ? "TIME 1/4" : slowness == 16 ? "TIME 1/16" : "";
}

}  // namespace rubble
