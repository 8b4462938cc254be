// --sandbox: each kind of file that a mission, a pack, a robot or a mesh can name, from outside the folder.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>

#include "app/assets/asset_library.h"
#include "app/robots/mission_robot.h"
#include "io/image/image_file.h"
#include "kernel/base/system/file_sandbox.h"
#include "scripting/mission.h"
#include "tests/app/program.h"
#include "tests/app/tiny_run.h"

namespace rubble::testing {
namespace sandbox_mission_test {

namespace fs = std::filesystem;

// Everything that a mission is resolved to; the message where it is refused.
std::string load(const std::string& script) {
  try {
    const Mission mission = load_mission(script);
    const AssetLibrary assets = load_assets(mission, {});
    MeshImporter importer;
    for (const RobotItem& robot : mission.scenario.robots)
      make_mission_robot(robot, {fs::path(script).parent_path().string()}, "robots[1]", importer);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

const char* const kBlock = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";

// A tetrahedron as the buffer of kGltf: four corners, twelve indices.
std::string gltf_buffer() {
  const float corners[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  const std::uint16_t indices[] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};
  return std::string(reinterpret_cast<const char*>(corners), sizeof corners) +
         std::string(reinterpret_cast<const char*>(indices), sizeof indices);
}

std::string gltf(const std::string& buffer, const std::string& image) {
  return R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
"materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
"textures": [{"source": 0}], "images": [{"uri": ")" + image + R"("}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1]},
  {"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"}],
"bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 24}],
"buffers": [{"byteLength": 72, "uri": ")" + buffer + R"("}]})";
}

std::string pack_of(const std::string& keys) {
  return "return pack { name = 'p', assets = {\n  { name = 'thing', " + keys + ", material = 'timber' } } }\n";
}

std::string robot_of(const std::string& mesh) {
  return "<robot name=\"r\">\n<link name=\"base\"><inertial><mass value=\"1\"/>\n<inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" "
         "iyz=\"0\" izz=\"1\"/></inertial>\n<collision><geometry><mesh filename=\"" + mesh + "\"/></geometry></collision></link></robot>\n";
}

const std::string kNothing = "pile = { layers = 0 }";
const std::string kThing =
    "packs = { 'pack' }, pile = { layers = 0, placed = { { asset = 'thing', position = { 0, 0, 1 }, fixed = true } } }";
const std::string kRobot = kNothing + ", robots = { { name = 'r', urdf = 'robot.urdf' } }";

std::string mission_of(const std::string& keys, const std::string& before = "") {
  return before + "return rubble.mission {\n" + keys + ",\n}\n";
}

// One way to name a file. `$` in a text stands for the file.
struct Kind {
  std::string name;
  std::string secret;                        // name of the file
  std::string naming;                        // the file that names it, in the sandbox
  std::map<std::string, std::string> files;  // of the sandbox, with their texts
  std::string where;                         // of the refusal
  bool links_only = false;                   // other ways are refused without a sandbox as well
  std::string always{};                      // what a link is refused for without a sandbox; empty: it is not
};

std::vector<Kind> all_kinds() {
  const std::string thing = mission_of(kThing), beside = "leads out of the script's folder";
  return {
      {"mesh of a pack", "block.obj", "pack/pack.lua", {{"m.lua", thing}, {"pack/pack.lua", pack_of("mesh = '$'")}}, "pack.lua:2: assets[1].mesh"},
      {"parts of a pack", "block.obj", "pack/pack.lua",
       {{"m.lua", thing}, {"pack/pack.lua", pack_of("mesh = 'm.obj', collision = { parts = '$' }")}, {"pack/m.obj", kBlock}},
       "pack.lua:2: assets[1].collision.parts"},
      {"colours of an OBJ", "a.mtl", "pack/m.obj",
       {{"m.lua", thing}, {"pack/pack.lua", pack_of("mesh = 'm.obj'")}, {"pack/m.obj", std::string("mtllib $\nusemtl a\n") + kBlock}},
       "m.obj: mtllib"},
      {"picture of an MTL", "a.png", "pack/m.mtl",
       {{"m.lua", thing}, {"pack/pack.lua", pack_of("mesh = 'm.obj'")}, {"pack/m.obj", std::string("mtllib m.mtl\nusemtl a\n") + kBlock},
        {"pack/m.mtl", "newmtl a\nmap_Kd $\n"}},
       "m.obj: the image"},
      {"buffer of a glTF", "a.bin", "pack/m.gltf",
       {{"m.lua", thing}, {"pack/pack.lua", pack_of("mesh = 'm.gltf'")}, {"pack/m.gltf", gltf("$", "none.png")}}, "m.gltf: buffers[0].uri"},
      {"picture of a glTF", "a.png", "pack/m.gltf",
       {{"m.lua", thing}, {"pack/pack.lua", pack_of("mesh = 'm.gltf'")}, {"pack/m.gltf", gltf("own.bin", "$")}, {"pack/own.bin", gltf_buffer()}},
       "m.gltf: the image"},
      {"object of a LightWave scene, by assimp", "block.obj", "pack/m.lws",
       {{"m.lua", thing}, {"pack/pack.lua", pack_of("mesh = 'm.lws'")},
        {"pack/m.lws", "LWSC\n3\n\nFirstFrame 0\nLastFrame 1\nFramesPerSecond 25\n\nLoadObjectLayer 1 $\nShowObject 8 7\n"}},
       "m.lws"},
      {"terrain", "block.obj", "m.lua", {{"m.lua", mission_of("pile = { layers = 0, terrain = {\nfile = '$' } }")}}, "m.lua:3: pile.terrain.file"},
      {"robot", "robot.urdf", "m.lua",
       {{"m.lua", mission_of(kNothing + ",\nrobots = { { name = 'r',\nurdf = '$' } }")}}, "m.lua:4: robots[1].urdf"},
      {"mesh of a robot", "block.obj", "robot.urdf", {{"m.lua", mission_of(kRobot)}, {"robot.urdf", robot_of("$")}}, "robot.urdf:4"},
      {"mesh of a robot by URI", "block.obj", "robot.urdf", {{"m.lua", mission_of(kRobot)}, {"robot.urdf", robot_of("file://$")}}, "robot.urdf:4"},
      {"pack", "pack.lua", "m.lua",
       {{"m.lua", mission_of("packs = {\n'$' }, pile = { layers = 0 }")}}, "m.lua:3: packs[1]"},
      {"text that is included", "a.lua", "m.lua", {{"m.lua", mission_of(kNothing, "rubble.include('$')\n")}}, "m.lua:1", true, beside},
      {"picture of a script", "a.png", "m.lua", {{"m.lua", mission_of(kNothing, "\nrubble.read_image('$')\n")}}, "m.lua:2", true, beside},
      {"table", "a.csv", "m.lua", {{"m.lua", mission_of(kNothing, "rubble.read_table('$')\n")}}, "m.lua:1", true, beside},
      {"trajectory", "a.tum", "m.lua", {{"m.lua", mission_of(kNothing, "rubble.read_trajectory('$', {})\n")}}, "m.lua:1", true, beside},
      {"accelerogram", "a.AT2", "m.lua", {{"m.lua", mission_of(kNothing, "rubble.read_accelerogram('$')\n")}}, "m.lua:1", true, beside},
      {"calibration", "a.yaml", "m.lua", {{"m.lua", mission_of(kNothing, "rubble.read_calibration('$')\n")}}, "m.lua:1", true, beside},
      {"the mission itself", "m2.lua", "m.lua", {{"m.lua", "$"}}, "m.lua", true},
  };
}

const std::map<std::string, std::string>& secrets() {
  static const std::map<std::string, std::string> all{
      {"block.obj", kBlock},
      {"a.mtl", "newmtl a\nKd 1 0 0\n"},
      {"a.bin", gltf_buffer()},
      {"robot.urdf", "<robot name=\"r\"><link name=\"base\"><inertial><mass value=\"1\"/><inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" "
                     "iyy=\"1\" iyz=\"0\" izz=\"1\"/></inertial><collision><geometry><box size=\"1 1 1\"/></geometry></collision></link></robot>"},
      {"pack.lua", "return pack { name = 'q', assets = { { name = 'thing', mesh = 'block.obj', material = 'timber' } } }\n"},
      {"a.lua", "return 1\n"},
      {"a.csv", "1 2\n3 4\n"},
      {"a.tum", "0 0 0 1 0 0 0 1\n1 1 0 1 0 0 0 1\n"},
      {"a.AT2", "PEER NGA STRONG MOTION DATABASE RECORD\nX\nACCELERATION TIME SERIES IN UNITS OF G\nNPTS=  5, DT= .0100 SEC\n"
                "0.0 0.1 0.2 0.1 0.0\n"},
      {"a.yaml", "camera_matrix: { rows: 3, cols: 3, data: [100, 0, 50, 0, 100, 50, 0, 0, 1] }\nimage_width: 100\nimage_height: 100\n"
                 "distortion_coefficients: { rows: 1, cols: 5, data: [0, 0, 0, 0, 0] }\n"},
      {"m2.lua", "return rubble.mission { pile = { layers = 0 } }\n"},
  };
  return all;
}

class SandboxMission : public ::testing::Test {
 protected:
  SandboxMission() : root_(fs::canonical(scratch_.path())) {
    for (const char* folder : {"in/pack", "out"}) fs::create_directories(root_ / folder);
    for (const auto& [name, text] : secrets()) write_file(root_ / "out" / name, text);
    write_png(root_ / "out/a.png", RgbImage{1, 1, {9, 9, 9}});
  }
  ~SandboxMission() override { leave_sandbox(); }

  // The sandbox as the kind has it, with the name of the file.
  void lay(const Kind& kind, const std::string& name) {
    fs::remove_all(root_ / "in");
    fs::create_directories(root_ / "in/pack");
    for (const auto& [file, text] : kind.files) {
      std::string filled = text;
      const std::size_t at = filled.find('$');
      if (at != std::string::npos) filled.replace(at, 1, name);
      if (filled != name) write_file(root_ / "in" / file, filled);
    }
  }

  static void expect_read(const Kind& kind, const std::string& script, const std::string& name) {
    const std::string message = load(script);
    if (kind.always.empty())
      EXPECT_EQ(message, "") << "by " << name;
    else
      EXPECT_IN(kind.always, message);
  }

  // In the sandbox; wide: and neither without one nor in a wider one.
  void expect_refused(const Kind& kind, const std::string& name, bool wide = true) {
    const std::string script = (root_ / "in/m.lua").string();
    if (wide) expect_read(kind, script, name);
    enter_sandbox_of_missions((root_ / "in").string());
    const std::string message = load(script);
    EXPECT_IN("lies outside the sandbox", message) << name;
    EXPECT_IN("expected a file below \"" + (root_ / "in").string() + "\"", message);
    EXPECT_IN((root_ / "out").string(), message);
    EXPECT_IN("leave --sandbox out if you trust", message);
    EXPECT_IN(kind.where, message);
    if (wide) {
      enter_sandbox_of_missions(root_.string());
      expect_read(kind, script, name);
    }
    leave_sandbox();
  }

  ScratchFolder scratch_;
  fs::path root_;
};

TEST_F(SandboxMission, HoldsEveryKindOfFile) {
  for (const Kind& kind : all_kinds()) {
    SCOPED_TRACE(kind.name);
    const fs::path secret = root_ / "out" / (kind.secret == "pack.lua" ? "" : kind.secret);
    const fs::path folder = (root_ / "in" / kind.naming).parent_path();
    if (!kind.links_only) {
      const std::string relative = fs::relative(secret, folder).string();
      if (kind.name != "mesh of a robot by URI") lay(kind, relative), expect_refused(kind, relative, false);
      lay(kind, secret.string()), expect_refused(kind, secret.string(), kind.name == "mesh of a robot by URI");
    }
    if (kind.name == "mesh of a robot by URI") continue;
    const std::string link = kind.secret == "pack.lua" ? "link" : "link" + secret.extension().string();
    lay(kind, link);
    const bool script_itself = kind.files.at("m.lua") == "$";
    fs::create_symlink(secret, script_itself ? root_ / "in/m.lua" : folder / link);
    expect_refused(kind, link);
  }
}

TEST_F(SandboxMission, LooksForMeshesOfRobotsInPackagesToo) {
  fs::create_directories(root_ / "out/ws/arm/meshes");
  write_file(root_ / "out/ws/arm/meshes/block.obj", kBlock);
  write_file(root_ / "in/m.lua", mission_of(kRobot));
  write_file(root_ / "in/robot.urdf", robot_of("package://arm/meshes/block.obj"));
  setenv("ROS_PACKAGE_PATH", (root_ / "out/ws").c_str(), 1);
  expect_refused({"", "", "", {}, "robot.urdf:4", false}, "package://");
  unsetenv("ROS_PACKAGE_PATH");
  fs::create_directories(root_ / "arm/meshes");  // above the sandbox
  write_file(root_ / "arm/meshes/block.obj", kBlock);
  enter_sandbox_of_missions((root_ / "in").string());
  EXPECT_IN("lies outside the sandbox", load((root_ / "in/m.lua").string()));
  fs::create_directories(root_ / "in/arm/meshes");
  write_file(root_ / "in/arm/meshes/block.obj", kBlock);
  EXPECT_EQ(load((root_ / "in/m.lua").string()), "");
}

// The tool that expands it is another program, which reads what it likes.
TEST_F(SandboxMission, CallsNoXacro) {
  write_file(root_ / "in/m.lua", mission_of(kNothing + ", robots = { { name = 'r', urdf = 'a.xacro' } }"));
  write_file(root_ / "in/a.xacro", "<robot name=\"r\" xmlns:xacro=\"http://www.ros.org/wiki/xacro\">\n<xacro:include filename=\"b\"/></robot>\n");
  enter_sandbox_of_missions((root_ / "in").string());
  EXPECT_IN("a.xacro:2: <xacro:include> of xacro is not expanded in a sandbox", load((root_ / "in/m.lua").string()));
}

// A run, what is made of it, and who starts runs.
TEST_F(SandboxMission, HoldsForCommands) {
  const std::string in = (root_ / "in").string(), box = " --sandbox " + in, out = (root_ / "results").string();
  write_file(in + "/m.lua", kTinyMission);
  write_file(in + "/pack/pack.lua", pack_of("mesh = 'block.obj'"));
  write_file(in + "/pack/block.obj", kBlock);
  const Outcome run = run_rubble("settle " + in + "/m.lua --quiet --out " + out + "/run" + box);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run_rubble("verify " + out + "/run --pile-only" + box).exit_code, 0);
  EXPECT_EQ(run_rubble("info " + out + "/run" + box).exit_code, 0);
  EXPECT_EQ(run_rubble("remake " + out + "/run --quiet --out " + out + "/again" + box).exit_code, 0);
  EXPECT_EQ(run_rubble("export " + out + "/run --format stl" + box).exit_code, 0);
  EXPECT_EQ(run_rubble("assets check " + in + "/pack" + box).exit_code, 0);

  // From outside.
  write_file(root_ / "out/m.lua", kTinyMission);
  fs::create_directory(root_ / "out/pack");
  fs::copy(in + "/pack", root_ / "out/pack", fs::copy_options::recursive);
  write_file(in + "/far.lua", mission_of("packs = { '../out/pack' }, pile = { layers = 0, placed = {\n{ asset = 'thing', position = { 0, 0, 1 }, "
                                         "fixed = true } } }"));
  const std::string far = in + "/far.lua";
  EXPECT_EQ(run_rubble("settle " + far + " --quiet --out " + out + "/far").exit_code, 0);
  write_file(in + "/suite.lua", "return suite { runs = { { name = 'a', mission = 'far.lua', pile_only = true } } }\n");
  for (const std::string& command :
       {"check " + far, "run " + far + " --out " + out + "/no", "settle " + far + " --out " + out + "/no",
        "batch " + far + " --seeds 1 --pile-only --out " + out + "/no", "remake " + out + "/far --out " + out + "/no",
        "check " + (root_ / "out/m.lua").string(), "render " + out + "/run --mission " + (root_ / "out/m.lua").string() + " --out " + out + "/no",
        "assets check " + (root_ / "out/pack").string(), "run " + in + "/m.lua --assets " + (root_ / "out/pack").string() + " --out " + out + "/no"}) {
    const Outcome refused = run_rubble(command + box);
    EXPECT_EQ(refused.exit_code, 1) << command;
    EXPECT_IN("lies outside the sandbox", refused.err) << command;
    EXPECT_FALSE(fs::exists(out + "/no/manifest.json")) << command;
  }
  const Outcome suite = run_rubble("suite " + in + "/suite.lua --out " + out + "/suite" + box);
  EXPECT_EQ(suite.exit_code, 5) << suite.out << suite.err;
  EXPECT_IN("lies outside the sandbox", read_file(out + "/suite/a.log"));
}

}  // namespace sandbox_mission_test
}  // namespace rubble::testing
