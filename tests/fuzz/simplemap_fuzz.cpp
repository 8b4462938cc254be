#include "io/playback/recording_check.h"
#include "tests/fuzz/fuzz_file.h"

using namespace rubble;

void fuzz_one(std::string_view bytes) {
  const std::string path = fuzz::folder().write("mission.simplemap", bytes);
  fuzz::knock([&] { check_recording(path); });
}
