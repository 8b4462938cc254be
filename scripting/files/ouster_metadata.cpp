// Ouster, "Firmware user manual", on the conversion of ranges to points: a ray of row i leaves the point at the distance
// lidar_origin_to_beam_origin from the axis, in the direction of the encoder; its azimuth is that of the encoder minus
// beam_azimuth_angles[i], counter-clockwise; its elevation is beam_altitude_angles[i]. The encoder turns clockwise from X.
// lidar_to_sensor_transform turns this frame by 180 degrees about Z, which makes the first column look backwards, as
// our LiDARs do (render/scene/lidar_spec.h), and lifts it. Rows begin at the top, our rings at the lowest.
#include "scripting/files/calibration_values.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "kernel/base/tables/text_table.h"

namespace rubble {
namespace {

constexpr double kMillimetre = 1e-3;
constexpr double kSmallShift = 1e-3;  // of what counts as none; unit: mm

class OusterReader : private CalibrationValues {
 public:
  OusterReader(const Value& root, const std::string& path) : CalibrationValues(path), root_(root) {}

  OusterMetadata read() {
    read_product();
    read_mode();
    read_beams();
    read_origin();
    read_returns();
    name_what_is_left_out();
    return std::move(out_);
  }

 private:
  // At the top, or in a section.
  const Value* key(const char* section, const char* name) const {
    if (const Value* found = root_.find(name)) return found;
    const Value* in = root_.find(section);
    return in ? in->find(name) : nullptr;
  }
  void set(const char* name, Value value) { out_.keys.set(name, std::move(value)); }
  void note(std::string text) { out_.notes.push_back(std::move(text)); }

  // "OS-1-64", "OS1-64"
  void read_product() {
    const std::string product = text(key("sensor_info", "prod_line"), "prod_line");
    std::string letters;
    for (const char c : lower_case(product))
      if (c != '-') letters += c;
    const std::string model = letters.substr(0, 3);
    if (model != "os0" && model != "os1" && model != "os2")
      refuse("prod_line", "a sensor that is not simulated", "OS-0, OS-1 or OS-2", product);
    const std::size_t from = std::min<std::size_t>(3, letters.size());
    const std::string digits = letters.substr(from, letters.find_first_not_of("0123456789", from) - from);
    rings_ = std::size_t(parse_number(digits).value_or(0));
    set("model", Value::make_text(model));
  }

  // "1024x10"
  void read_mode() {
    const std::string mode = text(key("config_params", "lidar_mode"), "lidar_mode");
    const std::size_t x = mode.find('x');
    const auto columns = parse_number(mode.substr(0, x)), rate = parse_number(x == std::string::npos ? "" : mode.substr(x + 1));
    if (!columns || !rate || (*columns != 512 && *columns != 1024 && *columns != 2048) || !(*rate >= 1 && *rate <= 100))
      refuse("lidar_mode", "a mode that is not simulated", "512x10, 512x20, 1024x10, 1024x20 or 2048x10", mode);
    set("columns", Value::make_integer(std::int64_t(*columns)));
    set("rate_hz", Value::make_number(*rate));
  }

  struct Row {
    double elevation = 0, azimuth = 0;  // unit: degree
  };

  void read_beams() {
    const Value* altitudes = key("beam_intrinsics", "beam_altitude_angles");
    const Value* azimuths = key("beam_intrinsics", "beam_azimuth_angles");
    if (!altitudes) return read_no_beams(azimuths);
    const auto elevations = numbers(altitudes, "beam_altitude_angles");
    std::vector<Row> rows;
    for (const double elevation : elevations) rows.push_back({elevation, 0});
    if (azimuths) {
      const auto beside = numbers(azimuths, "beam_azimuth_angles", rows.size());
      for (std::size_t i = 0; i < rows.size(); ++i) rows[i].azimuth = beside[i] == 0 ? 0 : -beside[i];
    } else {
      note("beam_azimuth_angles are not in the file: all rings look along their column");
    }
    // Old sensors of 16 and 32 rings have a list of 64 with zeros where no laser is.
    if (rings_ > 0 && rings_ < rows.size())
      rows.erase(std::remove_if(rows.begin(), rows.end(), [](const Row& r) { return r.elevation == 0 && r.azimuth == 0; }), rows.end());
    if (rows.empty() || rows.size() > 128 || (rings_ > 0 && rings_ != rows.size()))
      refuse("beam_altitude_angles", "another number of rings than the sensor has", rings_ > 0 ? std::to_string(rings_) : "1 to 128",
             std::to_string(rows.size()));
    std::stable_sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.elevation < b.elevation; });
    Value own_elevations = Value::make_table(), own_azimuths = Value::make_table();
    for (const Row& row : rows) {
      own_elevations.items.push_back(Value::make_number(row.elevation));
      own_azimuths.items.push_back(Value::make_number(row.azimuth));
    }
    set("beam_elevations_deg", std::move(own_elevations));
    if (azimuths) set("beam_azimuths_deg", std::move(own_azimuths));
  }

  void read_no_beams(const Value* azimuths) {
    if (rings_ != 32 && rings_ != 64 && rings_ != 128)
      refuse("beam_altitude_angles", "nothing tells the elevations of the rings", "a list, or a model of 32, 64 or 128 rings",
             std::to_string(rings_) + " rings");
    set("channels", Value::make_integer(std::int64_t(rings_)));
    note(std::string("beam_altitude_angles are not in the file: rings have the model's even spacing") +
         (azimuths ? ", and beam_azimuth_angles are left out" : ""));
  }

  static bool is_turn(const std::vector<double>& m, double xx, double yy) {
    const double expected[] = {xx, 0, 0, 0, yy, 0, 0, 0, 1};
    for (std::size_t i = 0; i < 9; ++i)
      if (!(std::abs(m[4 * (i / 3) + i % 3] - expected[i]) < 1e-6)) return false;
    return true;
  }

  void read_origin() {
    double radius = 0, height = 0;  // unit: mm
    const Value* to_lidar = key("beam_intrinsics", "beam_to_lidar_transform");
    const Value* distance = key("beam_intrinsics", "lidar_origin_to_beam_origin_mm");
    if (to_lidar) {
      const auto m = numbers(to_lidar, "beam_to_lidar_transform", 16);
      radius = m[3], height = m[11];
      if (!is_turn(m, 1, 1) || !(std::abs(m[7]) < kSmallShift))
        note("beam_to_lidar_transform: only its shifts along X and Z are used, not its rotation and its shift along Y");
    } else if (distance) {
      radius = number(distance, "lidar_origin_to_beam_origin_mm");
    } else {
      note("lidar_origin_to_beam_origin_mm is not in the file: rays leave the axis of rotation");
    }
    if (const Value* to_sensor = key("lidar_intrinsics", "lidar_to_sensor_transform")) {
      const auto m = numbers(to_sensor, "lidar_to_sensor_transform", 16);
      if (is_turn(m, -1, -1) && std::abs(m[3]) < kSmallShift && std::abs(m[7]) < kSmallShift)
        height += m[11];
      else
        note("lidar_to_sensor_transform is left out: expected 180 degrees about Z and a shift along Z; add it to `position` "
             "and `rpy_deg`");
    }
    if (radius != 0) set("beam_radius", Value::make_number(radius * kMillimetre));
    if (height != 0) set("beam_height", Value::make_number(height * kMillimetre));
  }

  void read_returns() {
    const Value* profile = key("lidar_data_format", "udp_profile_lidar");
    if (!profile) profile = key("config_params", "udp_profile_lidar");
    if (profile && profile->kind == Value::Kind::text && profile->text.find("DUAL") != std::string::npos)
      set("returns", Value::make_text("dual"));
    if (const Value* least = key("config_params", "min_range_threshold_cm"); least && least->is_number() && least->number > 0)
      set("min_range", Value::make_number(least->number / 100));
  }

  void name_what_is_left_out() {
    const auto name = [&](const char* section, const char* key_name, const char* effect) {
      if (key(section, key_name)) note(std::string(key_name) + " is left out: " + effect);
    };
    name("imu_intrinsics", "imu_to_sensor_transform", "give its pose as `imu.position` and `imu.rpy_deg`");
    if (const Value* order = key("config_params", "return_order");
        order && !(order->kind == Value::Kind::text && order->text == "STRONGEST_TO_WEAKEST"))
      note("return_order is left out: the strongest echo is reported first");
    if (const Value* gain = key("config_params", "signal_multiplier"); gain && !(gain->is_number() && gain->number == 1))
      note("signal_multiplier is left out");
    if (const Value* window = key("config_params", "azimuth_window")) {
      const auto range = numbers(window, "azimuth_window", 2);
      if (range[0] != 0 || range[1] < 360'000) note("azimuth_window is left out: scans cover the whole turn");
    }
  }

  const Value& root_;
  std::size_t rings_ = 0;  // of the product's name; 0: it does not say
  OusterMetadata out_{Value::make_table(), {}, "lidar"};
};

}  // namespace

OusterMetadata read_ouster_metadata(const Value& root, const std::string& path) { return OusterReader(root, path).read(); }

}  // namespace rubble
