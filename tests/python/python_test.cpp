// The Python package: its unit tests (test_*.py) and its tutorials, each in a process of Debian's Python.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace rubble {
namespace python_test {

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

// more: for the environment, before the rest.
void expect_tests(const std::string& file, const std::string& more = "") {
  const Ran ran = run(more + " /usr/bin/python3 -m unittest -v tests/python/" + file);
  EXPECT_EQ(ran.status, 0) << ran.output;
  EXPECT_NE(ran.output.find("\nOK"), std::string::npos) << ran.output;
}

TEST(Python, PilesAnswer) { expect_tests("test_pile.py"); }
TEST(Python, SensorsAndRobotsAnswer) { expect_tests("test_sensors.py"); }
TEST(Python, SessionsGiveWhatARunRecords) { expect_tests("test_session.py"); }
TEST(Python, DatasetsAreRead) { expect_tests("test_dataset.py"); }
TEST(Python, ArraysAreWhole) { expect_tests("test_arrays.py"); }
TEST(Python, MissionsSayWhatLuaSays) { expect_tests("test_missions.py"); }
TEST(Python, BatchesAreThoseOfTheProgram) { expect_tests("test_batches.py"); }
TEST(Python, StubsAndMetadataFitThePackage) { expect_tests("test_stubs.py"); }

// With the oldest and the newest numpy that pip has for Debian's Python: what the module gives does not depend on it.
TEST(NightlyPython, ArraysAreWholeWithNumpyOneAndTwo) {
  for (const std::string version : {"numpy<2", "numpy>=2"}) {
    const std::string folder = std::filesystem::temp_directory_path() / ("rubble_numpy_" + std::to_string(getpid()));
    const Ran pip = run("python3 -m pip install --quiet --disable-pip-version-check --only-binary=:all: --python-version "
                        "$(/usr/bin/python3 -c 'import sys; print(\"%d.%d\" % sys.version_info[:2])') --target " + folder +
                        " '" + version + "'");
    if (pip.status != 0) GTEST_SKIP() << "no index of packages is reached: " << pip.output;
    expect_tests("test_arrays.py", "PYTHONPATH=" + folder + ":'" RUBBLE_PYTHON_PATH "'");
    expect_tests("test_envs.py", "PYTHONPATH=" + folder + ":'" RUBBLE_PYTHON_PATH "'");
    std::filesystem::remove_all(folder);
  }
}

// A folder of its own with the packages of tests/python/requirements.txt; empty: no index is reached.
std::string install_requirements(Ran& pip) {
  const std::string folder = std::filesystem::temp_directory_path() / ("rubble_gym_" + std::to_string(getpid()));
  pip = run("python3 -m pip install --quiet --disable-pip-version-check --no-deps --only-binary=:all: --python-version "
            "$(/usr/bin/python3 -c 'import sys; print(\"%d.%d\" % sys.version_info[:2])') --target " + folder +
            " -r tests/python/requirements.txt");
  return pip.status == 0 ? folder : "";
}

TEST(PythonGymnasium, MakesThemAndHasNothingToSay) {
  Ran pip;
  const std::string folder = install_requirements(pip);
  if (folder.empty()) GTEST_SKIP() << "no index of packages is reached: " << pip.output;
  expect_tests("test_gymnasium.py", "PYTHONPATH=" + folder + ":'" RUBBLE_PYTHON_PATH "'");
  std::filesystem::remove_all(folder);
}

TEST(PythonDocument, RunsAsItIsWritten) { expect_tests("test_document.py"); }
TEST(PythonEnvironments, RepeatTheirEpisodes) { expect_tests("test_envs.py"); }

TEST(PythonEnvironments, TheReferenceIsUpToDate) { expect_tests("test_env_reference.py"); }
TEST(PythonEnvironments, KeepWhatGymnasiumAsksOfThem) { expect_tests("test_env_contract.py"); }

TEST(PythonEnvironments, DrawWhatTheyAreToldTo) { expect_tests("test_randomization.py"); }
TEST(PythonEnvironments, HaveSeveralRobots) { expect_tests("test_team.py"); }
TEST(PythonEnvironments, AreRecordedAsDatasets) { expect_tests("test_episodes.py"); }
TEST(PythonEnvironments, StepInBatches) { expect_tests("test_batch.py"); }

TEST(PythonPolicy, SeesAndAnswers) { expect_tests("test_ppo.py -k Senses -k Agent"); }
TEST(PythonPolicy, IsTrainedByNight) { expect_tests("test_train_nightly.py"); }
TEST(NightlyPython, APolicyLearns) { expect_tests("test_ppo.py -k Training"); }

TEST(PythonBench, WritesItsTableIntoTheDocument) {
  const std::string copy = std::filesystem::temp_directory_path() / ("rubble_envs_" + std::to_string(getpid()) + ".md");
  std::ofstream(copy) << "before\n<!-- begin envs -->\nold\n<!-- end envs -->\nafter\n<!-- begin batch -->\n<!-- end batch -->\n";
  const Ran ran = run("/usr/bin/python3 bench/envs_bench.py --steps 5 --threads 1 --colour --write " + copy);
  EXPECT_EQ(ran.status, 0) << ran.output;
  const Ran batch = run("/usr/bin/python3 bench/envs_bench.py --batch 2 --steps 4 --write " + copy);
  EXPECT_EQ(batch.status, 0) << batch.output;
  std::ostringstream text;
  text << std::ifstream(copy).rdbuf();
  EXPECT_EQ(text.str().find("old"), std::string::npos) << text.str();
  for (const char* part : {"before\n", "depth 64 x 64 | 1 | ", "depth and colour 128 x 128 | 1 | ", "| `SnakeExplore`",
                           "<!-- end envs -->\nafter\n", "|2, 2 threads|", "\n|`CrawlerNav`|"})
    EXPECT_NE(text.str().find(part), std::string::npos) << part << "\n" << text.str();
  std::filesystem::remove(copy);
}

TEST(NightlyPython, MemoryStaysOverAHundredThousandSteps) {
  const Ran ran = run("/usr/bin/env RUBBLE_MEMORY_STEPS=100000 /usr/bin/python3 tests/python/test_envs.py -v Memory");
  EXPECT_EQ(ran.status, 0) << ran.output;
  EXPECT_NE(ran.output.find("\nOK"), std::string::npos) << ran.output;
}

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

}  // namespace python_test
}  // namespace rubble
