// Options of a renderer whose textures and baked light other tests of the same run may have made: for tests of
// something else than how these are made.
#pragma once

#include <cstdlib>
#include <string>

#include "render/renderer.h"

namespace rubble::testing {

// The cache is the folder of the environment variable RUBBLE_CACHE, which `make test` empties first; without the
// variable, nothing is kept. Never for what a path tracer draws: its tiles would be taken from the cache, too.
inline RenderOptions cached_options() {
  RenderOptions options;
  options.threads = 1;
  const char* folder = std::getenv("RUBBLE_CACHE");
  if (folder && std::string(folder) != "off") options.cache_folder = folder;
  return options;
}

}  // namespace rubble::testing
