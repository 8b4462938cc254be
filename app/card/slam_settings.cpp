#include "app/card/slam_settings.h"

#include <algorithm>
#include <cstdio>
#include <optional>
#include <vector>

namespace rubble {
namespace {

// With a decimal point: OpenCV's reader tells whole numbers from real ones.
std::string real(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.10f", value);
  std::string number = text;
  while (number.back() == '0' && number[number.size() - 2] != '.') number.pop_back();
  return number == "-0.0" ? "0.0" : number;
}

std::string list(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ", ") + real(value);
  return "[" + text + "]";
}

std::string row(const std::string& key, double value) { return key + ": " + real(value) + "\n"; }
std::string row(const std::string& key, int value) { return key + ": " + std::to_string(value) + "\n"; }

// A place on the flying rig, or on a link of a robot.
struct Mount {
  Carrier carrier;  // with the name of the link; empty: the rig flies
  Pose carrier_from_it;
};

Mount mount_of(const Carrier& ride, const Pose& place, const Scenario& s, const FirstLinks& first_links) {
  Mount mount{ride, place};
  if (!ride.on() && s.trajectory.ride.on()) mount = {s.trajectory.ride, s.trajectory.ride.link_from_rig() * place};
  const auto first = first_links.find(mount.carrier.robot);
  if (mount.carrier.link.empty() && first != first_links.end()) mount.carrier.link = first->second;
  return mount;
}

// An inertial unit, and where it is in the body of a camera.
struct UnitBeside {
  ImuScenario unit;
  Pose body_from_imu;
};

// The first that moves with the camera.
std::optional<UnitBeside> find_unit(const Scenario& s, const MountedCamera& camera, const FirstLinks& first_links) {
  const Mount eye = mount_of(camera.ride, camera.rig_from_camera(), s, first_links);
  for (const ImuScenario& unit : s.imus) {
    if (unit.ride == camera.ride) return UnitBeside{unit, camera.rig_from_camera().inverse() * unit.rig_from_imu()};
    const Mount felt = mount_of(unit.ride, unit.rig_from_imu(), s, first_links);
    if (felt.carrier == eye.carrier) return UnitBeside{unit, eye.carrier_from_it.inverse() * felt.carrier_from_it};
  }
  return std::nullopt;
}

struct Camera {
  const Scenario& scenario;
  MountedCamera mounted;
  Intrinsics k;
  bool fisheye, stereo;
  std::optional<ImuScenario> imu;  // the first that moves with the camera
  Pose body_from_imu;

  Camera(const Scenario& s, const MountedCamera& of, const std::optional<UnitBeside>& beside)
      : scenario(s), mounted(of), k(mounted.camera.intrinsics()),
        fisheye(k.lens == LensModel::fisheye), stereo(mounted.camera.stereo_baseline > 0) {
    if (beside) imu = beside->unit, body_from_imu = beside->body_from_imu;
  }
  // radtan has no k3; what has one is said in the card.
  std::vector<double> four() const {
    return {k.distortion[0], k.distortion[1], k.distortion[2], k.distortion[3]};
  }
  double baseline() const { return mounted.camera.stereo_baseline; }
  double rate() const { return mounted.rate_hz.value_or(scenario.trajectory.rate_hz); }
  std::string topic() const { return mounted.topic(); }
};

// The rows of a 4 x 4 matrix that ends in 0 0 0 1.
using Rows = std::vector<std::vector<double>>;

// Points of the inertial unit in the optical frame (Z forward, X right) of the camera, or of the right one.
Rows optical_from_imu(const Camera& c, bool right) {
  const Mat3 turn = c.body_from_imu.rotation.matrix();
  const Vec3& shift = c.body_from_imu.translation;
  const auto row = [](const Vec3& v, double last, double sign) {
    return std::vector<double>{sign * v.x, sign * v.y, sign * v.z, last};
  };
  return {row(turn.rows[1], -shift.y - (right ? c.baseline() : 0), -1), row(turn.rows[2], -shift.z, -1),
          row(turn.rows[0], shift.x, 1), {0, 0, 0, 1}};
}

std::vector<double> inverse_of(const Rows& m) {
  std::vector<double> values;
  for (std::size_t i = 0; i < 3; ++i) {
    double shift = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      values.push_back(m[k][i]);
      shift -= m[k][i] * m[k][3];
    }
    values.push_back(shift);
  }
  values.insert(values.end(), {0, 0, 0, 1});
  return values;
}

std::string matrix(const Rows& rows, const std::string& indent) {
  std::string text;
  for (const std::vector<double>& row : rows) text += indent + "- " + list(row) + "\n";
  return text;
}

constexpr const char* kIdentity =
    "- [1.0, 0.0, 0.0, 0.0]\n- [0.0, 1.0, 0.0, 0.0]\n- [0.0, 0.0, 1.0, 0.0]\n- [0.0, 0.0, 0.0, 1.0]\n";
constexpr const char* kIdentity3 = "- [1.0, 0.0, 0.0]\n- [0.0, 1.0, 0.0]\n- [0.0, 0.0, 1.0]\n";
constexpr const char* kZero3 = "- [0.0, 0.0, 0.0]\n- [0.0, 0.0, 0.0]\n- [0.0, 0.0, 0.0]\n";

std::string indented(const std::string& lines, const std::string& by) {
  std::string text;
  for (std::size_t at = 0; at < lines.size();) {
    const std::size_t end = lines.find('\n', at);
    text += by + lines.substr(at, end - at) + "\n";
    at = end + 1;
  }
  return text;
}

std::string orb_camera(const Camera& c, const std::string& name) {
  const auto& d = c.k.distortion;
  std::string text = row(name + ".fx", c.k.fx) + row(name + ".fy", c.k.fy) +
                     row(name + ".cx", c.k.cx) + row(name + ".cy", c.k.cy) +
                     row(name + ".k1", d[0]) + row(name + ".k2", d[1]);
  if (c.fisheye) return text + row(name + ".k3", d[2]) + row(name + ".k4", d[3]);
  text += row(name + ".p1", d[2]) + row(name + ".p2", d[3]);
  return d[4] == 0 ? text : text + row(name + ".k3", d[4]);
}

std::string opencv_matrix(const std::string& key, const std::vector<double>& values) {
  return key + ": !!opencv-matrix\n   rows: 4\n   cols: 4\n   dt: f\n   data: " + list(values) + "\n";
}

std::string orbslam3(const Camera& c) {
  std::string text = "%YAML:1.0\n---\n# ORB-SLAM3. Depth of the TUM folder: 5000 = 1 m.\nFile.version: \"1.0\"\n";
  text += "Camera.type: \"" + std::string(c.fisheye ? "KannalaBrandt8" : "PinHole") + "\"\n";
  text += orb_camera(c, "Camera1");
  if (c.stereo) {
    text += orb_camera(c, "Camera2");
    text += opencv_matrix("Stereo.T_c1_c2", {1, 0, 0, c.baseline(), 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
  }
  text += row("Camera.width", c.k.width) + row("Camera.height", c.k.height) +
          row("Camera.fps", int(c.rate() + 0.5)) + row("Camera.RGB", 1) + row("Stereo.ThDepth", 40.0) +
          row("Stereo.b", c.stereo ? c.baseline() : 0.075) + row("RGBD.DepthMapFactor", 5000.0);
  if (c.imu) {
    const ImuModel& m = c.imu->model;
    text += opencv_matrix("IMU.T_b_c1", inverse_of(optical_from_imu(c, false))) +
            row("IMU.InsertKFsWhenLost", 0) + row("IMU.NoiseGyro", m.gyroscope_noise) +
            row("IMU.NoiseAcc", m.accelerometer_noise) + row("IMU.GyroWalk", m.gyroscope_walk) +
            row("IMU.AccWalk", m.accelerometer_walk) + row("IMU.Frequency", m.rate_hz);
  }
  return text +
         "ORBextractor.nFeatures: 1250\nORBextractor.scaleFactor: 1.2\nORBextractor.nLevels: 8\n"
         "ORBextractor.iniThFAST: 20\nORBextractor.minThFAST: 7\n"
         "Viewer.KeyFrameSize: 0.05\nViewer.KeyFrameLineWidth: 1.0\nViewer.GraphLineWidth: 0.9\n"
         "Viewer.PointSize: 2.0\nViewer.CameraSize: 0.08\nViewer.CameraLineWidth: 3.0\n"
         "Viewer.ViewpointX: 0.0\nViewer.ViewpointY: -0.7\nViewer.ViewpointZ: -3.5\nViewer.ViewpointF: 500.0\n";
}

std::string chain_camera(const Camera& c, int index) {
  const std::string name = "cam" + std::to_string(index);
  std::string text = name + ":\n";
  if (index == 1)
    text += "  T_cn_cnm1:\n" + matrix({{1, 0, 0, -c.baseline()}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}, "  ");
  if (c.imu) text += "  T_cam_imu:\n" + matrix(optical_from_imu(c, index == 1), "  ");
  text += "  cam_overlaps: " + std::string(c.stereo ? (index == 0 ? "[1]" : "[0]") : "[]") + "\n";
  text += "  camera_model: pinhole\n  distortion_model: " + std::string(c.fisheye ? "equidistant" : "radtan") +
          "\n  distortion_coeffs: " + list(c.four()) + "\n  intrinsics: " +
          list({c.k.fx, c.k.fy, c.k.cx, c.k.cy}) + "\n  resolution: [" + std::to_string(c.k.width) +
          ", " + std::to_string(c.k.height) + "]\n  rostopic: " +
          c.topic() + (index == 0 ? "/rgb/image_raw" : "/right/image_raw") + "\n";
  return c.imu ? text + "  timeshift_cam_imu: 0.0\n" : text;
}

std::string camera_chain(const Camera& c) {
  return chain_camera(c, 0) + (c.stereo ? chain_camera(c, 1) : "");
}

std::string kalibr_imu(const ImuScenario& imu) {
  const ImuModel& m = imu.model;
  return row("accelerometer_noise_density", m.accelerometer_noise) +
         row("accelerometer_random_walk", m.accelerometer_walk) +
         row("gyroscope_noise_density", m.gyroscope_noise) +
         row("gyroscope_random_walk", m.gyroscope_walk) + "rostopic: " + imu.ros_topic() + "\n" +
         row("update_rate", m.rate_hz);
}

std::string openvins_imu(const ImuScenario& imu) {
  std::string text = "%YAML:1.0\nimu0:\n  T_i_b:\n" + indented(kIdentity, "  ") + indented(kalibr_imu(imu), "  ");
  text += "  model: kalibr\n  time_offset: 0.0\n";
  for (const char* key : {"Tw", "R_IMUtoGYRO", "Ta", "R_IMUtoACC"})
    text += "  " + std::string(key) + ":\n" + indented(kIdentity3, "  ");
  return text + "  Tg:\n" + indented(kZero3, "  ");
}

std::string openvins_estimator(const Camera& c) {
  const std::string cameras = c.stereo ? "2" : "1";
  return "%YAML:1.0\nverbosity: \"INFO\"\nuse_fej: true\nintegration: \"rk4\"\nuse_stereo: " +
         std::string(c.stereo ? "true" : "false") + "\nmax_cameras: " + cameras +
         "\ncalib_cam_extrinsics: false\ncalib_cam_intrinsics: false\ncalib_cam_timeoffset: false\n"
         "calib_imu_intrinsics: false\ncalib_imu_g_sensitivity: false\nmax_clones: 11\nmax_slam: 50\n"
         "max_slam_in_update: 25\nmax_msckf_in_update: 40\ndt_slam_delay: 1\n" +
         row("gravity_mag", c.scenario.settle.gravity) +
         "feat_rep_msckf: \"GLOBAL_3D\"\nfeat_rep_slam: \"ANCHORED_MSCKF_INVERSE_DEPTH\"\n"
         "feat_rep_aruco: \"ANCHORED_MSCKF_INVERSE_DEPTH\"\ntry_zupt: false\ninit_window_time: 2.0\n"
         "init_imu_thresh: 0.5\ninit_max_disparity: 10.0\ninit_max_features: 50\ninit_dyn_use: true\n"
         "use_klt: true\nnum_pts: 200\nfast_threshold: 20\ngrid_x: 5\ngrid_y: 5\nmin_px_dist: 10\n"
         "knn_ratio: 0.7\ntrack_frequency: 31.0\ndownsample_cameras: false\nuse_mask: false\n"
         "relative_config_imu: \"kalibr_imu_chain.yaml\"\n"
         "relative_config_imucam: \"kalibr_imucam_chain.yaml\"\n";
}

std::string camera_yaml(const Camera& c) {
  const auto& d = c.k.distortion;
  const std::vector<double> k{c.k.fx, 0, c.k.cx, 0, c.k.fy, c.k.cy, 0, 0, 1};
  std::vector<double> distortion(d.begin(), d.begin() + (c.fisheye ? 4 : 5));
  const auto matrix = [](const std::string& key, int rows, int cols, const std::vector<double>& values) {
    return key + ":\n   rows: " + std::to_string(rows) + "\n   cols: " + std::to_string(cols) +
           "\n   data: " + list(values) + "\n";
  };
  return "%YAML:1.0\n---\ncamera_name: " + c.mounted.name + "\n" + row("image_width", c.k.width) +
         row("image_height", c.k.height) + matrix("camera_matrix", 3, 3, k) + "distortion_model: " +
         (c.fisheye ? "equidistant" : "plumb_bob") + "\n" +
         matrix("distortion_coefficients", 1, int(distortion.size()), distortion) +
         matrix("rectification_matrix", 3, 3, {1, 0, 0, 0, 1, 0, 0, 0, 1}) +
         matrix("projection_matrix", 3, 4, {c.k.fx, 0, c.k.cx, 0, 0, c.k.fy, c.k.cy, 0, 0, 0, 1, 0});
}

std::string rtabmap(const Camera& c) {
  return "[Core]\nRtabmap\\DetectionRate = 1\nRGBD\\Enabled = true\nRGBD\\LinearUpdate = 0.05\n"
         "RGBD\\AngularUpdate = 0.05\nMem\\STMSize = 30\nVis\\MinInliers = 15\nOdom\\Strategy = 0\n"
         "Reg\\Force3DoF = false\nStereo\\MaxDisparity = 256\nGrid\\3D = true\nGrid\\RangeMax = " +
         std::string(c.stereo ? "5" : "13") + "\n";
}

}  // namespace

std::map<std::string, std::string> make_slam_settings(const Scenario& scenario, const FirstLinks& first_links) {
  const std::vector<MountedCamera>& cameras = scenario.cameras;
  const auto unit_of = [&](const MountedCamera& c) { return find_unit(scenario, c, first_links); };
  const auto with_unit = std::find_if(cameras.begin(), cameras.end(), unit_of);
  const MountedCamera& chosen = with_unit == cameras.end() ? cameras.front() : *with_unit;
  const Camera camera(scenario, chosen, unit_of(chosen));
  std::map<std::string, std::string> files;
  files["orbslam3.yaml"] = orbslam3(camera);
  files["kalibr/camchain.yaml"] = camera_chain(camera);
  files["camera.yaml"] = camera_yaml(camera);
  files["rtabmap.ini"] = rtabmap(camera);
  files["evo.json"] =
      "{\n  \"align\": true,\n  \"correct_scale\": false,\n  \"pose_relation\": \"trans_part\",\n"
      "  \"t_max_diff\": 0.001\n}\n";
  if (!camera.imu) return files;
  files["kalibr/imu.yaml"] = kalibr_imu(*camera.imu);
  files["openvins/estimator_config.yaml"] = openvins_estimator(camera);
  files["openvins/kalibr_imu_chain.yaml"] = openvins_imu(*camera.imu);
  files["openvins/kalibr_imucam_chain.yaml"] = "%YAML:1.0\n" + camera_chain(camera);
  return files;
}

}  // namespace rubble
