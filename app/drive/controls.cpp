#include "app/drive/controls.h"

#include "app/drive/sdl.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

namespace rubble {
namespace {

constexpr double kDeadZone = 0.15;      // of a stick, as a share of its way
constexpr double kMouseDegrees = 0.15;  // a pixel

struct AxisKey {
  SDL_Scancode key;
  double DriveInput::*axis;
  double sign;
};

// By place on the keyboard, so that they lie alike on every layout.
const AxisKey kAxisKeys[] = {
    {SDL_SCANCODE_W, &DriveInput::forward, 1}, {SDL_SCANCODE_S, &DriveInput::forward, -1},
    {SDL_SCANCODE_A, &DriveInput::yaw, 1},     {SDL_SCANCODE_D, &DriveInput::yaw, -1},
    {SDL_SCANCODE_LEFT, &DriveInput::yaw, 1},  {SDL_SCANCODE_RIGHT, &DriveInput::yaw, -1},
    {SDL_SCANCODE_UP, &DriveInput::pitch, -1}, {SDL_SCANCODE_DOWN, &DriveInput::pitch, 1},
    {SDL_SCANCODE_Q, &DriveInput::roll, -1},   {SDL_SCANCODE_E, &DriveInput::roll, 1},
};

const std::map<SDL_Scancode, DriveAction> kActionKeys{
    {SDL_SCANCODE_L, DriveAction::lamp},       {SDL_SCANCODE_1, DriveAction::lamp_down},
    {SDL_SCANCODE_2, DriveAction::lamp_up},    {SDL_SCANCODE_F, DriveAction::fog},
    {SDL_SCANCODE_3, DriveAction::fog_down},   {SDL_SCANCODE_4, DriveAction::fog_up},
    {SDL_SCANCODE_X, DriveAction::faster},     {SDL_SCANCODE_Z, DriveAction::slower},
    {SDL_SCANCODE_R, DriveAction::reset},      {SDL_SCANCODE_N, DriveAction::next_seed},
    {SDL_SCANCODE_SPACE, DriveAction::pause},  {SDL_SCANCODE_H, DriveAction::help},
    {SDL_SCANCODE_PERIOD, DriveAction::one_step}, {SDL_SCANCODE_COMMA, DriveAction::slow},
    {SDL_SCANCODE_V, DriveAction::hulls},      {SDL_SCANCODE_C, DriveAction::contacts},
    {SDL_SCANCODE_G, DriveAction::frames},     {SDL_SCANCODE_B, DriveAction::scans},
    {SDL_SCANCODE_O, DriveAction::cameras},    {SDL_SCANCODE_M, DriveAction::voids},
    {SDL_SCANCODE_K, DriveAction::moment},
    {SDL_SCANCODE_F1, DriveAction::help},      {SDL_SCANCODE_P, DriveAction::picture},
    {SDL_SCANCODE_ESCAPE, DriveAction::quit},
};

struct AxisStick {
  SDL_GameControllerAxis stick;
  double DriveInput::*axis;
  double sign;  // SDL's sticks are positive to the right and down
};

const AxisStick kAxisSticks[] = {
    {SDL_CONTROLLER_AXIS_LEFTY, &DriveInput::forward, -1},
    {SDL_CONTROLLER_AXIS_LEFTX, &DriveInput::roll, 1},
    {SDL_CONTROLLER_AXIS_RIGHTY, &DriveInput::pitch, 1},
    {SDL_CONTROLLER_AXIS_RIGHTX, &DriveInput::yaw, -1},
};

const std::map<int, DriveAction> kPadButtons{
    {SDL_CONTROLLER_BUTTON_A, DriveAction::lamp},
    {SDL_CONTROLLER_BUTTON_DPAD_UP, DriveAction::lamp_up},
    {SDL_CONTROLLER_BUTTON_DPAD_DOWN, DriveAction::lamp_down},
    {SDL_CONTROLLER_BUTTON_B, DriveAction::fog},
    {SDL_CONTROLLER_BUTTON_DPAD_RIGHT, DriveAction::fog_up},
    {SDL_CONTROLLER_BUTTON_DPAD_LEFT, DriveAction::fog_down},
    {SDL_CONTROLLER_BUTTON_RIGHTSHOULDER, DriveAction::faster},
    {SDL_CONTROLLER_BUTTON_LEFTSHOULDER, DriveAction::slower},
    {SDL_CONTROLLER_BUTTON_Y, DriveAction::reset},
    {SDL_CONTROLLER_BUTTON_RIGHTSTICK, DriveAction::next_seed},
    {SDL_CONTROLLER_BUTTON_START, DriveAction::pause},
    {SDL_CONTROLLER_BUTTON_X, DriveAction::help},
    {SDL_CONTROLLER_BUTTON_LEFTSTICK, DriveAction::picture},
    {SDL_CONTROLLER_BUTTON_BACK, DriveAction::quit},
};

// 0 inside the dead zone, then from 0 to 1.
double past_dead_zone(Sint16 raw) {
  const double way = std::clamp(double(raw) / 32767.0, -1.0, 1.0);
  const double past = std::max(0.0, std::abs(way) - kDeadZone) / (1 - kDeadZone);
  return std::copysign(past, way) + 0.0;
}

}  // namespace

const std::vector<KeyHelp>& all_key_help() {
  static const std::vector<KeyHelp> help{
      {"forward, back", "W, S", "left stick, up and down"},
      {"turn left, right", "A, D, arrows or mouse", "right stick"},
      {"nose up, down", "up, down or mouse", "right stick"},
      {"roll left, right", "Q, E", "left stick, left and right"},
      {"slower, faster", "Z, X or the wheel", "shoulder buttons"},
      {"lamp on, off", "L", "A"},
      {"lamp weaker, stronger", "1, 2", "pad down, up"},
      {"fog on, off", "F", "B"},
      {"fog thinner, thicker", "3, 4", "pad left, right"},
      {"back to the entry", "R", "Y"},
      {"the next seed's pile", "N", "press the right stick"},
      {"pause", "space", "start"},
      {"one step; slow motion", "period; comma", ""},
      {"hulls, contacts", "V, C", ""},
      {"links, echoes of scans", "G, B", ""},
      {"map of voids", "M", ""},
      {"save a picture", "P", "press the left stick"},
      {"this help", "H or F1", "X"},
      {"quit", "escape", "back"},
  };
  return help;
}

struct Controls::State {
  LeftButton left = LeftButton::looks;
  Pointer pointer;
  std::set<SDL_Scancode> held;
  Vec3 look_deg;
  std::vector<DriveAction> actions;
  std::map<SDL_JoystickID, SDL_GameController*> pads;

  std::string plug_in(int device);
  std::string unplug(SDL_JoystickID id);
  void press(SDL_Scancode key);
};

std::string Controls::State::plug_in(int device) {
  SDL_GameController* const pad = sdl().GameControllerOpen(device);
  if (!pad) return std::string("a game controller cannot be used: ") + sdl().GetError();
  const SDL_JoystickID id = sdl().JoystickInstanceID(sdl().GameControllerGetJoystick(pad));
  if (!pads.emplace(id, pad).second) return "";  // SDL counts how often it was opened
  const char* name = sdl().GameControllerName(pad);
  return std::string("game controller: ") + (name ? name : "without a name");
}

std::string Controls::State::unplug(SDL_JoystickID id) {
  const auto pad = pads.find(id);
  if (pad == pads.end()) return "";
  sdl().GameControllerClose(pad->second);
  pads.erase(pad);
  return "the game controller is gone: its sticks count as released, the keyboard goes on";
}

void Controls::State::press(SDL_Scancode key) {
  held.insert(key);
  const auto action = kActionKeys.find(key);
  if (action != kActionKeys.end()) actions.push_back(action->second);
}

Controls::Controls(LeftButton left) : state_(std::make_unique<State>()) { state_->left = left; }

Controls::~Controls() {
  for (const auto& [id, pad] : state_->pads) sdl().GameControllerClose(pad);
}

std::string Controls::handle(const SDL_Event& event) {
  State& s = *state_;
  switch (event.type) {
    case SDL_QUIT:
      s.actions.push_back(DriveAction::quit);
      break;
    case SDL_KEYDOWN:
      if (!event.key.repeat) s.press(event.key.keysym.scancode);
      break;
    case SDL_KEYUP:
      s.held.erase(event.key.keysym.scancode);
      break;
    case SDL_MOUSEBUTTONDOWN:
    case SDL_MOUSEBUTTONUP:
      if (event.button.button != SDL_BUTTON_LEFT) break;
      s.pointer.x = event.button.x, s.pointer.y = event.button.y;
      s.pointer.pressed = event.type == SDL_MOUSEBUTTONDOWN;
      if (s.pointer.pressed) s.pointer.press_x = s.pointer.x, s.pointer.press_y = s.pointer.y;
      break;
    case SDL_MOUSEMOTION:
      s.pointer.x = event.motion.x, s.pointer.y = event.motion.y;
      if (event.motion.state & (s.left == LeftButton::looks ? SDL_BUTTON_LMASK : SDL_BUTTON_RMASK))
        s.look_deg += Vec3(0, event.motion.yrel, -event.motion.xrel) * kMouseDegrees;
      break;
    case SDL_MOUSEWHEEL:
      if (event.wheel.y != 0)
        s.actions.push_back(event.wheel.y > 0 ? DriveAction::faster : DriveAction::slower);
      break;
    case SDL_WINDOWEVENT:
      if (event.window.event == SDL_WINDOWEVENT_FOCUS_LOST) release_all();
      break;
    case SDL_CONTROLLERDEVICEADDED:
      return s.plug_in(event.cdevice.which);
    case SDL_CONTROLLERDEVICEREMOVED:
      return s.unplug(event.cdevice.which);
    case SDL_CONTROLLERBUTTONDOWN:
      if (const auto action = kPadButtons.find(event.cbutton.button); action != kPadButtons.end())
        s.actions.push_back(action->second);
      break;
    default:
      break;
  }
  return "";
}

DriveInput Controls::take() {
  State& s = *state_;
  DriveInput input;
  for (const AxisKey& key : kAxisKeys)
    if (s.held.count(key.key)) input.*key.axis += key.sign;
  for (const auto& [id, pad] : s.pads)
    for (const AxisStick& stick : kAxisSticks)
      input.*stick.axis +=
          stick.sign * past_dead_zone(sdl().GameControllerGetAxis(pad, stick.stick));
  for (double DriveInput::*axis :
       {&DriveInput::forward, &DriveInput::roll, &DriveInput::pitch, &DriveInput::yaw})
    input.*axis = std::clamp(input.*axis, -1.0, 1.0);
  input.look_deg = s.look_deg;
  input.actions = std::move(s.actions);
  s.look_deg = {};
  s.actions.clear();
  return input;
}

void Controls::release_all() {
  state_->held.clear();
  state_->pointer.pressed = false;
}

const Pointer& Controls::pointer() const { return state_->pointer; }

int Controls::gamepads() const { return int(state_->pads.size()); }

}  // namespace rubble
