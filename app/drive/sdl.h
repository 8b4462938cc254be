// SDL's functions, opened when a window is wanted: all other commands, and machines without SDL, do without it.
#pragma once

#include <SDL.h>

namespace rubble {

#define RUBBLE_SDL_FUNCTIONS(each)                                                                                    \
  each(SetMainReady) each(SetHint) each(Init) each(InitSubSystem) each(Quit) each(GetError) each(GetNumVideoDrivers)  \
  each(GetVideoDriver) each(GetCurrentVideoDriver) each(PollEvent) each(CreateWindow) each(DestroyWindow)             \
  each(SetWindowTitle) each(CreateRenderer) each(DestroyRenderer) each(RenderSetLogicalSize) each(RenderClear)        \
  each(RenderCopy) each(RenderPresent) each(CreateTexture) each(DestroyTexture) each(UpdateTexture)                   \
  each(JoystickInstanceID) each(GameControllerOpen) each(GameControllerClose) each(GameControllerGetJoystick)         \
  each(GameControllerName) each(GameControllerGetAxis)

struct Sdl {
#define RUBBLE_SDL_MEMBER(name) decltype(&SDL_##name) name = nullptr;
  RUBBLE_SDL_FUNCTIONS(RUBBLE_SDL_MEMBER)
#undef RUBBLE_SDL_MEMBER
};

// Throws RunError where this machine has no SDL 2. The library stays open.
const Sdl& sdl();

}  // namespace rubble
