// docs/tutorials/first_steps.md, run as it is written.
#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>
#include <vector>

#include "tests/app/program.h"

namespace rubble::testing {
namespace first_steps_test {

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
std::string run_block(const ScratchFolder& folder, const std::string& text) {
  const std::string program = RUBBLE_PROGRAM;
  write_file(folder / ".block.sh", "set -e\nexport PATH=" +
                                       program.substr(0, program.find_last_of('/')) + ":$PATH\n" +
                                       text);
  std::system(("cd '" + folder.path().string() +
               "' && RUBBLE_CACHE=.cache bash .block.sh > .out 2>&1; echo exit $? >> '" +
               (folder / ".out") + "'")
                  .c_str());
  return read_file(folder / ".out");
}

TEST(FirstSteps, WorkAsWritten) {
  const ScratchFolder folder;
  std::string printed;
  int run = 0, compared = 0;
  for (const Block& block : read_blocks(std::string(RUBBLE_SOURCE_DIR) + "/docs/tutorials/first_steps.md")) {
    if (block.language == "sh") {
      printed = run_block(folder, block.text);
      ++run;
      ASSERT_NE(printed.find("exit 0\n"), std::string::npos) << block.text << "\n" << printed;
    } else if (block.language == "text") {
      EXPECT_NE(printed.find(block.text), std::string::npos) << "not printed:\n"
                                                             << block.text << "but:\n"
                                                             << printed;
      ++compared;
    }
  }
  EXPECT_EQ(run, 6);
  EXPECT_EQ(compared, 3);
  for (const char* file : {"out/first/preview.png", "yard.png", "out/yard_mission/flight.json",
                           "out/yard_mission/manifest.json", "out/nine/voids/voids.json"})
    EXPECT_TRUE(std::filesystem::exists(folder / file)) << file;
}

}  // namespace first_steps_test
}  // namespace rubble::testing
