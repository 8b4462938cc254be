#include "io/datasets/euroc_recorder.h"

#include <locale>
#include <sstream>

#include "io/base/folder_writer.h"
#include "io/datasets/pose_rows.h"
#include "io/image/image_file.h"
#include "io/recording/frame_order.h"
#include "kernel/base/number_text.h"

namespace rubble {
namespace {

std::string row(std::int64_t stamp_ns, const std::vector<double>& values) {
  std::string line = std::to_string(stamp_ns);
  for (const double value : values) line += "," + exact_text(value);
  return line + "\n";
}

std::string list(const std::vector<double>& values) {
  std::string text = "[";
  for (const double value : values) text += (text.size() > 1 ? ", " : "") + exact_text(value);
  return text + "]";
}

// Where a sensor sits in the body, as 4x4 row by row.
std::string mounting(const Pose& body_from_sensor) {
  const auto rows = pose_rows(body_from_sensor);
  std::vector<double> values(rows.begin(), rows.end());
  for (const double v : {0.0, 0.0, 0.0, 1.0}) values.push_back(v);
  return "T_BS:\n  cols: 4\n  rows: 4\n  data: " + list(values) + "\n";
}

// Empty for one picture. To six digits: a period of whole nanoseconds has no more.
std::string rate_row(std::int64_t period_ns) {
  if (period_ns <= 0) return "";
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << "rate_hz: " << 1e9 / static_cast<double>(period_ns) << "\n";
  return text.str();
}

std::string camera_yaml(const Intrinsics& k, const Pose& body_from_optical, std::int64_t period_ns) {
  const bool fisheye = k.lens == LensModel::fisheye;
  std::vector<double> distortion(k.distortion.begin(), k.distortion.begin() + 4);
  if (!fisheye && k.distortion[4] != 0) distortion.push_back(k.distortion[4]);
  return "sensor_type: camera\ncomment: simulated by Rubble\n" + mounting(body_from_optical) +
         rate_row(period_ns) + "resolution: [" + std::to_string(k.width) + ", " +
         std::to_string(k.height) +
         "]\ncamera_model: pinhole\nintrinsics: " + list({k.fx, k.fy, k.cx, k.cy}) +
         "\ndistortion_model: " + (fisheye ? "equidistant" : "radial-tangential") +
         "\ndistortion_coefficients: " + list(distortion) + "\n";
}

// The body is the rig, or the link that carries the cameras; a unit on a link is on that one, or on the one of the rig.
Pose body_from_imu(const Recording& recording, const ImuRecord& imu) {
  if (imu.carrier.empty() || !recording.cameras.front().carrier.empty() || !recording.mount) return imu.rig_from_imu;
  return recording.mount->parent_from_rig.inverse() * imu.rig_from_imu;
}

std::string imu_yaml(const ImuRecord& imu, const Pose& body_from_imu) {
  const ImuModel& model = imu.model;
  return "sensor_type: imu\ncomment: simulated by Rubble\n" + mounting(body_from_imu) +
         "rate_hz: " + exact_text(model.rate_hz) +
         "\ngyroscope_noise_density: " + exact_text(model.gyroscope_noise) +
         "\ngyroscope_random_walk: " + exact_text(model.gyroscope_walk) +
         "\naccelerometer_noise_density: " + exact_text(model.accelerometer_noise) +
         "\naccelerometer_random_walk: " + exact_text(model.accelerometer_walk) + "\n";
}

// A picture folder: a camera, or the right one of its pair.
struct EurocCamera {
  std::string name;  // "cam0"
  int camera = 0;    // number among those of the recording
  bool right = false;
};

// In the order of the cameras, each followed by its right one.
std::vector<EurocCamera> number_cameras(const Recording& recording) {
  std::vector<EurocCamera> cameras;
  const auto add = [&](int camera, bool right) {
    cameras.push_back({"cam" + std::to_string(cameras.size()), camera, right});
  };
  for (std::size_t i = 0; i < recording.cameras.size(); ++i) {
    add(int(i), false);
    if (recording.cameras[i].channels.right) add(int(i), true);
  }
  return cameras;
}

class EurocRecorder : public Recorder {
 public:
  EurocRecorder(const std::string& path, const Recording& recording, int threads)
      : recording_(recording),
        cameras_(number_cameras(recording)),
        seen_(recording.cameras.size()),
        order_(path, channels_of(recording)),
        folder_(path, folders(), threads),
        imus_(recording.imus.size(),
              "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],"
              "a_RS_S_x [m s^-2],a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]\n") {}

  void write(const Frame& frame) override {
    order_.check(frame);
    Seen& seen = seen_[std::size_t(frame.sensor)];
    if (frame.index == 0) seen.first = header_of(frame);
    if (frame.index == 1) seen.period_ns = frame.stamp_ns - seen.first.stamp_ns;
    const std::string stamp = sorted_stamp_text(frame.stamp_ns), name = stamp + ".png";  // programs make the one of the other
    for (const EurocCamera& c : cameras_)
      if (c.camera == frame.sensor)
        add_picture("mav0/" + c.name + "/data/" + name, frame,
                    c.right ? frame.rgb_right : frame.rgb);
    seen.pictures += stamp + "," + name + "\n";
    if (frame.stamp_ns != last_state_ns_) add_state(frame);
  }

  void write_imu(const ImuSample& s) override {
    const Vec3 &w = s.angular_velocity, &a = s.linear_acceleration;
    imus_.at(std::size_t(s.sensor)) += row(s.stamp_ns, {w.x, w.y, w.z, a.x, a.y, a.z});
    if (s.sensor == 0) last_imu_ = s;
  }

  void finish() override {
    for (const EurocCamera& camera : cameras_) write_camera(camera);
    for (std::size_t i = 0; i < imus_.size(); ++i) {
      folder_.write(folder_of_imu(i) + "/data.csv", imus_[i]);
      folder_.write(folder_of_imu(i) + "/sensor.yaml", imu_yaml(recording_.imus[i], body_from_imu(recording_, recording_.imus[i])));
    }
    folder_.write("mav0/state_groundtruth_estimate0/data.csv", states_);
    folder_.write("mav0/state_groundtruth_estimate0/sensor.yaml",
                  "sensor_type: visual-inertial\ncomment: the simulated truth\n" + mounting({}));
    folder_.finish();
  }

 private:
  // What is known of a camera of the recording.
  struct Seen {
    Frame first;  // without its pictures
    std::int64_t period_ns = 0;
    std::string pictures = "#timestamp [ns],filename\n";
  };

  static std::string folder_of_imu(std::size_t number) { return "mav0/imu" + std::to_string(number); }

  std::vector<std::string> folders() const {
    std::vector<std::string> names{"mav0/state_groundtruth_estimate0"};
    for (const EurocCamera& camera : cameras_) names.push_back("mav0/" + camera.name + "/data");
    for (std::size_t i = 0; i < recording_.imus.size(); ++i) names.push_back(folder_of_imu(i));
    return names;
  }

  // A frame without its pictures.
  static Frame header_of(const Frame& frame) {
    Frame header;
    header.stamp_ns = frame.stamp_ns;
    header.intrinsics = frame.intrinsics;
    header.baseline = frame.baseline;
    return header;
  }

  void add_picture(const std::string& name, const Frame& frame,
                   const std::vector<std::uint8_t>& rgb) {
    folder_.add(name, [image = RgbImage{frame.intrinsics.width, frame.intrinsics.height, rgb}] {
      return encode_png(to_gray(image));
    });
  }

  // Of the rig, once for all frames of one instant.
  void add_state(const Frame& frame) {
    last_state_ns_ = frame.stamp_ns;
    const Vec3 &p = frame.world_from_rig.translation, &v = frame.rig_velocity;
    const Quat& q = frame.world_from_rig.rotation;
    const Vec3 &bw = last_imu_.angular_bias, &ba = last_imu_.acceleration_bias;
    states_ += row(frame.stamp_ns, {p.x, p.y, p.z, q.w, q.x, q.y, q.z, v.x, v.y, v.z, bw.x, bw.y,
                                    bw.z, ba.x, ba.y, ba.z});
  }

  void write_camera(const EurocCamera& camera) {
    const Seen& seen = seen_[std::size_t(camera.camera)];
    Pose camera_from_eye = camera_from_optical;
    if (camera.right) camera_from_eye.translation = {0, -seen.first.baseline, 0};
    const Pose body_from_eye =
        recording_.cameras[std::size_t(camera.camera)].in_rig(camera_from_eye);
    folder_.write("mav0/" + camera.name + "/data.csv", seen.pictures);
    folder_.write("mav0/" + camera.name + "/sensor.yaml",
                  camera_yaml(seen.first.intrinsics, body_from_eye, seen.period_ns));
  }

  Recording recording_;
  std::vector<EurocCamera> cameras_;
  std::vector<Seen> seen_;  // of each camera of the recording
  FrameOrder order_;
  FolderWriter folder_;
  std::int64_t last_state_ns_ = -1;
  ImuSample last_imu_;  // of the first unit
  // The tables, so far.
  std::vector<std::string> imus_;  // by unit
  std::string states_ =
      "#timestamp,p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],q_RS_w [],q_RS_x [],q_RS_y [],q_RS_z [],"
      "v_RS_R_x [m s^-1],v_RS_R_y [m s^-1],v_RS_R_z [m s^-1],b_w_RS_S_x [rad s^-1],"
      "b_w_RS_S_y [rad s^-1],b_w_RS_S_z [rad s^-1],b_a_RS_S_x [m s^-2],b_a_RS_S_y [m s^-2],"
      "b_a_RS_S_z [m s^-2]\n";
};

}  // namespace

std::unique_ptr<Recorder> make_euroc_recorder(const std::string& path, const Recording& recording,
                                              int threads) {
  Recording kept = recording;  // what the format has a place for
  for (CameraRecord& camera : kept.cameras) {
    const bool right = camera.channels.right;
    camera.channels = {};
    camera.channels.right = right;
  }
  return std::make_unique<EurocRecorder>(path, kept, threads);
}

}  // namespace rubble
