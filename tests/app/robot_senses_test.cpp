// What the functions that drive robots are told of LiDARs and cameras.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <string>
#include <vector>

#include "io/image/image_file.h"
#include "tests/app/program.h"

namespace rubble::testing {
namespace robot_senses_test {

const std::string kNoFrames =
    " --set outputs.bag=false --set outputs.rawlog=false --set outputs.simplemap=false --force --out ";

// A rover with a LiDAR on a mast, so that it does not see itself, before a wall and a block. `control` is the body of
// its function.
std::string mission(const std::string& control, const std::string& more = "") {
  return R"(return rubble.mission {
  seed = 11,
  pile = { layers = 0, placed = {
    { box = { 0.2, 6, 3 }, position = { 3.1, 0, 1.5 } }, { box = { 0.4, 0.4, 0.4 }, position = { 1.5, -1.2, 0.2 } } } },
  robots = { rubble.robot.rover { name = "rover", position = { 0, 0, 0.001 }, senses = { "top", "eye" },
    control = function(sense)
)" + control +
         R"(
    end } },
  robot_run = { duration = 0.8 },
  lidars = { top = { model = "vlp16", ride = { robot = "rover" }, position = { 0, 0, 0.7 }, returns = "dual" } },
  cameras = {
    eye = { ride = { robot = "rover" }, position = { 0.3, 0, 0.25 }, width = 40, height = 30, fov_deg = 60, rate_hz = 20,
            quality = "draft" },
    watch = { width = 32, height = 32, quality = "draft" },
  },
  trajectory = { rate_hz = 2, waypoints = { { t = 0, position = { -3, 0, 2 }, look_at = { 0, 0, 0 } } } },
  )" + more + "}\n";
}

// What the function raises, after "told:".
std::vector<double> told_by(const std::string& script, const std::string& options = "") {
  const ScratchFolder scratch;
  write_file(scratch / "m.lua", script);
  const Outcome run = run_rubble("run " + (scratch / "m.lua") + options + kNoFrames + (scratch / "out"));
  EXPECT_EQ(run.exit_code, 1) << run.err;
  const std::size_t at = run.err.find("told:");
  EXPECT_NE(at, std::string::npos) << run.err;
  std::vector<double> numbers;
  if (at == std::string::npos) return numbers;
  std::istringstream words(run.err.substr(at + 5));
  for (std::string word; words >> word && word.rfind("end", 0) != 0;) numbers.push_back(std::strtod(word.c_str(), nullptr));
  return numbers;
}

// Count of its points and sums of x, y, z, intensity and ring, in the order of the file.
std::vector<double> sum_of_pcd(const std::string& path) {
  const std::string text = read_file(path);
  const std::string end = "DATA binary\n";
  const std::size_t data = text.find(end) + end.size();
  constexpr std::size_t kSize = 22;  // float32 x, y, z, intensity, uint16 ring, float32 time
  std::vector<double> sums(6);
  for (std::size_t at = data; at + kSize <= text.size(); at += kSize) {
    float values[4];
    std::uint16_t ring = 0;
    std::memcpy(values, &text[at], sizeof values);
    std::memcpy(&ring, &text[at + 16], sizeof ring);
    sums[0] += 1;
    for (int i = 0; i < 4; ++i) sums[std::size_t(1 + i)] += double(values[i]);
    sums[5] += ring;
  }
  return sums;
}

// With noise, second echoes and a sensor that moves: to the last bit.
TEST(RobotSenses, AFunctionIsToldTheScansThatAreRecorded) {
  const std::string drive = "local command = { linear = 0.4, angular = 0.5 }\n";
  const std::vector<double> told = told_by(mission(drive + R"(
    local scan = sense.lidars.top
    if not scan or scan.t < 0.35 then return command end
    local sums = { #scan.x, 0, 0, 0, 0, 0 }
    for i = 1, #scan.x do
      sums[2], sums[3], sums[4] = sums[2] + scan.x[i], sums[3] + scan.y[i], sums[4] + scan.z[i]
      sums[5], sums[6] = sums[5] + scan.intensity[i], sums[6] + scan.ring[i]
    end
    error(string.format("told: %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g end", sense.t, scan.t, table.unpack(sums)))
  )"));
  ASSERT_EQ(told.size(), 8u);
  const ScratchFolder scratch;
  write_file(scratch / "m.lua", mission(drive + "return command", "outputs = { pcd = true },"));
  const Outcome run = run_rubble("run " + (scratch / "m.lua") + kNoFrames + (scratch / "out"));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::vector<double> recorded = sum_of_pcd(scratch / "out/pcd/top/000004.pcd");
  EXPECT_GT(recorded[0], 5000);
  EXPECT_EQ(std::vector<double>(told.begin() + 2, told.end()), recorded);
  // Scan 4 leaves from 0.4 s to 0.5 s, and is told at the next call.
  EXPECT_DOUBLE_EQ(told[1], 0.4);
  EXPECT_GT(told[0], 0.5);
  EXPECT_LT(told[0], 0.5 + 0.03);
}

TEST(RobotSenses, DepthIsThatOfAWallInFront) {
  // It stands still: the middle of the image meets the wall at x = 3, 2.7 m ahead of the camera.
  const std::vector<double> told = told_by(mission(R"(
    local image = sense.cameras.eye
    if not image or image.t < 0.28 then return {} end
    error(string.format("told: %.17g %d %d %d %.17g %.17g end", image.t, image.width, image.height, #image.depth,
                        image.depth[15 * image.width + 21], image.depth[29 * image.width + 21]))
  )"));
  ASSERT_EQ(told.size(), 6u);
  EXPECT_NEAR(told[0], 0.3, 1e-9);
  EXPECT_EQ(told[1], 40);
  EXPECT_EQ(told[2], 30);
  EXPECT_EQ(told[3], 1200);
  EXPECT_NEAR(told[4], 2.7, 0.01);
  // Row 29 looks down by 14.5 pixels: the ground, 0.25 m below, at 0.25 fx / 14.5 along the axis.
  const double fx = 20 / std::tan(30 * 3.14159265358979 / 180);
  EXPECT_NEAR(told[5], 0.251 * fx / 14.5, 0.02);
}

TEST(RobotSenses, RangesOfAScannerHaveTheAnglesThatAreTold) {
  const std::vector<double> told = told_by(R"(return rubble.mission {
    pile = { layers = 0, placed = { { box = { 0.2, 6, 3 }, position = { 3.1, 0, 1.5 } } } },
    robots = { rubble.robot.rover { name = "rover", position = { 0, 0, 0.001 }, senses = { "flat" },
      control = function(sense)
        local scan = sense.lidars.flat
        if not scan then return {} end
        local rays, nearest, farthest = 0, 100, 0
        for i, range in ipairs(scan.ranges) do
          local angle = scan.first_angle + (i - 1) * scan.angle_step
          if math.abs(angle) < 0.7 then
            local x = range * math.cos(angle)
            rays, nearest, farthest = rays + 1, math.min(nearest, x), math.max(farthest, x)
          end
        end
        error(string.format("told: %d %.17g %.17g end", rays, nearest, farthest))
      end } },
    robot_run = { duration = 0.3 },
    lidars = { flat = { model = "utm30lx", ride = { robot = "rover" }, position = { 0, 0, 0.7 }, noise = false,
                        range_step = 0 } },
    camera = { width = 32, height = 32, quality = "draft" },
  })");
  ASSERT_EQ(told.size(), 3u);
  EXPECT_NEAR(told[0], 1.4 / (0.25 * 3.14159265358979 / 180), 2);
  EXPECT_NEAR(told[1], 3, 0.01);  // the wall at x = 3; the rover settles by millimetres
  EXPECT_NEAR(told[2], 3, 0.01);
}

// Noise, biases and lever arm included, to the last bit; each once.
TEST(RobotSenses, ReadingsOfAnInertialUnitAreThoseThatAreRecorded) {
  const ScratchFolder scratch;
  write_file(scratch / "m.lua", R"(return rubble.mission {
    seed = 5,
    pile = { layers = 0, placed = { { box = { 0.4, 0.4, 0.04 }, position = { 0.5, 0.2, 0.02 } } } },
    robots = { rubble.robot.rover { name = "rover", position = { 0, 0, 0.001 }, senses = { "imu" },
      control = function(sense)
        for _, r in ipairs(sense.imus.imu or {}) do
          local w, a = r.gyroscope, r.accelerometer
          print(string.format("reading %.0f %.17g %.17g %.17g %.17g %.17g %.17g", r.t * 1e9, w[1], w[2], w[3], a[1], a[2], a[3]))
        end
        return { linear = 0.5, angular = 0.8 }
      end } },
    robot_run = { duration = 1.5 },
    imu = { on = true, rate_hz = 250, position = { 0.1, 0.05, 0.2 }, rpy_deg = { 10, 20, 30 } },
    camera = { width = 32, height = 32, quality = "draft" },
    trajectory = { rate_hz = 2, ride = { robot = "rover" } },
    outputs = { euroc = true },
  })");
  const Outcome run = run_rubble("run " + (scratch / "m.lua") + kNoFrames + (scratch / "out"));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  std::vector<std::vector<double>> told;
  std::istringstream lines(run.err);
  for (std::string line, word; std::getline(lines, line);) {
    std::istringstream words(line);
    if (!(words >> word) || word != "reading") continue;
    told.emplace_back();
    while (words >> word) told.back().push_back(std::strtod(word.c_str(), nullptr));
  }
  std::istringstream rows(read_file(scratch / "out/euroc/mav0/imu0/data.csv"));
  std::size_t count = 0;
  for (std::string row; std::getline(rows, row);) {
    if (row.empty() || row[0] == '#' || count == told.size()) continue;
    std::istringstream cells(row);
    std::vector<double> recorded;
    for (std::string cell; std::getline(cells, cell, ',');) recorded.push_back(std::strtod(cell.c_str(), nullptr));
    recorded.at(0) -= 1e9;  // start_ns
    EXPECT_EQ(recorded, told[count]) << "reading " << count;
    ++count;
  }
  EXPECT_EQ(count, told.size());
  EXPECT_EQ(count, 369u);  // to 1.472 s: the last call is at 1.483 s, and tells what was complete two steps before
}

// What a function printed of a picture: when it was called, the stamp (s), and the pixels, 3 bytes each.
struct ToldPicture {
  std::string camera;
  double called = 0, stamp = 0;
  std::vector<int> rgb;
};

// Two cameras on a turning rover before posts, one of them with a shutter and an automatic exposure.
const char* const kPosts = R"(
  local posts = {}
  for i = -4, 4 do
    local height = 0.3 + 0.1 * (i % 3)
    posts[#posts + 1] = { box = { 0.1, 0.12, height }, position = { 2.5 + 0.2 * (i % 2), 0.33 * i, height / 2 } }
  end
  return rubble.mission {
    seed = 11,
    pile = { layers = 0, placed = posts },
    robots = { rubble.robot.rover { name = "rover", position = { 0, 0, 0.001 }, senses = { "eye.rgb", "worn.rgb" },
      control = function(sense)
        for _, name in ipairs { "eye", "worn" } do
          local image, digits = sense.images[name], {}
          for i = 1, image and #image.rgb or 0 do digits[i] = string.format("%02x", image.rgb:byte(i)) end
          if image then print("picture", name, sense.t, image.t, image.width, image.height, table.concat(digits)) end
        end
        return { linear = 0.3, angular = -0.6 }
      end } },
    robot_run = { duration = 0.5 },
    cameras = {
      eye = { ride = { robot = "rover" }, position = { 0.3, 0, 0.25 }, width = 40, height = 30, fov_deg = 60, rate_hz = 10 },
      worn = { ride = { robot = "rover" }, position = { 0.3, 0, 0.25 }, width = 40, height = 30, fov_deg = 60, rate_hz = 10,
        exposure = { mode = "automatic", longest_time = 0.03 }, shutter = { readout = 0.02, motion_blur = true } } },
    outputs = { frames = true },
    trajectory = { rate_hz = 2, ride = { robot = "rover" } },
  })";

std::vector<ToldPicture> pictures_in(const std::string& text) {
  std::vector<ToldPicture> pictures;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string word, digits;
    if (!(words >> word) || word != "picture") continue;
    ToldPicture& picture = pictures.emplace_back();
    int width = 0, height = 0;
    words >> picture.camera >> picture.called >> picture.stamp >> width >> height >> digits;
    EXPECT_EQ(digits.size(), std::size_t(width * height * 6));
    for (std::size_t i = 0; i + 1 < digits.size(); i += 2) picture.rgb.push_back(std::stoi(digits.substr(i, 2), nullptr, 16));
  }
  return pictures;
}

// Mean difference to a recorded frame, of 255.
double difference(const ToldPicture& picture, const std::string& out, int frame) {
  char name[16];
  std::snprintf(name, sizeof name, "%06d.png", frame);
  const RgbImage recorded = read_rgb_png(out + "/cameras/" + picture.camera + "/frames/rgb/" + name);
  if (recorded.rgb.size() != picture.rgb.size()) return 255;
  double sum = 0;
  for (std::size_t i = 0; i < picture.rgb.size(); ++i) sum += std::abs(picture.rgb[i] - recorded.rgb[i]);
  return sum / double(picture.rgb.size());
}

// To the last bit: the recorded scene is lit as the one that nobody knows the end of.
TEST(RobotSenses, ColoursAreThoseOfTheRecordedImages) {
  const ScratchFolder scratch;
  write_file(scratch / "m.lua", kPosts);
  const auto run_on = [&](const std::string& threads) {
    const Outcome run = run_rubble("run " + (scratch / "m.lua") + " --threads " + threads + kNoFrames + (scratch / "out"));
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return pictures_in(run.err);
  };
  const std::vector<ToldPicture> pictures = run_on("1"), on_two = run_on("2");
  ASSERT_EQ(pictures.size(), 10u);
  ASSERT_EQ(on_two.size(), 10u);
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const ToldPicture& picture = pictures[i];
    EXPECT_EQ(picture.rgb, on_two[i].rgb);
    const int frame = int(i / 2);
    EXPECT_NEAR(picture.stamp, 0.1 * frame, 1e-9);
    // Two steps after the end of the exposure, in the next call: 60 a second.
    const double whole = picture.stamp + 2 / 240. + (picture.camera == "worn" ? 0.025 : 0);
    EXPECT_GE(picture.called, whole - 1e-9);
    EXPECT_LE(picture.called, whole + 1 / 60. + 1e-9);
    const double own = difference(picture, scratch / "out", frame), next = difference(picture, scratch / "out", frame + 1);
    EXPECT_EQ(own, 0) << picture.camera << " " << frame;
    EXPECT_GT(next, 1) << picture.camera << " " << frame;
  }
}

// New readings alone are told, each once; which does not depend on the threads.
TEST(RobotSenses, EachReadingIsToldOnceOnAnyNumberOfThreads) {
  const std::string counting = mission(R"(
    counts = counts or { 0, 0, 0, 0 }
    local scan, image = sense.lidars.top, sense.cameras.eye
    if scan then counts[1], counts[2] = counts[1] + 1, counts[2] + #scan.x end
    if image then
      counts[3] = counts[3] + 1
      for _, d in ipairs(image.depth) do counts[4] = counts[4] + math.min(d, 100) end
    end
    if sense.t > 0.74 then error(string.format("told: %.17g %.17g %.17g %.17g end", table.unpack(counts))) end
    return { linear = 0.3, angular = -0.4 }
  )");
  const std::vector<double> one = told_by(counting, " --threads 1"), two = told_by(counting, " --threads 2");
  ASSERT_EQ(one.size(), 4u);
  EXPECT_EQ(one, two);
  EXPECT_EQ(one[0], 7);   // begun at 0, 0.1, ... 0.6 s
  EXPECT_EQ(one[2], 15);  // 0, 0.05, ... 0.7 s
}

TEST(RobotSenses, WhatCannotBeSensedIsAMistakeWithItsKey) {
  const std::string robot = "return rubble.mission { pile = { layers = 0 },\n"
                            "  robots = { rubble.robot.rover { name = \"r\", position = { 0, 0, 0.001 },\n"
                            "    senses = { \"eye\" }, control = function() return {} end } },\n";
  const struct {
    std::string script, expected;
  } cases[] = {
      {robot + "  lidars = { top = { ride = { robot = \"r\" } } } }", "robots[1].senses[1]: no sensor has this name"},
      {robot + "  lidars = { eye = {} } }", "lidars.eye: no robot carries it"},
      {robot + "  cameras = { eye = { ride = { robot = \"r\" }, lens = { k1 = 0.1 } } } }", "cameras.eye.lens"},
      {"return rubble.mission { pile = { layers = 0 }, lidars = { eye = {} },\n"
       "  robots = { rubble.robot.rover { position = { 0, 0, 0.001 }, senses = { \"eye\" } } } }",
       "robots[1].senses: there is no controller"},
      {"return rubble.mission { pile = { layers = 0 }, camera = { lens = { model = \"plumb_bob\", k1 = 0.1 } },\n"
       "  trajectory = { ride = { robot = \"r\" } }, robots = { rubble.robot.rover { name = \"r\",\n"
       "    position = { 0, 0, 0.001 }, senses = { \"camera\" }, control = function() return {} end } } }",
       ": camera.lens: "}};
  for (const auto& c : cases) {
    const ScratchFolder scratch;
    write_file(scratch / "m.lua", c.script);
    const Outcome run = run_rubble("run " + (scratch / "m.lua") + " --force --out " + (scratch / "out"));
    EXPECT_EQ(run.exit_code, 1) << c.expected;
    EXPECT_NE(run.err.find(c.expected), std::string::npos) << run.err;
  }
}

// The goal is behind the blocks: a rover that does not look drives into them.
TEST(RobotSenses, ARoverFindsItsWayThroughALeanToByItsScans) {
  const ScratchFolder scratch;
  const Outcome run = run_rubble("run scripts/robots/follow_the_gap.lua --set trajectory.rate_hz=0.01 --set camera.width=32"
                                 " --set camera.height=32 --set camera.quality=draft" +
                                 kNoFrames + (scratch / "out"));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  std::istringstream lines(read_file(scratch / "out/robots/rover.txt"));
  double stamp = 0, x = 0, y = 0, last_x = 0, last_y = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream words(line);
    words >> stamp >> x >> y;
    last_x = x, last_y = y;
  }
  EXPECT_NEAR(last_x, 1.1, 0.8);  // the gyroscope is exact, the odometry of skidding wheels is not
  EXPECT_NEAR(last_y, 2.9, 0.8);
}

}  // namespace robot_senses_test
}  // namespace rubble::testing
