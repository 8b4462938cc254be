// KITTI odometry, nerfstudio, COCO, WebDataset, rigs of COLMAP: their numbers against the frames that went in.
// tests/datasets reads them by the programs of others.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "io/base/little_endian.h"
#include "io/datasets/colmap_recorder.h"
#include "io/datasets/dataset_recorders.h"
#include "io/datasets/euroc_recorder.h"
#include "io/datasets/frames_recorder.h"
#include "io/image/image_file.h"
#include "kernel/base/error.h"
#include "kernel/base/portable_math.h"
#include "tests/io/support.h"

namespace rubble {
namespace dataset_recorders_test {

using Json = nlohmann::json;
using test::make_full_frame;
using test::read_text;
using test::ScratchFolder;

constexpr int kFrames = 3;

void record(std::unique_ptr<Recorder> recorder) {
  for (int i = 0; i < kFrames; ++i) test::write_full(*recorder, i);
  recorder->finish();
}

std::vector<std::vector<double>> numbers_in(const std::string& text) {
  std::vector<std::vector<double>> rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    rows.emplace_back();
    std::istringstream words(line);
    for (std::string word; words >> word;)
      if (word.back() != ':') rows.back().push_back(std::stod(word));
  }
  return rows;
}

Pose optical_pose(int index) { return make_full_frame(index).world_from_camera * camera_from_optical; }

// --- KITTI ---

constexpr Vec3 kMark{5, 2, 0.5};  // a point of the world that all rays hit

Pose scanner_pose(std::int64_t stamp_ns) {
  const double t = double(stamp_ns - 1'000'000'000) * 1e-9;
  return {portable::quat_from_rpy(0.01, 0.02, 0.5 * t), {2 * t, -t, 1}};
}

Recording with_scanner() {
  Recording recording;
  LidarSpec spec;
  spec.elevations_deg = {0};
  spec.delays_ns = {0};
  spec.columns = 30;
  spec.column_ns = 1'000'000;
  LidarSpec planar = spec;
  planar.pattern = LidarPattern::planar;  // is passed over
  for (const LidarSpec& of : {planar, spec})
    recording.sensors.push_back({"scanner", "", "", "", {}, std::make_shared<test::FixedScans>(of)});
  return recording;
}

Reading scan_of_mark(std::int64_t stamp_ns) {
  RangeScan scan;
  scan.stamp_ns = stamp_ns;
  for (int i = 0; i < 34; ++i) scan.world_from_sensor.push_back(scanner_pose(stamp_ns + i * RangeScan::kMotionStep));
  for (int i = 0; i < 30; ++i) {
    const Vec3 p = scan.world_from_sensor[std::size_t(i)].inverse() * kMark;
    scan.points.push_back({float(p.x), float(p.y), float(p.z), 50, float(i) * 1e-3f, 0, std::uint16_t(i)});
  }
  return {1, stamp_ns, {}, std::make_shared<const RangeScan>(scan)};
}

void write_scanned(Recorder& recorder, int index, bool scanned = true) {
  const Frame frame = test::make_frame(index);
  if (scanned) recorder.write_reading(scan_of_mark(frame.stamp_ns));
  recorder.write(frame);
}

TEST(KittiOdometry, ScansAreFreeOfTheMotionOfTheirSensor) {
  ScratchFolder folder;
  const auto recorder = make_kitti_odometry_recorder(folder / "kitti", with_scanner(), 1);
  for (int i = 0; i < kFrames; ++i) write_scanned(*recorder, i);
  recorder->finish();
  const std::string sequence = folder / "kitti/sequences/00/";
  const auto calibration = numbers_in(read_text(sequence + "calib.txt"));
  const Vec3 expected = optical_pose(0).inverse() * kMark;
  for (int i = 0; i < kFrames; ++i) {
    const std::string bytes = read_text(sequence + "velodyne/00000" + std::to_string(i) + ".bin");
    ASSERT_EQ(bytes.size(), 30u * 16);
    std::string_view left = bytes;
    const Vec3 wanted = scanner_pose(test::make_frame(i).stamp_ns).inverse() * kMark;
    for (float x, y, z, intensity; take(left, x) && take(left, y) && take(left, z) && take(left, intensity);) {
      EXPECT_LT(distance(Vec3{x, y, z}, wanted), 1e-5);
      EXPECT_EQ(intensity, 0.5f);
      if (i > 0) continue;
      const std::vector<double>& tr = calibration[4];
      for (int axis = 0; axis < 3; ++axis) {
        const auto row = std::size_t(4 * axis);
        EXPECT_NEAR(tr[row] * double(x) + tr[row + 1] * double(y) + tr[row + 2] * double(z) + tr[row + 3], expected[axis], 1e-5);
      }
    }
  }
}

TEST(KittiOdometry, PosesBeginAtTheFirstPicture) {
  ScratchFolder folder;
  record(make_kitti_odometry_recorder(folder / "kitti", test::full_recording(), 2));
  const auto poses = numbers_in(read_text(folder / "kitti/poses/00.txt"));
  ASSERT_EQ(poses.size(), std::size_t(kFrames));
  EXPECT_EQ(poses[0], (std::vector<double>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}));
  const Pose moved = optical_pose(0).inverse() * optical_pose(2);
  EXPECT_NEAR(poses[2][3], moved.translation.x, 1e-8);
  EXPECT_NEAR(poses[2][11], moved.translation.z, 1e-8);
  const std::string sequence = folder / "kitti/sequences/00/";
  const auto calibration = numbers_in(read_text(sequence + "calib.txt"));
  const Intrinsics k = make_full_frame(0).intrinsics;
  EXPECT_NEAR(calibration[3][3], -k.fx * 0.12, 1e-8);  // P3
  EXPECT_EQ(calibration[2][3], 0);
  EXPECT_EQ(read_rgb_png(sequence + "image_3/000001.png").rgb, make_full_frame(1).rgb_right);
  EXPECT_EQ(read_text(sequence + "times.txt").substr(0, 24), "0.000000000\n0.033333333\n");
}

TEST(KittiOdometry, LeavesOutLastPicturesWithoutAScanAndRefusesAGap) {
  ScratchFolder folder;
  const auto last = make_kitti_odometry_recorder(folder / "last", with_scanner(), 1);
  for (int i = 0; i < kFrames; ++i) write_scanned(*last, i, i < 2);
  last->finish();
  EXPECT_EQ(numbers_in(read_text(folder / "last/poses/00.txt")).size(), 2u);
  const auto gap = make_kitti_odometry_recorder(folder / "gap", with_scanner(), 1);
  write_scanned(*gap, 0);
  write_scanned(*gap, 1, false);
  EXPECT_THROW(write_scanned(*gap, 2), RunError);
}

// --- Several inertial units ---

TEST(Euroc, EachInertialUnitHasItsOwnTable) {
  ScratchFolder folder;
  Recording recording = test::full_recording();
  recording.imus.push_back(recording.imus.front());
  const auto euroc = make_euroc_recorder(folder / "euroc", recording, 1);
  const auto frames = make_frames_recorder(folder / "frames", recording, 1);
  for (Recorder* recorder : {euroc.get(), frames.get()}) {
    for (int unit = 0; unit < 2; ++unit)
      for (int i = 0; i < 3 - unit; ++i) {
        ImuSample sample;
        sample.sensor = unit, sample.stamp_ns = 1'000'000'000 + i, sample.angular_velocity.x = 10 * unit + i;
        recorder->write_imu(sample);
      }
    recorder->write(make_full_frame(0));
    recorder->finish();
  }
  const auto second = read_text(folder / "euroc/mav0/imu1/data.csv");
  EXPECT_EQ(second.substr(second.find('\n') + 1), "1000000000,10,0,0,0,0,0\n1000000001,11,0,0,0,0,0\n");
  const auto first = read_text(folder / "euroc/mav0/imu0/data.csv");
  EXPECT_EQ(first.substr(first.find('\n') + 1, 24), "1000000000,0,0,0,0,0,0\n1");
  EXPECT_EQ(std::count(first.begin(), first.end(), '\n'), 4);
  const auto table = read_text(folder / "frames/imu.csv");  // of the unit beside the camera
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 4);
}

// --- nerfstudio ---

TEST(Nerfstudio, PosesAreThoseOfOpenglAndPointsLieOnTheScene) {
  ScratchFolder folder;
  record(make_nerfstudio_recorder(folder / "nerf", test::full_recording(), {}, 2));
  const Json json = Json::parse(read_text(folder / "nerf/transforms.json"));
  EXPECT_EQ(json["camera_model"], "OPENCV");
  EXPECT_EQ(json["cx"], make_full_frame(0).intrinsics.cx + 0.5);
  ASSERT_EQ(json["frames"].size(), std::size_t(kFrames));
  for (int i = 0; i < kFrames; ++i) {
    const Json& matrix = json["frames"][std::size_t(i)]["transform_matrix"];
    const Pose pose = optical_pose(i);
    for (int axis = 0; axis < 3; ++axis) {
      const Json& row = matrix[std::size_t(axis)];
      EXPECT_NEAR(double(row[3]), pose.translation[axis], 1e-12);
      EXPECT_NEAR(double(row[0]), pose.rotation.matrix().rows[axis].x, 1e-12);
      EXPECT_NEAR(double(row[2]), -pose.rotation.matrix().rows[axis].z, 1e-12);  // backwards
    }
    EXPECT_EQ(read_rgb_png(folder / ("nerf/" + std::string(json["frames"][std::size_t(i)]["file_path"]))).rgb, make_full_frame(i).rgb);
  }
  const std::string ply = read_text(folder / "nerf/sparse_pc.ply"), end = "end_header\n";
  std::string_view left = std::string_view(ply).substr(ply.find(end) + end.size());
  EXPECT_GT(left.size(), 100u * 15);
  while (!left.empty()) {
    float x = 0, y = 0, z = 0;
    ASSERT_TRUE(take(left, x) && take(left, y) && take(left, z));
    left.remove_prefix(3);
    EXPECT_LT(test::distance_to_scene({x, y, z}), 1e-4);
  }
}

// Of a rolling shutter the rows have poses of their own, by which their depth is.
TEST(Nerfstudio, PointsAreByThePosesOfRows) {
  ScratchFolder folder;
  Frame frame = make_full_frame(0);
  frame.row_poses.assign(std::size_t(frame.intrinsics.height), optical_pose(0));
  frame.world_from_camera.translation += Vec3{0.2, 0.1, -0.1};
  const auto recorder = make_nerfstudio_recorder(folder / "nerf", test::full_recording(), {}, 1);
  recorder->write(frame);
  recorder->finish();
  const std::string ply = read_text(folder / "nerf/sparse_pc.ply"), end = "end_header\n";
  std::string_view left = std::string_view(ply).substr(ply.find(end) + end.size());
  EXPECT_GT(left.size(), 50u * 15);
  for (float x = 0, y = 0, z = 0; take(left, x) && take(left, y) && take(left, z); left.remove_prefix(3))
    ASSERT_LT(test::distance_to_scene({x, y, z}), 1e-4);
}

// --- COCO ---

// By the letters alone, as others unpack them.
std::vector<bool> unpack_mask(const std::string& letters, std::size_t pixels) {
  std::vector<long> counts;
  for (std::size_t at = 0; at < letters.size();) {
    long value = 0;
    int shift = 0;
    for (bool more = true; more; shift += 5) {
      const int letter = letters[at++] - 48;
      value |= long(letter & 31) << shift;
      more = letter & 32;
      if (!more && (letter & 16)) value -= 1L << (shift + 5);
    }
    counts.push_back(value + (counts.size() > 2 ? counts[counts.size() - 2] : 0));
  }
  std::vector<bool> mask;
  for (std::size_t i = 0; i < counts.size(); ++i) mask.insert(mask.end(), std::size_t(counts[i]), i % 2 == 1);
  EXPECT_EQ(mask.size(), pixels);
  return mask;
}

TEST(Coco, MasksAndBoxesAreThoseOfThePieces) {
  ScratchFolder folder;
  Recording recording = test::full_recording();
  recording.legend.pieces[1].victim = true;
  record(make_coco_recorder(folder / "coco", recording, 2));
  const Json json = Json::parse(read_text(folder / "coco/annotations.json"));
  ASSERT_EQ(json["images"].size(), std::size_t(kFrames));
  ASSERT_EQ(json["annotations"].size(), 2u * kFrames);  // two pieces in each picture
  EXPECT_EQ(json["categories"][0]["supercategory"], "piece");
  EXPECT_EQ(json["categories"][1]["supercategory"], "victim");
  EXPECT_EQ(json["categories"][1]["name"], "slab \"7\"");
  for (const Json& annotation : json["annotations"]) {
    const Frame frame = make_full_frame(int(annotation["image_id"]) - 1);
    const auto width = std::size_t(frame.intrinsics.width), height = std::size_t(frame.intrinsics.height);
    const auto mask = unpack_mask(annotation["segmentation"]["counts"], width * height);
    std::size_t area = 0, left = width, top = height;
    for (std::size_t u = 0; u < width; ++u)
      for (std::size_t v = 0; v < height; ++v) {
        const bool inside = frame.get<std::uint32_t>("instance")[v * width + u] == annotation["instance"];
        ASSERT_EQ(mask[u * height + v], inside) << u << " " << v;
        if (inside) ++area, left = std::min(left, u), top = std::min(top, v);
      }
    EXPECT_EQ(annotation["area"], area);
    EXPECT_EQ(annotation["bbox"][0], left);
    EXPECT_EQ(annotation["bbox"][1], top);
    EXPECT_EQ(annotation["category_id"], 2 + int(annotation["instance"]));
  }
}

TEST(Coco, RefusesAPieceThatTheLegendDoesNotHave) {
  ScratchFolder folder;
  Recording recording = test::full_recording();
  recording.legend.pieces.pop_back();
  const auto recorder = make_coco_recorder(folder / "coco", recording, 1);
  EXPECT_THROW(test::write_full(*recorder, 0), RunError);
}

// --- WebDataset ---

TEST(WebDataset, IsReadByTarAndNumpy) {
  ScratchFolder folder;
  record(make_webdataset_recorder(folder / "web", test::full_recording(), 2));
  const std::string shard = folder / "web/rubble-000000.tar";
  const auto list = test::run_command("tar -tf " + shard);
  EXPECT_EQ(list.exit_code, 0) << list.output;
  EXPECT_EQ(list.output.substr(0, 48), "000000.rgb.png\n000000.right.png\n000000.depth.npy");
  const auto read = test::run_command(
      "tar -xOf " + shard + " 000001.normals.npy > " + (folder / "normals.npy") + " && tar -xOf " + shard +
      " 000001.instance.npy > " + (folder / "instance.npy") + " && " RUBBLE_PYTHON " -c \"import numpy; a = numpy.load('" +
      (folder / "normals.npy") + "'); b = numpy.load('" + (folder / "instance.npy") +
      "'); print(a.shape, a.dtype, b.shape, b.dtype, b.min()); a.tofile('" + (folder / "normals") + "')\"");
  EXPECT_EQ(read.output, "(64, 96, 3) float32 (64, 96) int32 -2\n");
  const Frame frame = make_full_frame(1);
  const std::vector<float>& normals = frame.get<float>("normals");
  const std::string bytes = read_text(folder / "normals");
  ASSERT_EQ(bytes.size(), normals.size() * sizeof(float));
  EXPECT_EQ(std::memcmp(bytes.data(), normals.data(), bytes.size()), 0);
  const auto json = test::run_command("tar -xOf " + shard + " 000002.json");
  EXPECT_EQ(Json::parse(json.output)["stamp_ns"], make_full_frame(2).stamp_ns);
}

// --- COLMAP's rigs ---

Pose pose_in(const std::vector<std::string>& words, std::size_t from) {
  std::vector<double> n;
  for (std::size_t i = from; i < from + 7; ++i) n.push_back(std::stod(words.at(i)));
  return {{n[0], n[1], n[2], n[3]}, {n[4], n[5], n[6]}};
}

std::vector<std::vector<std::string>> words_of(const std::string& path) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(read_text(path));
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream words(line);
    rows.emplace_back();
    for (std::string word; words >> word;) rows.back().push_back(word);
  }
  return rows;
}

// Two cameras, one of them stereo, of which the second has half the rate.
TEST(Colmap, RigsPutTheSensorsWhereTheirPicturesAre) {
  ScratchFolder folder;
  Recording recording;
  recording.cameras.resize(2);
  recording.cameras[0].name = "front";
  recording.cameras[0].channels.right = true;
  recording.cameras[0].baseline = 0.12;
  recording.cameras[1].name = "side";
  recording.cameras[1].rig_from_camera = {portable::quat_from_rpy(0, 0.1, 1.5), {0.1, 0.2, 0}};
  const auto recorder = make_colmap_recorder(folder / "colmap", recording, 1);
  for (int i = 0; i < 4; ++i) {
    Frame frame = make_full_frame(i);
    recorder->write(frame);
    if (i % 2 == 1) continue;
    frame.sensor = 1;
    frame.index = i / 2;
    frame.world_from_camera = frame.world_from_rig * recording.cameras[1].rig_from_camera;
    recorder->write(frame);
  }
  recorder->finish();
  const std::string sparse = folder / "colmap/sparse/";
  const auto rigs = words_of(sparse + "rigs.txt"), frames = words_of(sparse + "frames.txt"), images = words_of(sparse + "images.txt");
  ASSERT_EQ(words_of(sparse + "cameras.txt").size(), 3u);
  ASSERT_EQ(rigs.size(), 1u);
  ASSERT_EQ(rigs[0].size(), 4u + 2 * 10);
  ASSERT_EQ(frames.size(), 4u);
  std::size_t pictures = 0;
  for (const auto& frame : frames) {
    const Pose rig_from_world = pose_in(frame, 2);
    for (std::size_t at = 10; at < frame.size(); at += 3, ++pictures) {
      const int camera = std::stoi(frame[at + 1]);
      const auto& image = images.at(std::size_t(std::stoi(frame[at + 2]) - 1));
      EXPECT_EQ(image[8], frame[at + 1]);
      const Pose eye_from_rig = camera == 1 ? Pose() : pose_in(rigs[0], std::size_t(4 + 10 * (camera - 2) + 3));
      const Pose composed = eye_from_rig * rig_from_world, stated = pose_in(image, 1);
      EXPECT_LT(distance(composed.translation, stated.translation), 1e-9);
      EXPECT_NEAR(std::fabs((composed.rotation.conjugate() * stated.rotation).w), 1, 1e-12);
    }
  }
  EXPECT_EQ(pictures, images.size());
  // Pictures of one instant have one name, by which COLMAP's rig_configurator puts them together.
  EXPECT_TRUE(test::exists(folder / "colmap/images/front/right/000003.png"));
  EXPECT_TRUE(test::exists(folder / "colmap/images/side/000002.png"));
  EXPECT_FALSE(test::exists(folder / "colmap/images/side/000001.png"));
  EXPECT_EQ(Json::parse(read_text(folder / "colmap/rig_config.json"))[0]["cameras"][2]["image_prefix"], "side/");
}

}  // namespace dataset_recorders_test
}  // namespace rubble
