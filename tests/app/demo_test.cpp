// The mission of `make demo`, with small and few pictures, and its film.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

#include "tests/app/tiny_run.h"

namespace rubble::testing {
namespace demo_test {

namespace fs = std::filesystem;

// Path-traced, because no light is found for these.
const std::string kSmall = " --set camera.width=32 --set camera.height=24 --set camera.quality=reference"
                           " --set camera.samples=1 --quiet --out ";

// x and y of a trajectory in the format of TUM; unit: m
std::vector<std::pair<double, double>> read_way(const std::string& file) {
  std::istringstream lines(read_file(file));
  std::vector<std::pair<double, double>> way;
  for (std::string line; std::getline(lines, line);) {
    double stamp = 0, x = 0, y = 0;
    if (std::istringstream(line) >> stamp >> x >> y) way.push_back({x, y});
  }
  return way;
}

// Whether a place is below what was the building.
bool is_inside(const nlohmann::ordered_json& building, const std::pair<double, double>& at) {
  const auto half = [&](const char* bays, const char* span) {
    return building.at(bays).get<double>() * building.at(span).get<double>() / 2;
  };
  return std::fabs(at.first) < half("bays_x", "span_x") && std::fabs(at.second) < half("bays_y", "span_y");
}

nlohmann::ordered_json read_building() {
  const Outcome check = run_rubble("check scripts/demo.lua");
  EXPECT_EQ(check.exit_code, 0) << check.err;
  return nlohmann::ordered_json::parse(check.out)["pile"]["building"];
}

TEST(Demo, TheBuildingComesDown) {
  const ScratchFolder scratch;
  const std::string folder = scratch / "demo";
  const Outcome settled = run_rubble("settle scripts/demo.lua --quiet --out " + folder);
  ASSERT_EQ(settled.exit_code, 0) << settled.err;
  const auto building = read_building();
  const double built = building["storeys"].get<double>() * building["storey_height"].get<double>();
  const auto manifest = read_manifest(folder);
  EXPECT_TRUE(manifest["pile"]["settled"].get<bool>());
  EXPECT_LT(manifest["metrics"]["pile_height_m"].get<double>(), 0.8 * built);
}

TEST(Demo, TheRobotGetsIntoTheRuinAndRecordsIt) {
  const ScratchFolder scratch;
  const std::string folder = scratch / "demo";
  const Outcome run = run_rubble("run scripts/demo.lua" + kSmall + folder);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.err.find("inside"), std::string::npos) << "the camera on its mast meets what the robot's hulls do not: " << run.err;
  const auto building = read_building();
  const auto way = read_way(folder + "/robots/tank.txt");
  ASSERT_GT(way.size(), 100U);
  EXPECT_FALSE(is_inside(building, way.front()));
  EXPECT_TRUE(is_inside(building, way.back())) << way.back().first << ", " << way.back().second;
  EXPECT_LT(std::hypot(way.back().first + 0.4, way.back().second + 1.5), 0.3) << "it does not come to the end of its path";
  EXPECT_EQ(read_manifest(folder)["metrics"]["robots_lost"].get<double>(), 0);
  for (const char* name : {"mission.bag", "mission.rawlog", "preview.png"}) EXPECT_TRUE(fs::exists(folder + "/" + name)) << name;

  const Outcome view = run_rubble("view " + folder);
  ASSERT_EQ(view.exit_code, 0) << view.err;
  EXPECT_EQ(view.out, folder + "/view.html\n") << "the last line of make demo names this page";
}

TEST(Demo, IsAPageThatPeopleStartFrom) {
  const std::string text = read_file(fs::path(RUBBLE_SOURCE_DIR) / "scripts/demo.lua");
  EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 60);
}

// Both parts of the film, tiny, and what ffmpeg makes of them.
TEST(NightlyFilm, HasTheCollapseAndTheWayIn) {
  const ScratchFolder scratch;
  const std::string sizes = " --set trajectory.rate_hz=2 --quiet --out " + (scratch / "film");
  const Outcome collapse = run_rubble("run scripts/film.lua --set camera.width=64 --set camera.height=36"
                                      " --set record_settling.rate_hz=2" + sizes + "/collapse");
  ASSERT_EQ(collapse.exit_code, 0) << collapse.err;
  const Outcome way = run_rubble("run scripts/film.lua --set part=way --set cameras.front.width=64 --set cameras.front.height=48"
                                 " --set cameras.outside.width=64 --set cameras.outside.height=36" + sizes + "/way");
  ASSERT_EQ(way.exit_code, 0) << way.err;
  const std::string film = scratch / "film.mp4";
  ASSERT_EQ(std::system(("/usr/bin/python3 " RUBBLE_SOURCE_DIR "/tools/draw_film.py --rate 2 --kilobytes 200 --run " +
                         (scratch / "film") + " --out " + film).c_str()), 0);
  EXPECT_LT(fs::file_size(film), 300'000U);
  const std::string probe = "ffprobe -v error -count_frames -select_streams v -show_entries stream=codec_name,nb_read_frames"
                            " -of csv=p=0 " + film + " > " + (scratch / "probe");
  ASSERT_EQ(std::system(probe.c_str()), 0);
  const std::string told = read_file(scratch / "probe");
  EXPECT_EQ(told.rfind("h264,", 0), 0U) << told;
  EXPECT_GT(std::stoi(told.substr(5)), 60) << told;
}

}  // namespace demo_test
}  // namespace rubble::testing
