// tests/files/run_files.py, which `make test-files` runs: it must see what differs.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "tests/app/program.h"

namespace rubble::testing {
namespace {

class PublicFiles : public ::testing::Test {
 protected:
  // With a list of one mesh, a tetrahedron, and its expected volume.
  Outcome try_files(const std::string& volume, const std::string& environment) const {
    const std::filesystem::path lists = scratch_.path() / "lists", repository = scratch_.path() / "all/owner/name";
    std::filesystem::create_directories(lists);
    std::filesystem::create_directories(repository);
    write_file(repository / "t.obj",
               "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n" + text_after_);
    for (const char* empty : {"robots.json", "trajectories.json"}) write_file(lists / empty, "[]");
    write_file(lists / "meshes.json",
               "[{\"source\": \"repository:owner/name@0\", \"path\": \"t.obj\", \"sha256\": \"b391f08159e507ad\","
               " \"size_m\": [1, 1, 1], \"closed\": true, \"volume_m3\": " + volume + "}]");
    const std::string command = environment + " /usr/bin/python3 '" RUBBLE_SOURCE_DIR "/tests/files/run_files.py' '" RUBBLE_PROGRAM "' '" +
                                (scratch_ / "cache") + "' --lists '" + lists.string() + "' > '" + (scratch_ / "out") + "' 2>&1";
    const int status = std::system(command.c_str());
    return {WEXITSTATUS(status), read_file(scratch_ / "out"), ""};
  }
  std::string here() const { return "RUBBLE_FILES='" + (scratch_ / "all") + "'"; }

  ScratchFolder scratch_;
  std::string text_after_;
};

TEST_F(PublicFiles, ThatAreAsExpectedPass) {
  const Outcome tried = try_files("0.166667", here());
  EXPECT_EQ(tried.exit_code, 0) << tried.out;
  EXPECT_NE(tried.out.find("| meshes of repositories | 1 | 1 | 0 |"), std::string::npos) << tried.out;
}

TEST_F(PublicFiles, ThatDifferAreNamed) {
  const Outcome tried = try_files("0.2", here());
  EXPECT_EQ(tried.exit_code, 1);
  EXPECT_NE(tried.out.find("meshes: differs: repository:owner/name@0: t.obj"), std::string::npos) << tried.out;
  EXPECT_NE(tried.out.find("volume_m3 0.166667, expected 0.2"), std::string::npos) << tried.out;
}

TEST_F(PublicFiles, ThatAreNotThereAreSkipped) {
  EXPECT_NE(try_files("0.2", "RUBBLE_FILES=").out.find("SKIPPED"), std::string::npos);
  text_after_ = "# another version\n";
  EXPECT_NE(try_files("0.2", here()).out.find("SKIPPED"), std::string::npos);
}

// trimesh turns no COLLADA file to the axis that it states, and bends no skin.
TEST(PublicFilesJudge, TakesAxesAndSkinsAsTheFilesAskForThem) {
  const ScratchFolder scratch;
  write_file(scratch / "up.dae", "<COLLADA><asset><up_axis>Y_UP</up_axis></asset></COLLADA>");
  write_file(scratch / "z.dae", "<COLLADA><asset><up_axis>Z_UP</up_axis></asset></COLLADA>");
  write_file(scratch / "skin.gltf", "{\"skins\": [ {\"joints\": [0]} ]}");
  write_file(scratch / "plain.gltf", "{\"skins\": []}");
  write_file(scratch / "t.py",
             "import sys\nfrom pathlib import Path\nsys.path.insert(0, '" RUBBLE_SOURCE_DIR "/tests/files')\n"
             "from run_files import as_asked\n"
             "for name in 'up.dae', 'z.dae', 'skin.gltf', 'plain.gltf':\n"
             "    print(as_asked('meshes', {'size_m': [1, 2, 3]}, Path(sys.path[1], name)).get('size_m'))\n");
  const std::string command = "/usr/bin/python3 '" + (scratch / "t.py") + "' > '" + (scratch / "out") + "' 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0);
  EXPECT_EQ(read_file(scratch / "out"), "[1, 3, 2]\n[1, 2, 3]\nNone\n[1, 2, 3]\n");
}

}  // namespace
}  // namespace rubble::testing
