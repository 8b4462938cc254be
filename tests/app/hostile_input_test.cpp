// Inputs that crashed the program, took all memory or never ended: each is now an error, exit code 1,
// that names the file.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <nlohmann/json.hpp>

#include "tests/app/program.h"

namespace rubble::testing {
namespace hostile_input_test {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::string repeated(const std::string& text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

class HostileInput : public ::testing::Test {
 protected:
  void expect_refused(const std::string& arguments, const std::string& words) {
    const Outcome outcome = run_rubble(arguments, "ulimit -c 0; timeout 60");
    EXPECT_EQ(outcome.exit_code, 1) << arguments << "\n" << outcome.err.substr(0, 1000);
    EXPECT_TRUE(contains(outcome.err, words)) << arguments << "\n" << outcome.err.substr(0, 1000);
  }
  std::string script(const std::string& text) {
    write_file(scratch_ / "m.lua", text);
    return scratch_ / "m.lua";
  }

  const ScratchFolder scratch_;
};

TEST_F(HostileInput, AMissionWithAMeshThatCrashesTheImporter) {
  std::filesystem::create_directory(scratch_ / "p");
  write_file(scratch_ / "p/pack.lua",
             "return pack { name = 'p', assets = { { name = 'a', mesh = 'a.obj', collision = "
             "'hull', material = 'brick' } } }\n");
  write_file(scratch_ / "p/a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\n");
  expect_refused("check " + script("return rubble.mission { packs = { 'p' } }"), "p/a.obj: ");
}

TEST_F(HostileInput, ManifestsNestedTooDeep) {
  write_file(scratch_ / "manifest.json",
             "{\"format\": \"rubble manifest 2\", \"seals\": " + repeated("[", 20000) +
                 repeated("]", 20000) + "}");
  expect_refused("info " + scratch_.path().string(), "manifest.json: nested too deep");
  expect_refused("export " + scratch_.path().string(), "manifest.json: nested too deep");
}

TEST_F(HostileInput, ManifestsWithNumbersThatDoNotFit) {
  write_file(scratch_ / "manifest.json", "{\"format\": 1e999}");
  expect_refused("info " + scratch_.path().string(), "a number in it is too large");
}

TEST_F(HostileInput, ScriptsThatAreNotText) {
  expect_refused("check " + script("-- caf\xe9\nreturn rubble.mission {}"),
                 "m.lua:1: is not UTF-8 text: expected UTF-8, found the byte 0xe9");
  expect_refused("run " + script("\n-- caf\xe9\nreturn rubble.mission {}") + " --out " +
                     (scratch_ / "out"),
                 "m.lua:2: is not UTF-8 text");
  expect_refused("check " + script(kTinyMission) + " --set pile.mix[1].asset='caf\xe9'",
                 "not UTF-8");
}

TEST_F(HostileInput, FilesWithoutAnEnd) {
  expect_refused("check /dev/zero", "/dev/zero: is a device");
  expect_refused("info /dev/zero", "/dev/zero: cannot be inspected");
  ASSERT_EQ(mkfifo((scratch_ / "pipe").c_str(), 0600), 0);
  expect_refused("info " + (scratch_ / "pipe"), "pipe: cannot be inspected");
  expect_refused("check " + (scratch_ / "pipe"), "pipe: is a pipe that nobody writes to");
  expect_refused("eval trajectory " + (scratch_ / "pipe") + " " + (scratch_ / "pipe"), "pipe: ");
}

TEST_F(HostileInput, NothingOfAScriptSteersTheTerminal) {
  const std::string path = script(
      "print('\x1b]0;owned\x07')\nreturn rubble.mission { ['cam\x1b[2Jera'] = 1, camera = { width = "
      "'\x1b[31m' } }\n");
  const Outcome check = run_rubble("check " + path);
  EXPECT_EQ(check.exit_code, 1);
  EXPECT_FALSE(contains(check.err, "\x1b")) << check.err;
  EXPECT_FALSE(contains(check.err, "\x07")) << check.err;
  EXPECT_TRUE(contains(check.err, "cam\\x1b[2Jera")) << check.err;
  const Outcome sound = run_rubble("check " + script("print('\x1b]0;owned\x07')\n" +
                                                     std::string(kTinyMission)));
  EXPECT_EQ(sound.exit_code, 0) << sound.err;
  EXPECT_TRUE(contains(sound.err, "\\x1b]0;owned\\x07")) << sound.err;
}

}  // namespace hostile_input_test
}  // namespace rubble::testing
