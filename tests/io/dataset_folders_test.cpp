// TUM, EuRoC, COLMAP and plain folders: every number in them, against the frames that went in.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <sstream>

#include "io/datasets/colmap_recorder.h"
#include "io/datasets/euroc_recorder.h"
#include "io/datasets/frames_recorder.h"
#include "io/datasets/tum_recorder.h"
#include "io/image/image_file.h"
#include "kernel/base/error.h"
#include "kernel/base/number_text.h"
#include "tests/io/support.h"

namespace rubble {
namespace dataset_folders_test {

using test::make_full_frame;
using test::read_text;
using test::ScratchFolder;

constexpr int kFrames = 3;

void record(std::unique_ptr<Recorder> recorder, const Intrinsics* intrinsics = nullptr) {
  for (int i = 0; i < kFrames; ++i) {
    Frame frame = make_full_frame(i);
    if (intrinsics) frame.intrinsics = *intrinsics;
    for (const ImuSample& sample : test::make_full_imu(i)) recorder->write_imu(sample);
    recorder->write(frame);
  }
  recorder->finish();
}

// The rows of a table, each as its words; comments are left out.
std::vector<std::vector<std::string>> rows_of(const std::string& path, char separator) {
  std::istringstream text(read_text(path));
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(text, line);) {
    if (line.empty() || line[0] == '#') continue;
    rows.emplace_back();
    std::istringstream words(line);
    for (std::string word; std::getline(words, word, separator);) rows.back().push_back(word);
  }
  return rows;
}

std::vector<double> numbers_of(const std::vector<std::string>& row, std::size_t from,
                               std::size_t count) {
  std::vector<double> numbers;
  for (std::size_t i = from; i < from + count; ++i) numbers.push_back(std::stod(row.at(i)));
  return numbers;
}

Pose pose_xyzw(const std::vector<double>& n) {
  return {{n[6], n[3], n[4], n[5]}, {n[0], n[1], n[2]}};
}

// Every 37th pixel with depth, in the optical frame: calls use(u, v, point).
template <typename Use>
void for_points(const Intrinsics& k, const std::vector<double>& depth, Use use) {
  for (std::size_t i = 0; i < depth.size(); i += 37) {
    if (!(depth[i] > 0)) continue;
    const double u = double(i % std::size_t(k.width)), v = double(i / std::size_t(k.width));
    use(u, v, Vec3{(u - k.cx) / k.fx, (v - k.cy) / k.fy, 1} * depth[i]);
  }
}

// What a mapping program does with a TUM sequence: the points lie on the scene.
TEST(Tum, DepthAtTheTrueStampsAndPosesLiesOnTheScene) {
  ScratchFolder folder;
  record(make_tum_recorder(folder / "tum", {}, 2));
  const auto pairs = rows_of(folder / "tum/associations.txt", ' ');
  const auto truth = rows_of(folder / "tum/groundtruth.txt", ' ');
  const auto calibration = numbers_of(rows_of(folder / "tum/calibration.txt", ' ')[0], 0, 4);
  ASSERT_EQ(pairs.size(), std::size_t(kFrames));
  ASSERT_EQ(truth.size(), std::size_t(kFrames));
  Intrinsics k = make_full_frame(0).intrinsics;
  k.fx = calibration[0], k.fy = calibration[1], k.cx = calibration[2], k.cy = calibration[3];
  int points = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    EXPECT_EQ(pairs[i][0], truth[i][0]) << "stamps differ";
    EXPECT_EQ(pairs[i][0], pairs[i][2]);
    EXPECT_EQ(read_rgb_png(folder / ("tum/" + pairs[i][1])).rgb, make_full_frame(int(i)).rgb);
    std::vector<double> depth;
    for (const std::uint16_t d : read_depth_png(folder / ("tum/" + pairs[i][3])).values)
      depth.push_back(d / 5000.0);
    const Pose world_from_optical = pose_xyzw(numbers_of(truth[i], 1, 7));
    for_points(k, depth, [&](double, double, const Vec3& p) {
      EXPECT_LT(test::distance_to_scene(world_from_optical * p), 0.0005);
      ++points;
    });
  }
  EXPECT_GT(points, 200);
}

TEST(Tum, MeasuredDepthTakesThePlaceOfTheExactOne) {
  ScratchFolder folder;
  record(make_tum_recorder(folder / "tum", test::full_recording(), 1));
  const std::string name = rows_of(folder / "tum/depth.txt", ' ')[1][1].substr(6);
  const Frame frame = make_full_frame(1);
  const auto measured = read_depth_png(folder / ("tum/depth/" + name)).values;
  const auto exact = read_depth_png(folder / ("tum/depth_true/" + name)).values;
  const std::size_t pixel = 60 * 96 + 48;
  EXPECT_NEAR(measured[pixel] / 5000.0, double(frame.measured_depth[pixel]), 1.1e-4);
  EXPECT_NEAR(exact[pixel] / 5000.0, double(frame.depth[pixel]), 1.1e-4);
  EXPECT_NE(measured, exact);
}

// 1 s, 2 s and 10 s by name as by time.
TEST(Tum, NamesSortAsStampsDo) {
  EXPECT_EQ(sorted_seconds_text(1'000'000'000), "0000000001.000000000");
  EXPECT_EQ(sorted_seconds_text(1'305'031'102'175'304'000), "1305031102.175304000");
  EXPECT_EQ(sorted_stamp_text(9), "0000000000000000009");
  EXPECT_LT(sorted_seconds_text(2'000'000'000), sorted_seconds_text(10'000'000'000));
  EXPECT_LT(sorted_stamp_text(999'999'999'999), sorted_stamp_text(1'000'000'000'000));
  ScratchFolder folder;
  record(make_tum_recorder(folder / "tum", test::full_recording(), 1));
  for (const auto& row : rows_of(folder / "tum/rgb.txt", ' ')) {
    EXPECT_EQ(row[1].size(), std::string("rgb/0000000001.000000000.png").size()) << row[1];
    EXPECT_EQ(std::stod(row[1].substr(4)), std::stod(row[0]));
  }
}

TEST(Euroc, TablesAndCalibrationsAreThoseOfTheFrames) {
  ScratchFolder folder;
  const Recording recording = test::full_recording();
  record(make_euroc_recorder(folder / "euroc", recording, 2));
  const std::string mav = folder / "euroc/mav0/";
  const auto pictures = rows_of(mav + "cam0/data.csv", ',');
  const auto states = rows_of(mav + "state_groundtruth_estimate0/data.csv", ',');
  const auto imu = rows_of(mav + "imu0/data.csv", ',');
  ASSERT_EQ(pictures.size(), std::size_t(kFrames));
  ASSERT_EQ(states.size(), std::size_t(kFrames));
  std::size_t sample = 0;
  for (int i = 0; i < kFrames; ++i) {
    const Frame frame = make_full_frame(i);
    const std::string number = std::to_string(frame.stamp_ns), stamp = std::string(19 - number.size(), '0') + number;
    EXPECT_EQ(pictures[std::size_t(i)][0], stamp);
    EXPECT_EQ(pictures[std::size_t(i)][1], stamp + ".png");
    for (const char* camera : {"cam0", "cam1"})
      EXPECT_TRUE(test::exists(mav + camera + "/data/" + stamp + ".png"));
    const auto state = numbers_of(states[std::size_t(i)], 1, 16);
    const Quat& q = frame.world_from_camera.rotation;
    EXPECT_EQ(state[0], frame.world_from_camera.translation.x);
    EXPECT_EQ((std::vector<double>(state.begin() + 3, state.begin() + 10)),
              (std::vector<double>{q.w, q.x, q.y, q.z, 3, 0.25 * i, -0.5}));
    const std::vector<ImuSample> readings = test::make_full_imu(i);
    EXPECT_EQ(state[15], readings.back().acceleration_bias.z);
    for (const ImuSample& s : readings) {
      ASSERT_LT(sample, imu.size());
      EXPECT_EQ(imu[sample][0], std::to_string(s.stamp_ns));
      const auto row = numbers_of(imu[sample++], 1, 6);
      EXPECT_EQ(row[0], s.angular_velocity.x);
      EXPECT_EQ(row[5], s.linear_acceleration.z);
    }
  }
  EXPECT_EQ(sample, imu.size());
  const std::string right = read_text(mav + "cam1/sensor.yaml");
  EXPECT_NE(right.find("data: [0, 0, 1, 0, -1, 0, 0, -0.12, 0, -1, 0, 0, 0, 0, 0, 1]"),
            std::string::npos)
      << right;
  EXPECT_NE(right.find("distortion_model: radial-tangential"), std::string::npos);
  EXPECT_NE(right.find("\nrate_hz: 30\n"), std::string::npos) << right;
  EXPECT_NE(read_text(mav + "imu0/sensor.yaml").find("rate_hz: 150"), std::string::npos);
}

TEST(Euroc, OnePictureHasNoRate) {
  ScratchFolder folder;
  const auto recorder = make_euroc_recorder(folder / "euroc", test::full_recording(), 1);
  test::write_full(*recorder, 0);
  recorder->finish();
  EXPECT_EQ(read_text(folder / "euroc/mav0/cam0/sensor.yaml").find("rate_hz"), std::string::npos);
}

// The rig rides on the link that carries the unit, or the cameras do.
TEST(Euroc, UnitsOnTheLinkOfTheRigAreInItsBody) {
  ScratchFolder folder;
  Recording recording = test::full_recording();
  recording.imus[0].carrier = "base_link";
  recording.imus[0].rig_from_imu.translation = {0, 0, 1};
  const auto mounting = [&](const std::string& name) {
    record(make_euroc_recorder(folder / name, recording, 1));
    const std::string text = read_text(folder / (name + "/mav0/imu0/sensor.yaml"));
    const std::size_t at = text.find("data: ");
    return text.substr(at, text.find('\n', at) - at);
  };
  recording.mount = RigMount{"base_link", {{0.5, 0.5, 0.5, 0.5}, {0.25, 0, 0.5}}};  // its X to Y, Y to Z, Z to X
  EXPECT_EQ(mounting("rig"), "data: [0, 1, 0, 0, 0, 0, 1, 0.5, 1, 0, 0, -0.25, 0, 0, 0, 1]");
  recording.cameras[0].carrier = "base_link";
  EXPECT_EQ(mounting("link"), "data: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 1]");
}

// COLMAP measures pixels from the corner of the picture: ours are half a pixel less.
TEST(Colmap, PosesAndIntrinsicsProjectPointsToTheirPixels) {
  ScratchFolder folder;
  record(make_colmap_recorder(folder / "colmap", {}, 2));
  const auto camera = rows_of(folder / "colmap/sparse/cameras.txt", ' ')[0];
  EXPECT_EQ(camera[1], "PINHOLE");
  const auto k = numbers_of(camera, 4, 4);
  const auto images = rows_of(folder / "colmap/sparse/images.txt", ' ');
  ASSERT_EQ(images.size(), std::size_t(kFrames));
  for (int i = 0; i < kFrames; ++i) {
    const Frame frame = make_full_frame(i);
    const auto n = numbers_of(images[std::size_t(i)], 1, 7);
    const Pose camera_from_world{{n[0], n[1], n[2], n[3]}, {n[4], n[5], n[6]}};
    EXPECT_TRUE(test::exists(folder / ("colmap/images/" + images[std::size_t(i)][9])));
    const std::vector<double> depth(frame.depth.begin(), frame.depth.end());
    for_points(frame.intrinsics, depth, [&](double u, double v, const Vec3& p) {
      const Vec3 world = frame.world_from_camera * camera_from_optical * p;
      const Vec3 seen = camera_from_world * world;
      EXPECT_NEAR(k[0] * seen.x / seen.z + k[2], u + 0.5, 1e-6);
      EXPECT_NEAR(k[1] * seen.y / seen.z + k[3], v + 0.5, 1e-6);
    });
  }
}

TEST(Colmap, NamesTheModelThatTheLensNeeds) {
  struct Case {
    std::array<double, 5> distortion;
    LensModel lens;
    const char* model;
    std::size_t words;
  };
  for (const Case& c : {Case{{0.1, 0.01, 0.001, 0.002, 0}, LensModel::plumb_bob, "OPENCV", 12},
                        Case{{0.1, 0.01, 0, 0, 0.3}, LensModel::plumb_bob, "FULL_OPENCV", 16},
                        Case{{0.1, 0, 0, 0, 0}, LensModel::fisheye, "OPENCV_FISHEYE", 12}}) {
    ScratchFolder folder;
    Intrinsics k = make_full_frame(0).intrinsics;
    k.distortion = c.distortion;
    k.lens = c.lens;
    record(make_colmap_recorder(folder / "colmap", test::full_recording(), 1), &k);
    const auto camera = rows_of(folder / "colmap/sparse/cameras.txt", ' ')[0];
    EXPECT_EQ(camera[1], c.model);
    EXPECT_EQ(camera.size(), c.words) << c.model;
    if (test::run_command("command -v colmap").exit_code != 0) continue;
    const auto read =
        test::run_command("colmap model_analyzer --path " + (folder / "colmap/sparse"));
    EXPECT_EQ(read.exit_code, 0) << read.output;
    for (const char* row : {"Cameras: 2", "Images: 6", "Registered images: 6"})
      EXPECT_NE(read.output.find(row), std::string::npos) << read.output;
  }
}

template <typename T>
std::vector<T> read_exr(const std::string& path, const std::vector<const char*>& channels) {
  const Imf::PixelType type = std::is_same_v<T, float> ? Imf::FLOAT : Imf::UINT;
  Imf::InputFile file(path.c_str(), 0);
  const auto box = file.header().dataWindow();
  const auto width = std::size_t(box.max.x + 1), height = std::size_t(box.max.y + 1);
  std::vector<T> values(width * height * channels.size());
  Imf::FrameBuffer pixels;
  const std::size_t step = channels.size() * sizeof(T);
  for (std::size_t c = 0; c < channels.size(); ++c) {
    EXPECT_TRUE(file.header().channels().findChannel(channels[c])) << channels[c];
    pixels.insert(channels[c],
                  Imf::Slice(type, reinterpret_cast<char*>(values.data() + c), step, step * width));
  }
  file.setFrameBuffer(pixels);
  file.readPixels(0, box.max.y);
  return values;
}

template <typename T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

TEST(Frames, EveryChannelReadsBackBitForBit) {
  ScratchFolder folder;
  record(make_frames_recorder(folder / "frames", test::full_recording(), 2));
  const Frame frame = make_full_frame(2);
  const std::string at = folder / "frames/";
  EXPECT_EQ(read_rgb_png(at + "rgb/000002.png").rgb, frame.rgb);
  EXPECT_EQ(read_rgb_png(at + "right/000002.png").rgb, frame.rgb_right);
  EXPECT_EQ(read_depth_png(at + "label/000002.png").values, frame.get<std::uint16_t>("label"));
  EXPECT_TRUE(same_bits(read_exr<float>(at + "depth/000002.exr", {"Y"}), frame.measured_depth));
  EXPECT_TRUE(same_bits(read_exr<float>(at + "depth_true/000002.exr", {"Y"}), frame.depth));
  EXPECT_TRUE(
      same_bits(read_exr<float>(at + "normals/000002.exr", {"R", "G", "B"}), frame.get<float>("normals")));
  std::vector<float> signed_instance;  // the ground is -1, nothing -2
  for (const std::uint32_t id : frame.get<std::uint32_t>("instance")) signed_instance.push_back(float(std::int32_t(id)));
  EXPECT_TRUE(same_bits(read_exr<float>(at + "instance/000002.exr", {"Y"}), signed_instance));
  EXPECT_TRUE(
      same_bits(read_exr<float>(at + "sky_visibility/000002.exr", {"Y"}), frame.get<float>("sky_visibility")));
  EXPECT_FALSE(same_bits(read_exr<float>(at + "depth/000001.exr", {"Y"}), frame.measured_depth));

  const std::string flow = read_text(at + "flow/000002.flo");
  ASSERT_EQ(flow.size(), 12 + 96 * 64 * 8u);
  EXPECT_EQ(flow.substr(0, 4), "PIEH");
  for (std::size_t i = 0; i < frame.get<float>("flow").size(); ++i) {
    float value;
    std::memcpy(&value, flow.data() + 12 + 4 * i, 4);
    if (std::isnan(frame.get<float>("flow")[i]))
      ASSERT_GT(value, 1e9f);
    else
      ASSERT_EQ(value, frame.get<float>("flow")[i]);
  }
}

TEST(Frames, TablesHoldPosesImuEventsAndTheLegend) {
  ScratchFolder folder;
  record(make_frames_recorder(folder / "frames", test::full_recording(), 2));
  const auto poses = rows_of(folder / "frames/poses.csv", ',');
  ASSERT_EQ(poses.size(), 1u + kFrames);
  const Frame frame = make_full_frame(1);
  EXPECT_EQ(poses[2][1], std::to_string(frame.stamp_ns));
  EXPECT_EQ(std::stod(poses[2][5]), frame.world_from_camera.rotation.w);
  const auto events = rows_of(folder / "frames/events.txt", ' ');
  EXPECT_EQ(events.size(), 6u + 7u);
  EXPECT_EQ(events[0], (std::vector<std::string>{"1.000001000", "0", "0", "1"}));
  EXPECT_EQ(rows_of(folder / "frames/imu.csv", ',').size(), 1u + 1 + 5 + 5);
  EXPECT_NE(read_text(folder / "frames/legend.json").find("\"name\":\"brick\""), std::string::npos);
  EXPECT_NE(read_text(folder / "frames/camera.json").find("\"lens\": \"plumb_bob\""),
            std::string::npos);
}

// A killed run leaves "NAME.part"; the next one starts afresh.
TEST(DatasetFolder, ReplacesWhatAKilledRunLeft) {
  ScratchFolder folder;
  {
    auto killed = make_tum_recorder(folder / "other", {}, 1);
    killed->write(make_full_frame(0));
    test::run_command("cp -r " + (folder / "other.part") + " " + (folder / "tum.part"));
  }
  record(make_tum_recorder(folder / "tum", {}, 1));
  EXPECT_EQ(folder.names(), std::vector<std::string>{"tum"});
  EXPECT_EQ(rows_of(folder / "tum/rgb.txt", ' ').size(), std::size_t(kFrames));
}

}  // namespace dataset_folders_test
}  // namespace rubble
