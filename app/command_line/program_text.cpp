#include "app/command_line/program_text.h"

#include "app/support/build_info.h"

namespace rubble {

ProgramText program_text() {
  ProgramText text;
  text.about =
      "Simulates collapsed structures: a seed and a Lua mission give a settled pile, a "
      "camera flight, RGB-D frames, an MRPT rawlog, a ROS bag and the ground truth.";
  text.version = "rubble " + build_info().version;
  text.exit_codes = {{0, "done"},    {1, "bad input"},
                     {2, "failure"}, {3, "finished but did not settle, or lost pieces"},
                     {4, "stopped by a signal"}, {5, "results or files differ, or are missing"}};
  text.environment = {
      {"RUBBLE_ASSETS", "Folder of the bundled packs, instead of `assets` beside the program or "
                        "`../share/rubble/assets`"},
      {"RUBBLE_THREADS", "Number of threads where --threads is not given, instead of the number of processors"},
      {"RUBBLE_CACHE", "Folder of the cache, instead of ~/.cache/rubble; `off`: no cache"},
      {"RUBBLE_EGL_DEVICE", "Number of the EGL device that draws, as --gl-device"}};
  return text;
}

std::string make_footer(const ProgramText& text) {
  std::string codes;
  for (const auto& [code, meaning] : text.exit_codes)
    codes += (codes.empty() ? "" : ", ") + std::to_string(code) + " " + meaning;
  std::string footer = "Exit codes: " + codes + ".\n\nEnvironment:";
  for (const auto& [name, meaning] : text.environment) footer += "\n  " + name + ": " + meaning;
  return footer;
}

}  // namespace rubble
