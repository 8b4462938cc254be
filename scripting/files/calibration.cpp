#include "scripting/files/calibration.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "kernel/base/math.h"
#include "kernel/base/number_text.h"
#include "kernel/base/portable_math.h"
#include "kernel/base/tables/text_table.h"
#include "scripting/files/calibration_values.h"

namespace rubble {
namespace {

struct CalibratedLens {
  std::string model = "pinhole";  // of `lens.model`
  double width = 0, height = 0;
  double fx = 0, fy = 0, cx = 0, cy = 0;
  std::vector<double> coefficients;  // k1 k2 p1 p2 k3 of plumb_bob, k1 to k4 of fisheye
};

class CalibrationReader : private CalibrationValues {
 public:
  CalibrationReader(std::string_view text, const std::string& path) : CalibrationValues(path), root_(parse_yaml(text, path)) {
    if (root_.kind != Value::Kind::table) refuse("", "is no calibration", kKnown, describe(root_));
  }

  SensorCalibration read() {
    if (const Value* chain = find_chain()) {
      read_chain(*chain);
    } else if (is_ouster()) {
      read_ouster();
    } else if (find_orb()) {
      read_orb();
    } else if (const Value* matrix = find(root_, {"camera_matrix", "cameraMatrix", "Camera_Matrix", "K", "k", "M1", "K1"})) {
      read_opencv(*matrix);
    } else {
      refuse("", "is no calibration", kKnown, "the keys " + keys_of(root_));
    }
    return std::move(result_);
  }

 private:
  static constexpr const char* kKnown =
      "a Kalibr camchain, an OpenCV or ROS camera_info file with camera_matrix, ORB-SLAM settings, or Ouster metadata";

  void check_lens(const CalibratedLens& lens, const std::string& key) const {
    const bool whole = lens.width == std::floor(lens.width) && lens.height == std::floor(lens.height);
    if (!whole || lens.width < 1 || lens.height < 1)
      refuse(key, "no size of the image", "a width and a height", exact_text(lens.width) + " x " + exact_text(lens.height));
    if (!(lens.fx > 0) || !(lens.fy > 0)) refuse(key, "no focal length", "fx and fy above 0", exact_text(lens.fx));
  }

  Value camera_keys(const CalibratedLens& lens, const std::string& key) const {
    check_lens(lens, key);
    const KeyNames plumb_bob{"k1", "k2", "p1", "p2", "k3"}, fisheye{"k1", "k2", "k3", "k4"};
    Value of_lens = Value::make_table(), camera = Value::make_table();
    of_lens.set("model", Value::make_text(lens.model));
    for (const auto& [name, value] :
         {std::pair{"fx", lens.fx}, {"fy", lens.fy}, {"cx", lens.cx}, {"cy", lens.cy}})
      of_lens.set(name, Value::make_number(value));
    const KeyNames& names = lens.model == "fisheye" ? fisheye : plumb_bob;
    for (std::size_t i = 0; i < lens.coefficients.size() && i < names.size(); ++i)
      of_lens.set(names.begin()[i], Value::make_number(lens.coefficients[i]));
    camera.set("width", Value::make_integer(std::int64_t(lens.width)));
    camera.set("height", Value::make_integer(std::int64_t(lens.height)));
    camera.set("lens", std::move(of_lens));
    return camera;
  }

  // From the model's name, or "" where the number of coefficients tells it.
  void set_distortion(CalibratedLens& lens, const std::string& name, std::vector<double> d, const std::string& key) const {
    while (!d.empty() && d.back() == 0 && d.size() > 5) d.pop_back();  // rational terms and others of value 0
    const bool none = std::all_of(d.begin(), d.end(), [](double v) { return v == 0; });
    const std::string low = lower_case(name);
    const auto is = [&low](KeyNames names) { return std::any_of(names.begin(), names.end(), [&](const char* n) { return low == n; }); };
    const bool fisheye = is({"equidistant", "equi", "fisheye", "kannala_brandt", "kannalabrandt8"});
    if (!fisheye && !is({"", "none", "radtan", "plumb_bob", "rational_polynomial", "pinhole"}))
      refuse(key, "a model of lenses that is not simulated", "radtan (plumb_bob), equidistant (fisheye) or none", name);
    if (fisheye && d.size() != 4) refuse(key, "another number of coefficients", "4 of a fisheye lens", std::to_string(d.size()));
    if (!fisheye && d.size() > 5)
      refuse(key, "the rational model of lenses is not simulated", "4 or 5 coefficients that are not 0", std::to_string(d.size()),
             "calibrate without CALIB_RATIONAL_MODEL");
    if (!fisheye && !d.empty() && d.size() < 4)
      refuse(key, "another number of coefficients", "k1, k2, p1, p2 and perhaps k3", std::to_string(d.size()));
    lens.model = fisheye ? "fisheye" : none ? "pinhole" : "plumb_bob";
    if (fisheye || !none) lens.coefficients = std::move(d);
  }

  // Kalibr: cam0, cam1, ...
  const Value* find_chain() const {
    const Value* first = root_.find("cam0");
    return first && first->find("intrinsics") ? &root_ : nullptr;
  }

  CalibratedLens chain_lens(const Value& camera, const std::string& name) const {
    CalibratedLens lens;
    const std::string model = text(camera.find("camera_model"), name + ".camera_model");
    if (model != "pinhole")
      refuse(name + ".camera_model", "a model of cameras that is not simulated", "pinhole", model,
             "calibrate with pinhole-radtan or pinhole-equi");
    const auto k = numbers(camera.find("intrinsics"), name + ".intrinsics", 4);
    lens.fx = k[0], lens.fy = k[1], lens.cx = k[2], lens.cy = k[3];
    const auto size = numbers(camera.find("resolution"), name + ".resolution", 2);
    lens.width = size[0], lens.height = size[1];
    const Value* coefficients = camera.find("distortion_coeffs");
    set_distortion(lens, text(camera.find("distortion_model"), name + ".distortion_model"),
                   coefficients ? numbers(coefficients, name + ".distortion_coeffs") : std::vector<double>{},
                   name + ".distortion_model");
    return lens;
  }

  Pose transform(const Value* value, const std::string& key) const {
    const auto m = numbers(value, key, 16);
    Mat3 rotation{{{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}}};
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k)
        if (!(std::abs(dot(rotation.rows[i], rotation.rows[k]) - (i == k ? 1 : 0)) < 0.01))
          refuse(key, "no rigid transform", "a 4 x 4 matrix with a rotation", "other numbers");
    return {quat_of(rotation), {m[3], m[7], m[11]}};
  }

  // The largest of the four squares is at least 1/4.
  static Quat quat_of(const Mat3& m) {
    const double xx = m.rows[0].x, yy = m.rows[1].y, zz = m.rows[2].z;
    const Quat four[] = {{1 + xx + yy + zz, m.rows[2].y - m.rows[1].z, m.rows[0].z - m.rows[2].x, m.rows[1].x - m.rows[0].y},
                         {m.rows[2].y - m.rows[1].z, 1 + xx - yy - zz, m.rows[0].y + m.rows[1].x, m.rows[0].z + m.rows[2].x},
                         {m.rows[0].z - m.rows[2].x, m.rows[0].y + m.rows[1].x, 1 - xx + yy - zz, m.rows[1].z + m.rows[2].y},
                         {m.rows[1].x - m.rows[0].y, m.rows[0].z + m.rows[2].x, m.rows[1].z + m.rows[2].y, 1 - xx - yy + zz}};
    const double squares[] = {four[0].w, four[1].x, four[2].y, four[3].z};
    return normalized(four[std::max_element(squares, squares + 4) - squares]);
  }

  static Value vector_of(const Vec3& v) {
    Value list = Value::make_table();
    for (int i = 0; i < 3; ++i) list.items.push_back(Value::make_number(v[i] == 0 ? 0 : v[i]));
    return list;
  }

  // cam_n from cam_(n-1), both optical: each camera in the first one's body.
  void read_chain(const Value& chain) {
    result_.format = "Kalibr camchain";
    Value cameras = Value::make_table();
    Pose first_from_here;  // optical
    int count = 0;
    for (;; ++count) {
      const std::string name = "cam" + std::to_string(count);
      const Value* camera = chain.find(name);
      if (!camera) break;
      Value keys = camera_keys(chain_lens(*camera, name), name);
      if (count > 0) first_from_here = first_from_here * transform(camera->find("T_cn_cnm1"), name + ".T_cn_cnm1").inverse();
      if (camera->find("T_cam_imu") && count == 0)
        result_.notes.push_back("T_cam_imu is left out: the first camera is the rig's origin and looks along X");
      const Pose body = camera_from_optical * first_from_here * camera_from_optical.inverse();
      if (count == 0) result_.keys.set("camera", keys);
      keys.set("position", vector_of(body.translation));
      keys.set("rpy_deg", vector_of(portable::rpy_from_quat(body.rotation) * (180 / portable::kPi)));
      cameras.set(name, std::move(keys));
    }
    if (count > 1) result_.keys.set("cameras", std::move(cameras));
  }

  bool is_ouster() const {
    const Value* sensor = root_.find("sensor_info");
    return find(root_, {"prod_line", "beam_altitude_angles", "beam_intrinsics"}) || (sensor && sensor->find("prod_line"));
  }

  void read_ouster() {
    result_.format = "Ouster metadata";
    OusterMetadata metadata = read_ouster_metadata(root_, path());
    result_.keys.set(metadata.kind, std::move(metadata.keys));
    result_.notes = std::move(metadata.notes);
  }

  std::string orb_prefix() const {
    for (const char* prefix : {"Camera1.", "Camera."})
      if (root_.find(std::string(prefix) + "fx")) return prefix;
    return "";
  }
  bool find_orb() const { return !orb_prefix().empty(); }

  void read_orb() {
    result_.format = "ORB-SLAM settings";
    const std::string at = orb_prefix();
    const auto value = [&](const std::string& key) { return number(root_.find(key), key); };
    const auto maybe = [&](const char* name) {
      const Value* found = root_.find(at + name);
      return found ? number(found, at + name) : 0.0;
    };
    CalibratedLens lens;
    lens.fx = value(at + "fx"), lens.fy = value(at + "fy"), lens.cx = value(at + "cx"), lens.cy = value(at + "cy");
    lens.width = value("Camera.width"), lens.height = value("Camera.height");
    const Value* type = root_.find("Camera.type");
    const std::string model = type ? text(type, "Camera.type") : "PinHole";
    if (model != "PinHole" && model != "KannalaBrandt8")
      refuse("Camera.type", "a model of cameras that is not simulated", "PinHole or KannalaBrandt8", model);
    const bool fisheye = model == "KannalaBrandt8";
    set_distortion(lens, fisheye ? "fisheye" : "radtan",
                   fisheye ? std::vector<double>{maybe("k1"), maybe("k2"), maybe("k3"), maybe("k4")}
                           : std::vector<double>{maybe("k1"), maybe("k2"), maybe("p1"), maybe("p2"), maybe("k3")},
                   at + "k1");
    result_.keys.set("camera", camera_keys(lens, "Camera.width"));
    if (root_.find("Camera2.fx")) result_.notes.push_back("the second camera is left out: give stereo_baseline");
  }

  void read_opencv(const Value& matrix) {
    const Value* model = root_.find("distortion_model");
    const bool ros = model || root_.find("camera_name");
    result_.format = ros ? "ROS camera_info" : "OpenCV";
    CalibratedLens lens;
    const auto k = numbers(&matrix, "camera_matrix", 9);
    lens.fx = k[0], lens.fy = k[4], lens.cx = k[2], lens.cy = k[5];
    if (k[1] != 0) result_.notes.push_back("the skew of the camera matrix is left out");
    const Value* width = find(root_, {"image_width", "imageWidth", "image_Width", "width"});
    const Value* height = find(root_, {"image_height", "imageHeight", "image_Height", "height"});
    if (const Value* size = find(root_, {"image_size", "imageSize", "image_resolution", "resolution"}); size && !width) {
      const auto both = numbers(size, "image_size", 2);
      lens.width = both[0], lens.height = both[1];
    } else {
      lens.width = number(width, "image_width"), lens.height = number(height, "image_height");
    }
    const Value* d = find(root_, {"distortion_coefficients", "distCoeffs", "dist_coeffs", "Distortion_Coefficients", "D", "d", "D1"});
    const Value* fisheye = find(root_, {"fisheye_model"});
    const bool is_fisheye = fisheye && fisheye->is_number() && fisheye->number != 0;
    set_distortion(lens, model ? text(model, "distortion_model") : is_fisheye ? "fisheye" : "",
                   d ? numbers(d, "distortion_coefficients") : std::vector<double>{}, model ? "distortion_model" : "distortion_coefficients");
    if (!d) result_.notes.push_back("no distortion coefficients: the lens is an exact pinhole");
    result_.keys.set("camera", camera_keys(lens, "image_width"));
    check_rectification();
  }

  void check_rectification() {
    const Value* r = find(root_, {"rectification_matrix", "R", "r"});
    if (!r) return;
    const auto m = numbers(r, "rectification_matrix", 9);
    bool identity = true;
    for (std::size_t i = 0; i < 9; ++i) identity = identity && std::abs(m[i] - (i % 4 == 0 ? 1 : 0)) < 1e-9;
    if (!identity) result_.notes.push_back("rectification_matrix and projection_matrix are left out: the camera is not rectified");
  }

  Value root_;
  SensorCalibration result_{"", Value::make_table(), {}};
};

}  // namespace

SensorCalibration parse_calibration(std::string_view text, const std::string& path) {
  return CalibrationReader(text, path).read();
}

}  // namespace rubble
