// SDL's events, real ones and those of a virtual game controller, as what is asked of the camera.
#include <SDL.h>
#include <gtest/gtest.h>

#include "app/drive/controls.h"

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
