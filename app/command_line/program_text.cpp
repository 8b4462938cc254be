#include "app/command_line/program_text.h"

#include "app/support/build_info.h"

namespace rubble {

ProgramText program_text() {
  ProgramText text;
  text.about =
      "Rubble simulates collapsed structures, and robots with sensors in them. A mission in Lua and a seed give a "
      "settled ruin, recordings for ROS, MRPT and other tools, and the ground truth.";
  text.version = "rubble " + build_info().version;
  text.exit_codes = {{0, "done"},    {1, "bad input"},
                     {2, "failure"}, {3, "finished, but the pile did not settle or lost pieces"},
                     {4, "stopped by a signal"}, {5, "results or files differ or are missing"}};
  text.environment = {
      {"RUBBLE_ASSETS", "Folder of the bundled packs; default: `assets` beside the program, or "
                        "`../share/rubble/assets`"},
      {"RUBBLE_THREADS", "Number of threads without --threads; default: one per processor"},
      {"RUBBLE_CACHE", "Folder of the cache; default: ~/.cache/rubble; `off`: no cache"},
      {"RUBBLE_DEVICE", "What draws: `software` (default), this program on the processor, with the same bits on every "
                        "machine and without any driver, or `gl`, a graphics card"},
      {"RUBBLE_EGL_DEVICE", "Number of the EGL device for `gl`; default: the first that works, hardware before software"}};
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
