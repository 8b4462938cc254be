#include "io/datasets/colmap_recorder.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "io/base/folder_writer.h"
#include "io/image/image_file.h"
#include "io/recording/frame_order.h"
#include "kernel/base/number_text.h"

namespace rubble {
namespace {

std::string camera_line(int id, const Intrinsics& k) {
  const auto& d = k.distortion;
  const bool plain = std::all_of(d.begin(), d.end(), [](double v) { return v == 0; });
  std::string model;
  std::vector<double> numbers{k.fx, k.fy, k.cx + 0.5, k.cy + 0.5};
  if (k.lens == LensModel::fisheye) {
    model = "OPENCV_FISHEYE";
    numbers.insert(numbers.end(), d.begin(), d.begin() + 4);
  } else if (plain) {
    model = "PINHOLE";
  } else {
    model = d[4] == 0 ? "OPENCV" : "FULL_OPENCV";
    numbers.insert(numbers.end(), d.begin(), d.begin() + 4);
    if (d[4] != 0) numbers.insert(numbers.end(), {d[4], 0, 0, 0});  // k3, and no k4 to k6
  }
  std::string line = std::to_string(id) + " " + model + " " + std::to_string(k.width) + " " + std::to_string(k.height);
  for (const double number : numbers) line += " " + exact_text(number);
  return line + "\n";
}

// Quaternion and translation, as all lists have them.
std::string pose_words(const Pose& pose) {
  const Quat& q = pose.rotation;
  const Vec3& t = pose.translation;
  std::string words;
  for (const double value : {q.w, q.x, q.y, q.z, t.x, t.y, t.z}) words += " " + exact_text(value);
  return words;
}

// A camera of the model: one of the recording, or the right one of its pair.
struct ColmapEye {
  int camera = 0;  // number among those of the recording
  bool right = false;
  std::string prefix;  // of its pictures' names: "front/left/"
  std::optional<Intrinsics> intrinsics{};  // of its first picture
  std::vector<std::string> pictures{};     // what follows the number of each in images.txt
  std::size_t first_number = 1;            // of its pictures; known at the end
};

// What has one carrier: its eyes stay where they are relative to each other.
struct ColmapRig {
  std::string carrier;
  std::vector<int> eyes;  // the first one is the reference
};

// A pose of a rig and the pictures that belong to it.
struct ColmapInstant {
  int rig = 0;
  Pose rig_from_world;
  std::vector<std::pair<int, std::size_t>> pictures;  // eye, and index among its pictures
};

class ColmapRecorder : public Recorder {
 public:
  ColmapRecorder(const std::string& path, const Recording& recording, int threads)
      : recording_(recording), eyes_(list_eyes(recording)), rigs_(list_rigs(recording, eyes_)),
        order_(path, channels_of(recording)), folder_(path, folders(), threads) {}

  void write(const Frame& frame) override {
    order_.check(frame);
    if (frame.stamp_ns != last_ns_) ++instant_;
    last_ns_ = frame.stamp_ns;
    for (std::size_t i = 0; i < eyes_.size(); ++i)
      if (eyes_[i].camera == frame.sensor) add(int(i), frame);
  }

  void finish() override {
    std::string cameras = "# CAMERA_ID MODEL WIDTH HEIGHT PARAMS[]\n";
    for (std::size_t i = 0; i < eyes_.size(); ++i)
      if (eyes_[i].intrinsics) cameras += camera_line(int(i) + 1, *eyes_[i].intrinsics);
    folder_.write("sparse/cameras.txt", cameras);
    folder_.write("sparse/images.txt",
                  "# IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME, then POINTS2D[] as X Y POINT3D_ID\n" + list_images());
    folder_.write("sparse/points3D.txt", "# POINT3D_ID X Y Z R G B ERROR TRACK[]\n");
    // A single camera is its own rig: COLMAP makes that itself.
    if (eyes_.size() > 1) write_rigs();
    folder_.finish();
  }

 private:
  static std::vector<ColmapEye> list_eyes(const Recording& recording) {
    std::vector<ColmapEye> eyes;
    for (std::size_t i = 0; i < recording.cameras.size(); ++i) {
      const CameraRecord& camera = recording.cameras[i];
      const std::string own = recording.cameras.size() > 1 ? camera.name + "/" : "";
      eyes.push_back({int(i), false, own + (camera.channels.right ? "left/" : "")});
      if (camera.channels.right) eyes.push_back({int(i), true, own + "right/"});
    }
    return eyes;
  }

  static std::vector<ColmapRig> list_rigs(const Recording& recording, const std::vector<ColmapEye>& eyes) {
    std::vector<ColmapRig> rigs;
    for (std::size_t i = 0; i < eyes.size(); ++i) {
      const std::string& carrier = recording.cameras[std::size_t(eyes[i].camera)].carrier;
      const auto known = std::find_if(rigs.begin(), rigs.end(), [&](const ColmapRig& rig) { return rig.carrier == carrier; });
      if (known == rigs.end())
        rigs.push_back({carrier, {int(i)}});
      else
        known->eyes.push_back(int(i));
    }
    return rigs;
  }

  std::vector<std::string> folders() const {
    std::vector<std::string> names{"sparse"};
    for (const ColmapEye& eye : eyes_) {
      const std::string folder = "images/" + eye.prefix;
      names.push_back(folder.substr(0, folder.size() - 1));
    }
    return names;
  }

  // Of the pictures of an eye, in the body of its camera.
  Pose camera_from_eye(const ColmapEye& eye) const {
    const double baseline = eye.right ? recording_.cameras[std::size_t(eye.camera)].baseline : 0;
    return {camera_from_optical.rotation, {0, -baseline, 0}};
  }
  Pose carrier_from_eye(const ColmapEye& eye) const {
    return recording_.cameras[std::size_t(eye.camera)].in_rig(camera_from_eye(eye));
  }
  const ColmapEye& reference_of(const ColmapRig& rig) const { return eyes_[std::size_t(rig.eyes.front())]; }
  Pose eye_from_reference(const ColmapRig& rig, int eye) const {
    return carrier_from_eye(eyes_[std::size_t(eye)]).inverse() * carrier_from_eye(reference_of(rig));
  }

  void add(int number, const Frame& frame) {
    ColmapEye& eye = eyes_[std::size_t(number)];
    const Intrinsics& k = frame.intrinsics;
    if (!eye.intrinsics) eye.intrinsics = k;
    const std::string name = eye.prefix + index_text(instant_) + ".png";
    folder_.add("images/" + name, [image = RgbImage{k.width, k.height, eye.right ? frame.rgb_right : frame.rgb}] {
      return encode_png(image);
    });
    note_instant(number, frame);
    eye.pictures.push_back(pose_words((frame.world_from_camera * camera_from_eye(eye)).inverse()) + " " +
                           std::to_string(number + 1) + " " + name + "\n\n");  // no points
  }

  // Camera after camera, as pictures are numbered in a database that they are read into with their calibrations: COLMAP
  // takes the numbers of the one for those of the other.
  std::string list_images() {
    std::string images;
    std::size_t number = 1;
    for (ColmapEye& eye : eyes_) {
      eye.first_number = number;
      for (const std::string& picture : eye.pictures) images += std::to_string(number++) + picture;
    }
    return images;
  }

  // Of a picture that comes next in its eye's list.
  void note_instant(int number, const Frame& frame) {
    const auto of_eye = [&](const ColmapRig& rig) { return std::count(rig.eyes.begin(), rig.eyes.end(), number) > 0; };
    const auto rig = int(std::find_if(rigs_.begin(), rigs_.end(), of_eye) - rigs_.begin());
    ColmapInstant& instant = instants_[{frame.stamp_ns, rig}];
    if (instant.pictures.empty()) {
      instant.rig = rig;
      instant.rig_from_world = (frame.world_from_rig * carrier_from_eye(reference_of(rigs_[std::size_t(rig)]))).inverse();
    }
    instant.pictures.emplace_back(number, eyes_[std::size_t(number)].pictures.size());
  }

  void write_rigs() {
    std::string rigs = "# RIG_ID NUM_SENSORS REF_SENSOR_TYPE REF_SENSOR_ID SENSORS[] as SENSOR_TYPE SENSOR_ID HAS_POSE QW "
                       "QX QY QZ TX TY TZ\n";
    nlohmann::ordered_json config = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < rigs_.size(); ++i) {
      const ColmapRig& rig = rigs_[i];
      rigs += std::to_string(i + 1) + " " + std::to_string(rig.eyes.size()) + " CAMERA " + std::to_string(rig.eyes.front() + 1);
      auto& cameras = config.emplace_back(nlohmann::ordered_json::object())["cameras"];
      cameras.push_back({{"image_prefix", reference_of(rig).prefix}, {"ref_sensor", true}});
      for (std::size_t k = 1; k < rig.eyes.size(); ++k) {
        const Pose pose = eye_from_reference(rig, rig.eyes[k]);
        rigs += " CAMERA " + std::to_string(rig.eyes[k] + 1) + " 1" + pose_words(pose);
        const Quat& q = pose.rotation;
        const Vec3& t = pose.translation;
        cameras.push_back({{"image_prefix", eyes_[std::size_t(rig.eyes[k])].prefix},
                           {"cam_from_rig_rotation", {q.w, q.x, q.y, q.z}},
                           {"cam_from_rig_translation", {t.x, t.y, t.z}}});
      }
      rigs += "\n";
    }
    folder_.write("sparse/rigs.txt", rigs);
    folder_.write("rig_config.json", config.dump(1) + "\n");
    std::string frames = "# FRAME_ID RIG_ID QW QX QY QZ TX TY TZ (rig from world) NUM_DATA_IDS DATA_IDS[] as SENSOR_TYPE "
                         "SENSOR_ID DATA_ID\n";
    int number = 0;
    for (const auto& [when, instant] : instants_) {
      frames += std::to_string(++number) + " " + std::to_string(instant.rig + 1) + pose_words(instant.rig_from_world) + " " +
                std::to_string(instant.pictures.size());
      for (const auto& [eye, index] : instant.pictures)
        frames += " CAMERA " + std::to_string(eye + 1) + " " + std::to_string(eyes_[std::size_t(eye)].first_number + index);
      frames += "\n";
    }
    folder_.write("sparse/frames.txt", frames);
  }

  Recording recording_;
  std::vector<ColmapEye> eyes_;
  std::vector<ColmapRig> rigs_;
  FrameOrder order_;
  FolderWriter folder_;
  std::int64_t last_ns_ = -1;
  int instant_ = -1;  // number of the stamp: pictures of one instant have one name, by which COLMAP puts rigs together
  std::map<std::pair<std::int64_t, int>, ColmapInstant> instants_;  // by stamp and rig
};

}  // namespace

std::unique_ptr<Recorder> make_colmap_recorder(const std::string& path, const Recording& recording,
                                               int threads) {
  Recording kept = recording;  // what the format has a place for
  for (CameraRecord& camera : kept.cameras) {
    const bool right = camera.channels.right;
    camera.channels = {};
    camera.channels.right = right;
  }
  return std::make_unique<ColmapRecorder>(path, kept, threads);
}

}  // namespace rubble
