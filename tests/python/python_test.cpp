// The Python package: its unit tests (test_*.py) and its tutorials, each in a process of Debian's Python.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <string>

namespace rubble {
namespace {

struct Ran {
  int status = -1;
  std::string output;
};

Ran run(const std::string& command) {
  Ran ran;
  const std::string whole = "cd '" RUBBLE_SOURCE_DIR "' && PYTHONDONTWRITEBYTECODE=1 PYTHONPATH='" RUBBLE_PYTHON_PATH
                            "' RUBBLE_PROGRAM='" RUBBLE_PROGRAM "' " + command + " 2>&1";
  FILE* const pipe = popen(whole.c_str(), "r");
  std::array<char, 4096> part{};
  while (std::size_t got = std::fread(part.data(), 1, part.size(), pipe)) ran.output.append(part.data(), got);
  ran.status = pclose(pipe);
  return ran;
}

void expect_tests(const std::string& file) {
  const Ran ran = run("/usr/bin/python3 -m unittest -v tests/python/" + file);
  EXPECT_EQ(ran.status, 0) << ran.output;
  EXPECT_NE(ran.output.find("\nOK"), std::string::npos) << ran.output;
}

TEST(Python, PilesAnswer) { expect_tests("test_pile.py"); }
TEST(Python, SensorsAndRobotsAnswer) { expect_tests("test_sensors.py"); }
TEST(Python, DatasetsAreRead) { expect_tests("test_dataset.py"); }
TEST(PythonDocument, RunsAsItIsWritten) { expect_tests("test_document.py"); }
TEST(PythonEnvironments, RepeatTheirEpisodes) { expect_tests("test_envs.py"); }

TEST(PythonTutorials, Run) {
  const std::string folder = std::filesystem::temp_directory_path() / ("rubble_tutorial_" + std::to_string(getpid()));
  const std::string dataset = folder + "/out";
  const Ran made = run(RUBBLE_PROGRAM " run scripts/small.lua --quiet --out " + dataset);
  ASSERT_EQ(made.status, 0) << made.output;
  for (const char* tutorial : {"pile.py scripts/small.lua", "sensors.py scripts/small.lua",
                               "robot.py scripts/small.lua", "explore.py"}) {
    const Ran ran = run("/usr/bin/python3 python/tutorials/" + std::string(tutorial));
    EXPECT_EQ(ran.status, 0) << tutorial << "\n" << ran.output;
  }
  const Ran read = run("/usr/bin/python3 python/tutorials/dataset.py " + dataset);
  EXPECT_EQ(read.status, 0) << read.output;
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace rubble
