// The tables of formats against what a mission may ask for.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "app/formats/class_labels.h"
#include "app/formats/recording_formats.h"
#include "app/pipeline/recorders.h"
#include "app/provenance/earlier_files.h"
#include "io/scenes/pile_export.h"
#include "scripting/scenario/mission_form.h"

namespace rubble::testing {
namespace formats_test {

// Each row names the key that sets its member, and no other row the same.
TEST(Formats, HaveTheirKey) {
  MissionForm form;
  const Schema schema = make_scenario_schema(form);
  std::set<std::string> names, left;
  for (const RecordingFormat& format : recording_formats()) {
    const Key* const key = schema.find("outputs." + format.name);
    ASSERT_NE(key, nullptr) << format.name;
    for (const bool wanted : {true, false}) {
      form.rest.outputs.*format.wanted = wanted;
      EXPECT_EQ(read_slot(key->bind(0)).boolean, wanted) << format.name;
    }
    EXPECT_TRUE(names.insert(format.name).second) << format.name;
    EXPECT_TRUE(left.insert(format.leaves).second) << format.leaves;
  }
  EXPECT_GE(names.size(), 10u);
}

// `stl` has a key of its own.
TEST(Formats, MeshesAreThoseOfTheMission) {
  std::vector<std::string> names;
  for (const MeshFormat& format : mesh_formats())
    if (format.name != "stl") names.push_back(format.name);
  EXPECT_EQ(names, export_names());
}

// What a run leaves is what --force may remove.
TEST(Formats, LeaveNothingThatAnotherRunDoesNotKnow) {
  const std::vector<std::string>& usual = usual_run_files();
  EXPECT_EQ(usual.front(), "manifest.json");
  const auto is_known = [&](const std::string& name) {
    return std::find(usual.begin(), usual.end(), name) != usual.end();
  };
  for (const RecordingFormat& format : recording_formats())
    EXPECT_NE(is_known(format.leaves), format.is_folder) << format.leaves;
  for (const char* name : {"pile.bin", "pile.stl", "pile.obj", "pile.mtl", "mission.simplemap",
                           "labels.csv", "flight.json", "preview.png", "groundtruth.txt"})
    EXPECT_TRUE(is_known(name)) << name;
}

// A number is an index of the legend, whatever the mission has besides.
TEST(ClassLabels, AreIndicesOfTheLegend) {
  const std::vector<PieceType> types{PieceType{"brick", {}, {}, {}}, PieceType{"slab", {}, {}, {}}};
  EXPECT_EQ(ClassLabels({}, types).names(), (std::vector<std::string>{"sky", "ground", "brick", "slab"}));
  for (int what = 0; what < 8; ++what) {
    Scenario s;
    s.robots.resize(what & 1 ? 2 : 0);
    s.fines.amount = what & 2 ? 5 : 0;
    s.surroundings.type = what & 4 ? SurroundingsType::street : SurroundingsType::none;
    const ClassLabels labels(s, types);
    const std::vector<std::string>& names = labels.names();
    EXPECT_EQ(names.at(labels.of_type(1)), "slab");
    if (what & 1) {
      EXPECT_EQ(names.at(labels.of_robots()), "robot");
    }
    for (int k = 0; k < kFineKinds && (what & 2); ++k)
      EXPECT_EQ(names.at(labels.of(FineKind(k))), fine_names()[std::size_t(k)]);
    for (std::size_t k = 0; k < surrounding_names().size() && (what & 4); ++k)
      EXPECT_EQ(names.at(labels.of(SurroundingKind(k))), surrounding_names()[k]);
  }
}

// The number of a link follows those of the pieces; frames without a body have none.
TEST(ClassLabels, LegendsNameTheLinksOfRobots) {
  Scenario s;
  s.robots.resize(1);
  AssetLibrary assets;
  assets.types = {PieceType{"brick", {}, {}, {}}};
  PileState pile;
  pile.types = {"brick"}, pile.pieces.resize(2);
  RobotRecord robot;
  robot.links = {"base_link", "lidar_frame"}, robot.instances = {"rover/base_link"};
  const Legend legend = describe_recording(s, assets, pile, {robot}).legend;
  ASSERT_EQ(legend.pieces.size(), 3u);
  EXPECT_EQ(legend.pieces[1].asset, "brick");
  EXPECT_EQ(legend.pieces[2].asset, "rover/base_link");
  EXPECT_EQ(legend.labels.at(legend.pieces[2].label), "robot");
}

}  // namespace formats_test
}  // namespace rubble::testing
