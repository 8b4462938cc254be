#include "io/playback/picture_sources.h"
#include "io/playback/recording_check.h"
#include "tests/fuzz/fuzz_file.h"

using namespace rubble;

void fuzz_one(std::string_view bytes) {
  const std::string path = fuzz::folder().write("mission.mcap", bytes);
  fuzz::knock([&] { check_recording(path); });
  for (const char* channel : {"rgb", "depth", "normals"})
    fuzz::knock([&] { find_ros_picture(fuzz::folder().path(), "mission.mcap", {channel, 0, false}); });
}
