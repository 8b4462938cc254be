// SDL's events, real ones and those of a virtual game controller, as what is asked of the camera.
#include <SDL.h>
#include <gtest/gtest.h>

#include "app/drive/controls.h"
#include "app/drive/inspect/inspector.h"
#include "tests/app/program.h"

namespace rubble {
namespace drive_controls_test {

class DriveControls : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    SDL_SetMainReady();
    SDL_setenv("SDL_VIDEODRIVER", "dummy", 1);
    SDL_SetHint(SDL_HINT_JOYSTICK_ALLOW_BACKGROUND_EVENTS, "1");
    ASSERT_EQ(SDL_Init(SDL_INIT_VIDEO | SDL_INIT_GAMECONTROLLER), 0) << SDL_GetError();
  }
  static void TearDownTestSuite() { SDL_Quit(); }

  void key(SDL_Scancode code, bool down) {
    SDL_Event event{};
    event.type = down ? SDL_KEYDOWN : SDL_KEYUP;
    event.key.keysym.scancode = code;
    controls.handle(event);
  }
  std::string pump() {
    std::string said;
    SDL_Event event;
    while (SDL_PollEvent(&event)) said += controls.handle(event);
    return said;
  }

  Controls controls;
};

TEST_F(DriveControls, HeldKeysPushUntilTheyAreReleased) {
  key(SDL_SCANCODE_W, true), key(SDL_SCANCODE_E, true), key(SDL_SCANCODE_UP, true);
  DriveInput input = controls.take();
  EXPECT_EQ(input.forward, 1);
  EXPECT_EQ(input.roll, 1);
  EXPECT_EQ(input.pitch, -1);
  EXPECT_EQ(input.yaw, 0);
  key(SDL_SCANCODE_S, true);  // against W
  EXPECT_EQ(controls.take().forward, 0);
  key(SDL_SCANCODE_W, false);
  EXPECT_EQ(controls.take().forward, -1);
  controls.release_all();
  EXPECT_EQ(controls.take().forward, 0);
}

TEST_F(DriveControls, ActionsComeOnceAndInOrder) {
  key(SDL_SCANCODE_L, true), key(SDL_SCANCODE_F, true);
  EXPECT_EQ(controls.take().actions, (std::vector<DriveAction>{DriveAction::lamp, DriveAction::fog}));
  EXPECT_TRUE(controls.take().actions.empty());
}

// Rows of a page's table: "|what|keys|gamepad|".
std::string rows_of(const std::vector<KeyHelp>& help) {
  std::string rows;
  for (const KeyHelp& row : help) rows += "|" + std::string(row.what) + "|" + row.keys + "|" + row.gamepad + "|\n";
  return rows;
}

TEST_F(DriveControls, ThePagesHaveTheKeysThatTheHelpShows) {
  EXPECT_NE(testing::read_file(RUBBLE_SOURCE_DIR "/docs/how_to/drive.md").find(rows_of(all_key_help())), std::string::npos)
      << rows_of(all_key_help());
  EXPECT_NE(testing::read_file(RUBBLE_SOURCE_DIR "/docs/how_to/inspect.md").find(rows_of(all_inspector_help())), std::string::npos)
      << rows_of(all_inspector_help());
}

TEST_F(DriveControls, TheMousePullsWithItsLeftButtonWhereTheRightOneLooks) {
  const auto mouse = [](Controls& c, Uint32 type, int x, int y, Uint32 held) {
    SDL_Event event{};
    event.type = type;
    if (type == SDL_MOUSEMOTION) {
      event.motion.x = x, event.motion.y = y, event.motion.xrel = 10, event.motion.state = held;
    } else {
      event.button.x = x, event.button.y = y, event.button.button = SDL_BUTTON_LEFT;
    }
    c.handle(event);
  };
  Controls pulling(LeftButton::pulls);
  mouse(pulling, SDL_MOUSEBUTTONDOWN, 30, 40, 0);
  EXPECT_TRUE(pulling.pointer().pressed);
  mouse(pulling, SDL_MOUSEMOTION, 50, 60, SDL_BUTTON_LMASK);
  EXPECT_EQ(pulling.pointer().x, 50);
  EXPECT_EQ(pulling.pointer().y, 60);
  EXPECT_EQ(pulling.pointer().press_x, 30);
  EXPECT_EQ(pulling.pointer().press_y, 40);
  EXPECT_EQ(pulling.take().look_deg.z, 0) << "the left button does not turn";
  mouse(pulling, SDL_MOUSEMOTION, 50, 60, SDL_BUTTON_RMASK);
  EXPECT_LT(pulling.take().look_deg.z, 0);
  mouse(pulling, SDL_MOUSEBUTTONUP, 50, 60, 0);
  EXPECT_FALSE(pulling.pointer().pressed);
  mouse(pulling, SDL_MOUSEBUTTONDOWN, 1, 1, 0);
  pulling.release_all();
  EXPECT_FALSE(pulling.pointer().pressed) << "the window lost the mouse";
  mouse(controls, SDL_MOUSEMOTION, 50, 60, SDL_BUTTON_LMASK);
  EXPECT_LT(controls.take().look_deg.z, 0) << "in a drive it turns";
}

TEST_F(DriveControls, AVirtualGamepadDrivesAndStopsWhenItIsUnplugged) {
  const int device = SDL_JoystickAttachVirtual(SDL_JOYSTICK_TYPE_GAMECONTROLLER,
                                               SDL_CONTROLLER_AXIS_MAX, SDL_CONTROLLER_BUTTON_MAX, 0);
  ASSERT_GE(device, 0) << SDL_GetError();
  EXPECT_NE(pump().find("game controller"), std::string::npos);
  ASSERT_EQ(controls.gamepads(), 1);
  SDL_Joystick* const stick = SDL_JoystickOpen(device);
  ASSERT_TRUE(stick);
  SDL_JoystickSetVirtualAxis(stick, SDL_CONTROLLER_AXIS_LEFTY, -32768);
  SDL_JoystickSetVirtualAxis(stick, SDL_CONTROLLER_AXIS_RIGHTX, 3000);  // in the dead zone
  SDL_JoystickSetVirtualButton(stick, SDL_CONTROLLER_BUTTON_A, SDL_PRESSED);
  SDL_JoystickUpdate();
  pump();
  const DriveInput input = controls.take();
  EXPECT_EQ(input.forward, 1);
  EXPECT_EQ(input.yaw, 0);
  EXPECT_EQ(input.actions, std::vector<DriveAction>{DriveAction::lamp});
  SDL_JoystickClose(stick);
  ASSERT_EQ(SDL_JoystickDetachVirtual(device), 0);
  EXPECT_NE(pump().find("gone"), std::string::npos);
  EXPECT_EQ(controls.gamepads(), 0);
  EXPECT_EQ(controls.take().forward, 0);
}

}  // namespace drive_controls_test
}  // namespace rubble
