// Every page of docs/tutorials, typed as it is written: blocks of ```sh are run one after the other in one folder, and
// a block of ```text must be in what the block before it printed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <vector>

#include "tests/app/program.h"

namespace rubble::testing {
namespace tutorials_test {

namespace fs = std::filesystem;
const std::string kTutorials = std::string(RUBBLE_SOURCE_DIR) + "/docs/tutorials/";

struct Block {
  std::string language, text;
};

std::vector<Block> read_blocks(const std::string& page) {
  std::vector<Block> blocks;
  std::istringstream lines(read_file(page));
  bool inside = false;
  for (std::string line; std::getline(lines, line);) {
    const bool fence = line.rfind("```", 0) == 0;
    if (fence && !inside) blocks.push_back({line.substr(3), ""});
    if (fence) inside = !inside;
    if (inside && !fence) blocks.back().text += line + "\n";
  }
  return blocks;
}

// Runs a block in the folder; what it prints, and its exit code on a last line.
std::string run_block(const ScratchFolder& folder, const std::string& text, const std::string& more = "") {
  const std::string program = fs::path(RUBBLE_PROGRAM).parent_path().string();
  write_file(folder / ".block.sh", "set -e\nexport PATH=" + program + ":$PATH PYTHONPATH=" RUBBLE_PYTHON_PATH
                                   " PYTHONDONTWRITEBYTECODE=1 " + more + "\n" + text);
  std::system(("cd '" + folder.path().string() + "' && bash .block.sh > .out 2>&1; echo exit $? >> '" +
               (folder / ".out") + "'")
                  .c_str());
  return read_file(folder / ".out");
}

struct Page {
  const char* name;
  std::vector<const char*> files;  // that are there at the end
};
const Page kPages[] = {
    {"first_steps", {"out/first/preview.png", "yard.png", "out/yard_mission/flight.json", "out/nine/voids/voids.json"}},
    {"slam", {"out/yard/preview.png", "out/yard/view.html", "out/yard/tum/rgb.txt", "out/yard/settings/orbslam3.yaml"}},
    {"explore", {"out/yard/preview.png", "out/yard/robots/rover.txt", "out/suite"}},
    {"train", {"policy.npy"}},
};

class Tutorial : public ::testing::TestWithParam<Page> {};

TEST_P(Tutorial, WorksAsWritten) {
  const std::string page = kTutorials + GetParam().name + ".md";
  const std::vector<Block> blocks = read_blocks(page);
  if (std::string(GetParam().name) == "train" && std::string(RUBBLE_PYTHON_PATH).empty())
    GTEST_SKIP() << "the Python package is not built";
  const ScratchFolder folder;
  std::string printed;
  int run = 0;
  for (const Block& block : blocks) {
    if (block.language == "sh") {
      printed = run_block(folder, block.text);
      ++run;
      ASSERT_NE(printed.find("exit 0\n"), std::string::npos) << block.text << "\n" << printed;
    } else if (block.language == "text") {
      EXPECT_NE(printed.find(block.text), std::string::npos) << "not printed:\n" << block.text << "but:\n" << printed;
    }
  }
  EXPECT_GE(run, 2) << page;
  for (const char* file : GetParam().files) EXPECT_TRUE(fs::exists(folder / file)) << file;
}

INSTANTIATE_TEST_SUITE_P(All, Tutorial, ::testing::ValuesIn(kPages),
                         [](const auto& page) { return std::string(page.param.name); });

// The last step of docs/tutorials/train.md, typed as it is written: pip asks PyPI.
TEST(NightlyTutorial, GymnasiumOfPyPIMakesAnEnvironment) {
  if (std::string(RUBBLE_PYTHON_PATH).empty()) GTEST_SKIP() << "the Python package is not built";
  const std::string page = kTutorials + "train.md";
  const ScratchFolder folder;
  for (const Block& block : read_blocks(page))
    if (block.language == "python") write_file(folder / "registered.py", block.text);
  ASSERT_TRUE(fs::exists(folder / "registered.py")) << page << " has no block of Python";
  std::istringstream lines(read_file(page));
  int typed = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("    /usr/bin/python3 -m venv ", 0) != 0 && line.rfind("    ~/train/", 0) != 0) continue;
    const std::string printed = run_block(folder, line + "\n", "HOME=" + folder.path().string());
    ASSERT_NE(printed.find("exit 0\n"), std::string::npos) << line << "\n" << printed;
    ++typed;
  }
  EXPECT_EQ(typed, 2) << "an environment, and what runs in it";
}

// The plan and the mission of docs/how_to/my_building.md: its wall is missing, so its floor falls.
TEST(HowTo, MyBuildingCollapses) {
  const ScratchFolder folder;
  for (const Block& block : read_blocks(std::string(RUBBLE_SOURCE_DIR) + "/docs/how_to/my_building.md")) {
    if (block.language == "text") write_file(folder / "shed.txt", block.text);
    if (block.text.rfind("return rubble.mission", 0) == 0) write_file(folder / "shed.lua", block.text);
  }
  const Outcome settle = run_rubble("settle " + (folder / "shed.lua") + " --quiet --out " + (folder / "out"));
  ASSERT_EQ(settle.exit_code, 0) << settle.err;
  EXPECT_EQ(run_rubble("voids " + (folder / "out") + " --voxel 0.1 --quiet").exit_code, 0);
  const std::string manifest = read_file(folder / "out/manifest.json");
  const std::size_t at = manifest.find("\"simulated_s\": ");
  ASSERT_NE(at, std::string::npos);
  EXPECT_GT(std::strtod(manifest.c_str() + at + 15, nullptr), 3) << "a building that stands is at rest after 1 s";
}

TEST(Tutorials, EachIsTyped) {
  for (const auto& entry : fs::directory_iterator(kTutorials)) {
    const std::string name = entry.path().stem().string();
    EXPECT_TRUE(std::any_of(std::begin(kPages), std::end(kPages), [&](const Page& p) { return p.name == name; })) << name;
  }
}

}  // namespace tutorials_test
}  // namespace rubble::testing
