// The files of robots that are no bundled ones: in the provenance by their hash, and compared when a run is made again.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/assets/asset_library.h"
#include "tests/app/program.h"

namespace rubble::testing {
namespace robot_content_test {

std::string urdf_of(const std::string& mass) {
  return "<robot name=\"r\"><link name=\"base\"><inertial><mass value=\"" + mass +
         "\"/><inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"1\"/></inertial><collision><geometry>"
         "<mesh filename=\"part.stl\"/></geometry></collision></link></robot>";
}

constexpr const char* kMesh =
    "solid s\nfacet normal 0 0 -1\nouter loop\nvertex 0 0 0\nvertex 0 1 0\nvertex 1 0 0\nendloop\nendfacet\nendsolid s\n";

class RobotContents : public ::testing::Test {
 protected:
  RobotContents() {
    write_file(folder_ / "r.urdf", urdf_of("1"));
    write_file(folder_ / "part.stl", kMesh);
    scenario_.robots.resize(2);
    scenario_.robots[1].urdf = "r.urdf";
    made_.scenario = scenario_to_json(scenario_);
    AssetLibrary library;
    add_robot_files(scenario_.robots, {folder_.path().string()}, library);
    made_.robots = library.robots;
  }

  // Empty: the files are those that the provenance names.
  std::string recall(const Provenance& provenance) const {
    AssetLibrary library;
    try {
      recall_robots(provenance, {folder_.path().string()}, library);
      return library.robot_files.at(1) == folder_ / "r.urdf" && library.robot_files[0].empty() ? "" : "another file";
    } catch (const InputError& error) {
      return error.what();
    }
  }

  ScratchFolder folder_;
  Scenario scenario_;
  Provenance made_;
};

TEST_F(RobotContents, AreFoundAgain) {
  ASSERT_EQ(made_.robots.size(), 1u);
  EXPECT_EQ(made_.robots[0].urdf, "r.urdf");
  EXPECT_EQ(made_.robots[0].sha256.size(), 64u);
  EXPECT_EQ(recall(made_), "");
}

TEST_F(RobotContents, AnotherUrdfFileOrMeshIsNamed) {
  write_file(folder_ / "r.urdf", urdf_of("3"));
  EXPECT_NE(recall(made_).find("the URDF file \"r.urdf\" or one of its meshes has changed"), std::string::npos) << recall(made_);
  write_file(folder_ / "r.urdf", urdf_of("1"));
  write_file(folder_ / "part.stl", std::string(kMesh) + "\n");
  EXPECT_NE(recall(made_).find("has changed"), std::string::npos) << recall(made_);
  std::filesystem::remove(folder_ / "r.urdf");
  EXPECT_NE(recall(made_).find("robots[2].urdf: no such file"), std::string::npos) << recall(made_);
}

TEST_F(RobotContents, StayInTheManifest) {
  nlohmann::ordered_json json;
  made_.script = {"m.lua", "", std::string(64, '0')};
  made_.scenario = nlohmann::ordered_json::parse(made_.scenario).dump();
  add_provenance(json, made_);
  const Provenance back = provenance_from_json(json, "manifest.json");
  ASSERT_EQ(back.robots.size(), 1u);
  EXPECT_EQ(back.robots[0].sha256, made_.robots[0].sha256);
  made_.robots.clear();
  nlohmann::ordered_json without;
  add_provenance(without, made_);
  EXPECT_FALSE(without.contains("robots")) << "a manifest without URDF files is as it was";
}

}  // namespace robot_content_test
}  // namespace rubble::testing
