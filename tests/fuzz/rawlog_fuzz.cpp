#include "io/playback/picture_sources.h"
#include "io/playback/recording_check.h"
#include "tests/fuzz/fuzz_file.h"

using namespace rubble;

void fuzz_one(std::string_view bytes) {
  const std::string path = fuzz::folder().write("mission.rawlog", bytes);
  fuzz::knock([&] { check_recording(path); });
  fuzz::knock([&] { find_rawlog_picture(fuzz::folder().path(), {"rgb", 0, false}); });
}
