#include "app/drive/sdl.h"

#include <dlfcn.h>

#include <string>

#include "kernel/base/error.h"

namespace rubble {
namespace {

constexpr const char* kLibrary = "libSDL2-2.0.so.0";

Sdl open_sdl() {
  void* const library = dlopen(kLibrary, RTLD_NOW | RTLD_LOCAL);
  if (!library)
    throw RunError(std::string("this machine has no window to drive in: ") + dlerror() +
                   "\n  install SDL 2 (Debian, Ubuntu: libsdl2-2.0-0); all other commands work without it");
  Sdl sdl;
  const auto find = [library](const char* name) {
    void* const found = dlsym(library, name);
    if (!found) throw RunError(std::string(kLibrary) + " has no " + name + ": it is too old");
    return found;
  };
#define RUBBLE_SDL_FIND(name) sdl.name = reinterpret_cast<decltype(&SDL_##name)>(find("SDL_" #name));
  RUBBLE_SDL_FUNCTIONS(RUBBLE_SDL_FIND)
#undef RUBBLE_SDL_FIND
  return sdl;
}

}  // namespace

const Sdl& sdl() {
  static const Sdl opened = open_sdl();
  return opened;
}

}  // namespace rubble
