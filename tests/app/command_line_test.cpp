// Bad input and the small commands: wording, places and exit codes.
#include <gtest/gtest.h>

#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "tests/app/program.h"

namespace rubble::testing {
namespace command_line_test {

// Runs `check` on a script with this text.
Outcome check_text(const std::string& text, const std::string& options = "") {
  const ScratchFolder scratch;
  write_file(scratch / "m.lua", text);
  return run_rubble("check " + (scratch / "m.lua") + " " + options);
}

TEST(Check, PrintsTheCompleteScenario) {
  const Outcome check = run_rubble("check scripts/first_pile.lua --seed 5 --set fogdensity=0.25");
  ASSERT_EQ(check.exit_code, 0) << check.err;
  const auto scenario = nlohmann::json::parse(check.out);
  EXPECT_EQ(scenario.at("seed"), 5);
  EXPECT_EQ(scenario.at("air").at("fog_density"), 0.25);
  EXPECT_TRUE(scenario.contains("trajectory"));
}

TEST(Check, NamesFileLineKeyExpectedAndFoundOfEveryMistake) {
  const Outcome check = check_text(
      "return rubble.mission {\n"
      "  lamps = {},\n"
      "  camera = { width = \"wide\",\n"
      "             height = -5 },\n"
      "}\n");
  EXPECT_EQ(check.exit_code, 1);
  EXPECT_NE(check.err.find("m.lua:2: lamps: unknown key"), std::string::npos) << check.err;
  EXPECT_NE(check.err.find("did you mean `lamp`"), std::string::npos) << check.err;
  EXPECT_NE(check.err.find("m.lua:3: camera.width: "), std::string::npos) << check.err;
  EXPECT_NE(check.err.find("\"wide\""), std::string::npos) << check.err;
  EXPECT_NE(check.err.find("m.lua:4: camera.height: "), std::string::npos) << check.err;
}

TEST(Check, NamesFileAndLineOfLuaErrors) {
  const Outcome syntax = check_text("return rubble.mission {\n  seed = = 1\n}\n");
  EXPECT_EQ(syntax.exit_code, 1);
  EXPECT_NE(syntax.err.find("m.lua:2:"), std::string::npos) << syntax.err;
  const Outcome runtime = check_text("local x = nil\nlocal y = x.z\n");
  EXPECT_EQ(runtime.exit_code, 1);
  EXPECT_NE(runtime.err.find("m.lua:2:"), std::string::npos) << runtime.err;
}

// The message names the path and the reason, without the words of std::filesystem.
TEST(Files, ThatCannotBeReachedAreNamedWithTheReason) {
  const ScratchFolder scratch;
  std::filesystem::create_symlink("loop", scratch / "loop");
  const std::string path = scratch / "loop";
  for (const std::string& command : {"report " + path, "eval sfm " + path + " " + path}) {
    const Outcome run = run_rubble(command);
    EXPECT_NE(run.exit_code, 0) << command;
    EXPECT_NE(run.err.find("Too many levels of symbolic links"), std::string::npos) << command << "\n" << run.err;
    EXPECT_NE(run.err.find(path), std::string::npos) << command << "\n" << run.err;
    EXPECT_EQ(run.err.find("filesystem error"), std::string::npos) << command << "\n" << run.err;
  }
}

// The first thing a newcomer copies.
TEST(Check, AcceptsTheMissionOfTheReadme) {
  const std::string readme = read_file(RUBBLE_SOURCE_DIR "/README.md");
  const std::size_t begin = readme.find("```lua\n") + 7, end = readme.find("```", begin);
  ASSERT_NE(end, std::string::npos);
  const Outcome check = check_text(readme.substr(begin, end - begin));
  EXPECT_EQ(check.exit_code, 0) << check.err;
}

TEST(Check, PrintsASchemaOfEveryKey) {
  const Outcome check = run_rubble("check --schema");
  ASSERT_EQ(check.exit_code, 0) << check.err;
  const auto schema = nlohmann::json::parse(check.out);
  EXPECT_EQ(schema.at("title"), "Rubble mission");
  EXPECT_TRUE(schema.at("properties").contains("trajectory"));
  EXPECT_EQ(run_rubble("check").exit_code, 1) << "a mission is needed otherwise";
}

// Two boxes of 2 kg, the second on a mount that is turned by 90 degrees and on a hinge.
TEST(Check, PrintsFiguresOfRobots) {
  const ScratchFolder scratch;
  const std::string solid =
      "<inertial><mass value=\"2\"/><inertia ixx=\"0.1\" iyy=\"0.2\" izz=\"0.25\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/>"
      "</inertial><collision><geometry><box size=\"1 0.4 0.2\"/></geometry></collision>"
      "<visual><geometry><box size=\"1.2 0.4 0.2\"/></geometry></visual></link>";
  write_file(scratch / "r.urdf",
             "<robot name=\"r\"><link name=\"base_link\">" + solid + "<link name=\"mount\"/><link name=\"arm\">" + solid +
                 "<joint name=\"weld\" type=\"fixed\"><parent link=\"base_link\"/><child link=\"mount\"/>"
                 "<origin xyz=\"3 0 0\" rpy=\"0 0 1.5707963267948966\"/></joint>"
                 "<joint name=\"hinge\" type=\"revolute\"><parent link=\"mount\"/><child link=\"arm\"/>"
                 "<origin xyz=\"1 0 0\"/><axis xyz=\"0 0 1\"/>"
                 "<limit lower=\"-1\" upper=\"2\" effort=\"5\" velocity=\"3\"/></joint></robot>");
  write_file(scratch / "m.lua",
             "return rubble.mission { robots = { { urdf = \"r.urdf\", name = \"r\", position = { 0, 0, 9 } } } }");
  const Outcome check = run_rubble("check " + (scratch / "m.lua") + " --robots");
  ASSERT_EQ(check.exit_code, 0) << check.err;
  const auto robot = nlohmann::json::parse(check.out).at(0);
  const auto expect_near = [&robot](const char* key, const std::vector<double>& expected) {
    std::vector<double> found;
    const nlohmann::json flat = robot.at(key).flatten();  // a range of its items only refers to it
    for (const auto& [path, number] : flat.items()) found.push_back(number);
    ASSERT_EQ(found.size(), expected.size()) << key;
    for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(found[i], expected[i], 1e-6) << key << " " << i;
  };
  EXPECT_NEAR(robot.at("mass_kg").get<double>(), 4, 1e-12);
  expect_near("centre_of_mass_m", {1.5, 0.5, 0});
  // The arm's axes are swapped, and both are (1.5, 0.5) off the centre.
  expect_near("inertia_kg_m2", {0.3 + 4 * 0.25, 0.3 + 4 * 2.25, 0.5 + 4 * 2.5, -4 * 0.75, 0, 0});
  expect_near("collision_bounds_m", {-0.5, -0.2, -0.1, 3.2, 1.5, 0.1});
  expect_near("visual_bounds_m", {-0.6, -0.2, -0.1, 3.2, 1.6, 0.1});
  ASSERT_EQ(robot.at("joints").size(), 1u);
  EXPECT_EQ(robot.at("joints")[0].at("name"), "hinge");
  EXPECT_EQ(robot.at("joints")[0].at("upper"), 2);
  EXPECT_EQ(robot.at("links").size(), 2u);
}

TEST(Check, NamesAnUnknownAsset) {
  const Outcome check = check_text(
      "return rubble.mission {\n"
      "  pile = { mix = { { asset = \"brik\" } } },\n"
      "}\n");
  EXPECT_EQ(check.exit_code, 1);
  EXPECT_NE(check.err.find("m.lua:2: "), std::string::npos) << check.err;
  EXPECT_NE(check.err.find("did you mean `brick`"), std::string::npos) << check.err;
}

TEST(CommandLine, RefusesWhatItDoesNotKnow) {
  EXPECT_EQ(run_rubble("").exit_code, 1);
  EXPECT_EQ(run_rubble("fly").exit_code, 1);
  EXPECT_EQ(run_rubble("check scripts/first_pile.lua --sed 3").exit_code, 1);
  EXPECT_EQ(run_rubble("check no/such/mission.lua").exit_code, 1);
  const Outcome key = run_rubble("check scripts/first_pile.lua --set pile.layer=3");
  EXPECT_EQ(key.exit_code, 1);
  EXPECT_NE(key.err.find("did you mean `pile.layers`"), std::string::npos) << key.err;
}

TEST(CommandLine, SaysWhatIsWrongWithASeed) {
  for (const char* seed : {"-1", "1e3", "99999999999999999999", "18446744073709551615"}) {
    const Outcome outcome = run_rubble("check scripts/small.lua --seed " + std::string(seed));
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_NE(outcome.err.find("--seed: expected a whole number"), std::string::npos) << outcome.err;
    EXPECT_EQ(outcome.err.find("small.lua"), std::string::npos) << outcome.err;
  }
  EXPECT_EQ(run_rubble("check scripts/small.lua --seed 9223372036854775807").exit_code, 0);
}

// Where the command states a range, and where it states none; before anything is read.
TEST(CommandLine, TakesNoNumberThatIsNoneOrOutOfRange) {
  const std::pair<const char*, const char*> mistakes[] = {
      {"cutaway none --y nan", "--y: expected a finite number, found nan"},
      {"cutaway none --y 1001", "--y: expected a number from -1000 to 1000, found 1001"},
      {"eval trajectory a b --max-difference nan", "--max-difference: expected a finite number, found nan"},
      {"eval trajectory a b --max-difference -1", "--max-difference: expected a number of at least 0, found -1"},
      {"eval trajectory a b --segments 5,0", "--segments: expected a number above 0, found 0"},
      {"eval trajectory a b --segments 5,inf", "--segments: expected a finite number, found inf"},
      {"settle none --checkpoint-every 1e999", "--checkpoint-every: expected a finite number, found 1e999"},
      {"voids none --radius nan", "--radius: expected a finite number, found nan"},
      {"voids none --outside-radius nan", "--outside-radius: expected a finite number, found nan"},
      {"voids none --outside-radius -1", "--outside-radius: expected a number from 0.2 to 10, found -1"},
      {"voids none --outside-radius 0.1", "--outside-radius: expected a number from 0.2 to 10, found 0.1"},
      {"voids none --voxel 0", "--voxel: expected a number from 0.001 to 1, found 0"},
      {"voids none --memory 0", "--memory: expected a number above 0, found 0"},
      {"eval map none none --outside-radius -1", "--outside-radius: expected a number from 0.2 to 10, found -1"},
      {"eval map none none --memory -4", "--memory: expected a number above 0, found -4"}};
  for (const auto& [command, message] : mistakes) {
    const Outcome refused = run_rubble(command);
    EXPECT_EQ(refused.exit_code, 1) << command;
    EXPECT_NE(refused.err.find(message), std::string::npos) << command << "\n" << refused.err;
  }
}

TEST(CommandLine, KnowsWhatWasMeant) {
  const Outcome command = run_rubble("rn scripts/small.lua");
  EXPECT_EQ(command.exit_code, 1);
  EXPECT_NE(command.err.find("`rn` (did you mean `run`?)"), std::string::npos) << command.err;
  const Outcome mode = check_text("return rubble.mission {\n  pile = rubble.collapse.leanto {} }");
  EXPECT_EQ(mode.exit_code, 1);
  EXPECT_NE(mode.err.find("m.lua:2: "), std::string::npos) << mode.err;
  EXPECT_NE(mode.err.find("did you mean `rubble.collapse.lean_to`?"), std::string::npos) << mode.err;
}

TEST(CommandLine, TakesHelpAsAWord) {
  const Outcome all = run_rubble("help"), one = run_rubble("help eval map");
  EXPECT_EQ(all.exit_code, 0) << all.err;
  EXPECT_EQ(all.out, run_rubble("--help").out);
  EXPECT_EQ(one.exit_code, 0) << one.err;
  EXPECT_EQ(one.out, run_rubble("eval map --help").out);
  EXPECT_NE(one.out, all.out);
}

TEST(CommandLine, OffersAnOptionWhereItHasAnEffect) {
  std::set<std::string> settling, drawing;
  for (const char* command :
       {"run", "settle", "check", "info", "render", "export", "cutaway", "voids", "assets check", "assets show",
        "verify", "remake", "resume", "suite", "batch", "report", "view", "pack", "drive", "inspect", "eval trajectory",
        "eval sfm", "eval surface", "eval map", "bench search"}) {
    const std::string help = run_rubble(command + std::string(" --help")).out;
    EXPECT_NE(help.find("--help"), std::string::npos) << command;
    if (help.find("  --checkpoint-every ") != std::string::npos) settling.insert(command);
    if (help.find("  --device ") != std::string::npos) drawing.insert(command);
  }
  EXPECT_EQ(settling, (std::set<std::string>{"run", "settle", "resume", "remake"})) << "what settles and can be resumed";
  EXPECT_EQ(drawing, (std::set<std::string>{"run", "render", "resume", "verify", "remake", "drive", "cutaway", "batch", "suite",
                                            "inspect", "assets show", "info"}));
  const Outcome show = run_rubble("assets show concrete --device gl:42 --out /dev/null/none.png");
  EXPECT_EQ(show.exit_code, 2) << show.err;
  EXPECT_NE(show.err.find("there is no EGL device 42"), std::string::npos) << show.err;
}

// A command is a file with a function NAME_command(), and its name in RUBBLE_COMMANDS. A name without
// the file does not build; a file without the name is found here.
TEST(CommandLine, RefusesPacingOfWhatIsNotPublished) {
  for (const char* option : {"--rate fast", "--wait-for-subscribers 3"}) {
    const Outcome run = run_rubble(std::string("run scripts/small.lua ") + option);
    EXPECT_EQ(run.exit_code, 1) << option;
    EXPECT_NE(run.err.find("has no effect without --ros1 or --ros2"), std::string::npos) << run.err;
  }
}

TEST(CommandLine, SaysWhichSettingAnotherReplaces) {
  const Outcome check = run_rubble("check scripts/small.lua --set pile.layers=2 --set pile.pieces_per_layer=4 --set pile.layers=1");
  EXPECT_EQ(check.exit_code, 0) << check.err;
  EXPECT_NE(check.err.find("warning: --set: pile.layers=2 has no effect, because --set pile.layers=1 follows"), std::string::npos)
      << check.err;
  EXPECT_EQ(check.err.find("pile.pieces_per_layer"), std::string::npos) << check.err;
  const Outcome same = run_rubble("check scripts/small.lua --set pile.layers=1 --set pile.layers=1");
  EXPECT_EQ(same.err.find("has no effect"), std::string::npos) << same.err;
}

TEST(CommandLine, HasEveryCommandThatIsWritten) {
  const std::string cmake = read_file(RUBBLE_SOURCE_DIR "/app/CMakeLists.txt");
  const std::size_t begin = cmake.find("set(RUBBLE_COMMANDS"), end = cmake.find(')', begin);
  ASSERT_NE(end, std::string::npos);
  std::istringstream words(cmake.substr(begin, end - begin));
  const std::set<std::string> listed{std::istream_iterator<std::string>(words), {}};
  std::size_t written = 0;
  const std::filesystem::path commands = RUBBLE_SOURCE_DIR "/app/commands";
  for (const auto& file : std::filesystem::recursive_directory_iterator(commands)) {
    if (!file.is_regular_file()) continue;
    const std::string name = file.path().stem().string();
    const std::string path = std::filesystem::relative(file.path(), commands).replace_extension();
    const bool is_command = read_file(file.path().string()).find("Command " + name + "_command()") !=
                            std::string::npos;
    written += is_command;
    EXPECT_EQ(listed.count(path), is_command) << path << " and RUBBLE_COMMANDS do not agree";
  }
  EXPECT_EQ(written + 1, listed.size()) << "the word RUBBLE_COMMANDS is one of them";
  const Outcome help = run_rubble("eval map --help");
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_NE(help.out.find("Edge of a voxel (default: 0.05)"), std::string::npos) << help.out;
}

TEST(CommandLine, TheReferenceOfCommandsIsUpToDate) {
  const Outcome page = run_rubble("manual --markdown");
  EXPECT_EQ(page.exit_code, 0) << page.err;
  EXPECT_TRUE(page.out == read_file(RUBBLE_SOURCE_DIR "/docs/reference/commands.md"))
      << "run: cmake --build build/release --target command_reference";
  for (const char* part : {"## `rubble eval map`\n", "|`--voxel METRES`|Edge of a voxel (default: 0.05); 0.001..1.|", "`rubble run mission [OPTION] ...`",
                           "; 0..256.|", "|`4`|"})
    EXPECT_NE(page.out.find(part), std::string::npos) << part;
}

// What is printed is a result.
TEST(CommandLine, NoticesAStandardOutputThatTakesNothing) {
  for (const char* out : {">/dev/full", ">&-"}) {
    const ScratchFolder scratch;
    for (const char* command : {"check scripts/small.lua", "--help", "check --schema"}) {
      const Outcome outcome = run_rubble_to(command, out);
      EXPECT_EQ(outcome.exit_code, 2) << command << out;
      EXPECT_NE(outcome.err.find("cannot write to standard output"), std::string::npos)
          << outcome.err;
    }
    const Outcome settle = run_rubble_to("settle scripts/small.lua --out " + (scratch / "a"), out);
    EXPECT_EQ(settle.exit_code, 2) << settle.err;
    EXPECT_EQ(run_rubble("info " + (scratch / "a")).exit_code, 0) << "the run itself is whole";
  }
}

TEST(Info, NamesTheRendererAndTheLibraries) {
  const Outcome info = run_rubble("info");
  ASSERT_EQ(info.exit_code, 0) << info.err;
  for (const char* name : {"rubble", "software", "gl", "threads", "Simbody", "MRPT", "OpenCV"})
    EXPECT_NE(info.out.find(name), std::string::npos) << name << " in\n" << info.out;
}

TEST(Info, SaysWhatWasTriedWithoutAWorkingEgl) {
  const Outcome info = run_rubble("info --gl", "RUBBLE_DEVICE=gl:99");
  EXPECT_EQ(info.exit_code, 2);
  EXPECT_NE(info.err.find("RUBBLE_DEVICE=gl:N"), std::string::npos) << info.err;
}

TEST(CommandLine, AWrongNumberOfThreadsInTheEnvironmentIsNamed) {
  const ScratchFolder scratch;
  for (const char* wrong : {"two", "0", "1.5", ""}) {
    const Outcome run = run_rubble("settle scripts/small.lua --out " + (scratch / "a"), std::string("RUBBLE_THREADS='") + wrong + "'");
    EXPECT_EQ(run.exit_code, 1) << wrong;
    EXPECT_NE(run.err.find("RUBBLE_THREADS"), std::string::npos) << run.err;
  }
}

}  // namespace command_line_test
}  // namespace rubble::testing
