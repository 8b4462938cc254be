#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <ostream>
#include <string>

#include "tests/determinism/standard_scenes.h"

namespace rubble::determinism {

void PrintTo(const Scene& scene, std::ostream* out) { *out << scene.name; }

namespace golden_test {

constexpr char kHint[] =
    "if the change of results is meant: cmake --build <build> --target "
    "update_golden, and say why in the commit";

// Lines of the golden table by scene.
std::map<std::string, std::string> golden_lines() {
  std::map<std::string, std::string> lines;
  std::ifstream file(RUBBLE_SOURCE_DIR "/tests/golden/kernel.txt");
  for (std::string line; std::getline(file, line);) {
    if (!line.empty() && line[0] != '#') lines[line.substr(0, line.find(' '))] = line;
  }
  return lines;
}

class GoldenScene : public ::testing::TestWithParam<Scene> {
 protected:
  std::string line(int threads, double push = 0) const {
    SceneOptions options;
    options.threads = threads;
    options.push = push;
    return format_result(GetParam().name, GetParam().run(options));
  }
};

TEST_P(GoldenScene, MatchesTheTableForAnyThreadCount) {
  const std::string expected = golden_lines()[GetParam().name];
  for (int threads : {1, 3, 8}) {
    EXPECT_EQ(line(threads), expected) << threads << " threads; " << kHint;
  }
}

TEST_P(GoldenScene, ANanometreChangesTheHash) { EXPECT_NE(line(1, 1e-9), golden_lines()[GetParam().name]); }

INSTANTIATE_TEST_SUITE_P(Scenes, GoldenScene, ::testing::ValuesIn(standard_scenes()),
                         [](const auto& scene) { return scene.param.name; });

TEST(GoldenTable, HasALineForEachSceneAndNoOther) {
  const std::map<std::string, std::string> lines = golden_lines();
  EXPECT_EQ(lines.size(), standard_scenes().size());
  for (const Scene& scene : standard_scenes()) EXPECT_EQ(lines.count(scene.name), 1u) << scene.name;
}

}  // namespace golden_test
}  // namespace rubble::determinism
