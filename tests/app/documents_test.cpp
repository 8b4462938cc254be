// Every command of every document is listed with what runs it, and those that can be are run as they are
// written. document_commands.txt is the list.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <vector>

#include "tests/app/program.h"

namespace rubble::testing {
namespace documents_test {

namespace fs = std::filesystem;
const std::string kRoot = RUBBLE_SOURCE_DIR;

struct Listed {
  std::string begins, how;  // how: "run", "text", "test NAME" or "unrun WHY"
  bool whole = false;       // the line is no longer than that
  bool used = false;
  bool fits(const std::string& line) const { return whole ? line == begins : line.rfind(begins, 0) == 0; }
};

std::string trimmed(const std::string& text) {
  const std::size_t from = text.find_first_not_of(" \t"), to = text.find_last_not_of(" \t");
  return from == std::string::npos ? "" : text.substr(from, to - from + 1);
}

std::map<std::string, std::vector<Listed>> read_list() {
  std::map<std::string, std::vector<Listed>> list;
  std::istringstream lines(read_file(kRoot + "/tests/app/document_commands.txt"));
  std::string document;
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line[0] == '#') continue;
    if (line[0] == '[') {
      document = line.substr(1, line.size() - 2);
      continue;
    }
    const std::size_t bar = line.rfind(" | ");
    EXPECT_NE(bar, std::string::npos) << line;
    Listed entry{trimmed(line.substr(0, bar)), trimmed(line.substr(bar + 3))};
    entry.whole = entry.begins.back() != '*';
    if (!entry.whole) entry.begins.pop_back();
    list[document].push_back(entry);
  }
  return list;
}

// Without what a comment says after it.
std::string without_comment(const std::string& line) {
  const std::size_t at = line.find(" #");
  return trimmed(at == std::string::npos ? line : line.substr(0, at));
}

// Lines of indented blocks and of ```sh, ```python and bare ``` blocks; one that ends in a backslash goes on.
std::vector<std::string> commands_of(const std::string& document) {
  std::vector<std::string> commands;
  std::istringstream lines(read_file(kRoot + "/" + document));
  std::string fence, joined;
  bool inside = false, list_item = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("```", 0) == 0) {
      inside = !inside;
      fence = inside ? line.substr(3) : "";
      continue;
    }
    if (!inside && !line.empty() && line[0] != ' ') list_item = line.rfind("- ", 0) == 0;
    const bool indented = !inside && !list_item && line.rfind("    ", 0) == 0;
    const bool fenced = inside && (fence.empty() || fence == "sh" || fence == "python");
    if (!indented && !fenced) continue;
    std::string text = without_comment(line);
    if (text.empty() || text[0] == '#' || text[0] == '|') continue;
    if (text.back() == '\\') {
      joined += trimmed(text.substr(0, text.size() - 1)) + " ";
      continue;
    }
    commands.push_back(joined + text);
    joined.clear();
  }
  return commands;
}

std::vector<std::string> documents() {
  std::vector<std::string> names{"README.md", "assets/README.md"};
  for (const auto& entry : fs::recursive_directory_iterator(kRoot + "/docs"))
    if (entry.path().extension() == ".md") names.push_back(fs::relative(entry.path(), kRoot).string());
  std::sort(names.begin(), names.end());
  return names;
}

std::string all_tests() {
  std::string text;
  for (const auto& entry : fs::recursive_directory_iterator(kRoot + "/tests"))
    if (entry.path().extension() == ".cpp" || entry.path().extension() == ".py") text += read_file(entry.path());
  return text;
}

TEST(Documents, EveryCommandIsListedWithWhatRunsIt) {
  auto list = read_list();
  const std::string tests = all_tests();
  int found = 0;
  for (const std::string& document : documents()) {
    for (const std::string& command : commands_of(document)) {
      auto& entries = list[document];
      const auto entry = std::find_if(entries.begin(), entries.end(), [&](const Listed& l) { return l.fits(command); });
      ++found;
      if (entry == entries.end()) {
        ADD_FAILURE() << document << " has a command that tests/app/document_commands.txt does not list: " << command;
        continue;
      }
      entry->used = true;
    }
  }
  EXPECT_GT(found, 150);
  for (const auto& [document, entries] : list) {
    for (const Listed& l : entries) {
      EXPECT_TRUE(l.used) << document << " has no such command any more: " << l.begins;
      if (l.how.rfind("test ", 0) != 0) {
        EXPECT_TRUE(l.how == "run" || l.how == "text" || l.how.rfind("unrun ", 0) == 0) << l.how;
        continue;
      }
      const std::string name = l.how.substr(5);
      const bool file = name.rfind("tests/", 0) == 0;
      EXPECT_TRUE(file ? fs::exists(kRoot + "/" + name) : tests.find(name) != std::string::npos)
          << document << ": " << l.begins << ": no such test: " << name;
    }
  }
}

// The control: a command that nobody listed is found.
TEST(Documents, ACommandIsFoundInEveryKindOfBlock) {
  const std::vector<std::string> commands = commands_of("docs/reference/formats.md");
  const auto has = [&](const std::string& begin) {
    return std::any_of(commands.begin(), commands.end(), [&](const std::string& c) { return c.rfind(begin, 0) == 0; });
  };
  EXPECT_TRUE(has("rawlog-edit --info"));
  EXPECT_TRUE(has("colmap point_triangulator --database_path db --image_path colmap/images --input_path"));
  EXPECT_TRUE(has("import cv2"));
}

// Where the documents' commands run: with what they take for given, small where the reader chooses.
class Place {
 public:
  explicit Place(const std::string& document) : document_(document) {
    const fs::path program = RUBBLE_PROGRAM;
    fs::create_directories(folder_.path() / "build");
    fs::create_directory_symlink(program.parent_path(), folder_.path() / "build/release");
    fs::create_directory_symlink(kRoot + "/scripts", folder_.path() / "scripts");
    const std::string mission = read_mission();
    write_file(folder_ / "mission.lua", mission);
    write_file(folder_ / "other.lua", mission);
  }

  // Gives what the command printed, and its exit code on a last line.
  std::string run(const std::string& command) const {
    const std::string path = fs::path(RUBBLE_PROGRAM).parent_path().string();
    write_file(folder_ / ".command.sh", "set -e\nexport PATH=" + path + ":/usr/bin:$PATH QT_QPA_PLATFORM=offscreen\n" + command + "\n");
    std::system(("cd '" + folder_.path().string() + "' && bash .command.sh > .out 2>&1; echo exit $? >> .out; mv .out '" +
                 (folder_ / "printed") + "'").c_str());
    return read_file(folder_ / "printed");
  }
  std::string at(const std::string& name) const { return folder_ / name; }

 private:
  // The first mission that the document shows; without one, a tiny one.
  std::string read_mission() const {
    const std::string text = read_file(kRoot + "/" + document_);
    const std::size_t begin = text.find("```lua\nreturn rubble.mission");
    if (begin == std::string::npos) return kTinyMission;
    return text.substr(begin + 7, text.find("```", begin + 7) - begin - 7);
  }

  std::string document_;
  ScratchFolder folder_;
};

// What a reader has when a page says `out/first_pile`, `mission.rawlog` or `estimate.txt`.
void prepare(const Place& place, const std::string& document) {
  if (document == "docs/reference/formats.md") {
    const std::string run =
        "rubble run scripts/small.lua --set camera.width=320 --set camera.height=240 --set trajectory.rate_hz=60 "
        "--set outputs.colmap=true --out out/first_pile";
    ASSERT_NE(place.run(run).find("exit 0\n"), std::string::npos);
    place.run("cp -r out/first_pile/. .; printf '[MappingApplication]\\npointsMap_count=1\\n' > map.ini");
  }
}

bool ends_well(const std::string& printed) {
  const std::string end = "exit 0\n";
  return printed.size() >= end.size() && printed.compare(printed.size() - end.size(), end.size(), end) == 0;
}

class NightlyDocuments : public ::testing::TestWithParam<const char*> {};

TEST_P(NightlyDocuments, CommandsRunAsTheyAreWritten) {
  const std::string document = GetParam();
  const std::vector<Listed> entries = read_list()[document];
  const Place place(document);
  prepare(place, document);
  const bool colmap = std::system("command -v colmap > /dev/null") == 0;
  int run = 0;
  for (const std::string& command : commands_of(document)) {
    const auto entry = std::find_if(entries.begin(), entries.end(), [&](const Listed& l) { return l.fits(command); });
    if (entry == entries.end() || entry->how != "run") continue;
    ++run;
    if (command.rfind("colmap", 0) == 0 && !colmap) continue;
    const std::string printed = place.run(command);
    EXPECT_TRUE(ends_well(printed)) << document << ": " << command << "\n" << printed;
  }
  EXPECT_GE(run, 1) << "nothing to run: take it out of the list below";
  if (document == "docs/reference/formats.md" && colmap) {
    EXPECT_TRUE(fs::exists(place.at("points/points3D.bin")));
  }
}

constexpr const char* kRun[]{"README.md",         "docs/explanation/autonomy.md", "docs/explanation/collapse.md", "docs/reference/formats.md",
                            "docs/how_to/headless.md",  "docs/reference/lidar.md",
                            "docs/explanation/optics.md",    "docs/development/performance.md", "docs/explanation/search.md",
                            "docs/explanation/sky.md",       "docs/explanation/surroundings.md", "docs/explanation/weather.md", "docs/how_to/simulators.md"};
INSTANTIATE_TEST_SUITE_P(All, NightlyDocuments, ::testing::ValuesIn(kRun));

// No document with something to run is left out above.
// What other platforms were compared with is what this kernel gives.
TEST(Documents, NoneHasTheMarksOfAMergeThatWasNotMended) {
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kRoot + "/docs")) {
    if (entry.path().extension() != ".md") continue;
    std::istringstream lines(read_file(entry.path()));
    for (std::string line; std::getline(lines, line);)
      for (const char* mark : {"<<<<<<< ", ">>>>>>> "}) EXPECT_NE(line.rfind(mark, 0), 0u) << entry.path() << ": " << line;
  }
}

TEST(Documents, ThePlatformsTableHasTheGoldenHashes) {
  const std::string page = read_file(RUBBLE_SOURCE_DIR "/docs/development/platforms.md");
  std::istringstream golden(read_file(RUBBLE_SOURCE_DIR "/tests/golden/kernel.txt"));
  int scenes = 0;
  for (std::string line; std::getline(golden, line);) {
    std::istringstream words(line);
    std::string scene, step, hash;
    words >> scene >> step >> hash;
    if (scene == "#" || scene == "articulated") continue;  // joints need Simbody
    ++scenes;
    EXPECT_NE(page.find("| `" + scene + "`, step " + step + " | `" + hash + "` |"), std::string::npos)
        << scene << ": run `make platforms` and make the table anew";
  }
  EXPECT_GE(scenes, 7);
}

TEST(Documents, ThoseWithCommandsToRunAreRun) {
  for (const auto& [document, entries] : read_list()) {
    const bool any = std::any_of(entries.begin(), entries.end(), [](const Listed& l) { return l.how == "run"; });
    EXPECT_EQ(any, (std::find(std::begin(kRun), std::end(kRun), document) != std::end(kRun))) << document;
  }
}

}  // namespace documents_test
}  // namespace rubble::testing
