#include "app/card/viewer_settings.h"

#include <nlohmann/json.hpp>
#include <vector>

#include "io/ros/ros_messages.h"
#include "scripting/scenario/scenario.h"

namespace rubble {
namespace {

using nlohmann::json;

// One display: what it shows, on which topic, and how the pictures there are encoded.
struct Display {
  std::string kind;     // RViz: the class, without its package
  std::string name;
  std::string topic;    // without the suffix of an encoding
  std::string encoding; // the image transport; empty: no pictures

  // As the recording has it.
  std::string full_topic() const {
    return encoding.empty() || encoding == "raw" ? topic : topic + "/" + encoding;
  }
};

std::vector<Display> list_pictures(const Scenario& scenario) {
  const OutputScenario& out = scenario.outputs;
  const std::string colour = out.pictures == PictureEncoding::raw ? "raw" : "compressed";
  std::vector<Display> displays;
  for (const MountedCamera& mounted : scenario.cameras) {
    const std::string topic = mounted.topic();
    displays.push_back({"Image", mounted.name, topic + "/rgb/image_raw", colour});
    if (mounted.camera.stereo_baseline > 0)
      displays.push_back({"Image", mounted.name + ", right", topic + "/right/image_raw", colour});
  }
  return displays;
}

std::vector<Display> list_depths(const Scenario& scenario) {
  const OutputScenario& out = scenario.outputs;
  const bool packed = out.pictures != PictureEncoding::raw && out.depth == DepthEncoding::millimetres;
  std::vector<Display> displays;
  for (const MountedCamera& mounted : scenario.cameras) {
    const std::string topic = mounted.topic() + "/depth_registered/";
    displays.push_back({"DepthCloud", mounted.name + ", depth",
                        topic + (out.depth == DepthEncoding::millimetres ? "image_raw" : "image"),
                        packed ? "compressedDepth" : "raw"});
  }
  return displays;
}

std::vector<Display> list_scans(const Scenario& scenario) {
  std::vector<Display> displays;
  for (const SensorItem& sensor : scenario.sensors)
    if (scans(sensor))
      displays.push_back({sensor.figures->topics().front().type->name, sensor.name, topic_of(scenario.sensors, sensor), ""});
  return displays;
}

// RViz reads YAML, of which JSON is a part. A display of ROS 2 has its topic as a table.
json rviz_display(const Display& display, int ros) {
  const std::string package = ros == 1 ? "rviz/" : "rviz_default_plugins/";
  json shown{{"Class", package + display.kind}, {"Name", display.name}, {"Enabled", true}, {"Value", true}};
  if (display.kind == "DepthCloud") {
    shown["Depth Map Topic"] = display.topic;
    shown["Depth Map Transport Hint"] = display.encoding;
  } else if (display.kind == "Image" && ros == 1) {
    shown["Image Topic"] = display.topic;
    shown["Transport Hint"] = display.encoding;
  } else if (ros == 1) {
    shown["Topic"] = display.topic;
  } else {
    shown["Topic"] = {{"Value", display.full_topic()}, {"Reliability Policy", "Reliable"}, {"Depth", 5}};
  }
  return shown;
}

std::string make_rviz(const std::vector<Display>& displays, int ros) {
  const std::string package = ros == 1 ? "rviz/" : "rviz_default_plugins/";
  json list = json::array();
  list.push_back({{"Class", package + "Grid"}, {"Name", "Ground"}, {"Enabled", true}, {"Value", true}, {"Cell Size", 1}, {"Plane Cell Count", 20}});
  list.push_back({{"Class", package + "TF"}, {"Name", "Frames"}, {"Enabled", true}, {"Value", true}});
  for (const Display& display : displays) list.push_back(rviz_display(display, ros));
  json view{{"Class", ros == 1 ? "rviz/Orbit" : "rviz_default_plugins/Orbit"}, {"Distance", 15}, {"Pitch", 0.6},
            {"Yaw", 0.8}, {"Focal Point", {{"X", 0}, {"Y", 0}, {"Z", 1}}}};
  const json tool{{"Class", package + "MoveCamera"}};
  const json file{
      {"Panels", json::array({json{{"Class", ros == 1 ? "rviz/Displays" : "rviz_common/Displays"}, {"Name", "Displays"}}})},
      {"Visualization Manager",
       {{"Class", ""}, {"Displays", list}, {"Enabled", true}, {"Global Options", {{"Fixed Frame", "world"}, {"Frame Rate", 30}}},
        {"Tools", json::array({tool})}, {"Value", true}, {"Views", {{"Current", view}}}}}};
  return file.dump(2) + "\n";
}

// Panels side by side, as a tree of halves.
json rows_of(const std::vector<std::string>& panels, std::size_t from) {
  if (from + 1 == panels.size()) return panels[from];
  return {{"direction", "column"}, {"first", panels[from]}, {"second", rows_of(panels, from + 1)},
          {"splitPercentage", 100.0 / double(panels.size() - from)}};
}

std::string make_foxglove(const Scenario& scenario, const std::vector<Display>& pictures) {
  json panels = json::object();
  json topics = json::object();
  for (const Display& cloud : list_scans(scenario)) topics[cloud.full_topic()] = {{"visible", true}};
  panels["3D!pile"] = {{"followTf", "world"}, {"followMode", "follow-none"}, {"topics", topics},
                       {"cameraState", {{"distance", 15}, {"phi", 60}, {"thetaOffset", 45}, {"perspective", true}}}};
  std::vector<std::string> column;
  std::vector<Display> shown = pictures;
  for (const Display& depth : list_depths(scenario)) shown.push_back(depth);
  for (std::size_t i = 0; i < shown.size(); ++i) {
    column.push_back("Image!picture" + std::to_string(i));
    panels[column.back()] = {{"imageMode", {{"imageTopic", shown[i].full_topic()}}}};
  }
  for (const ImuScenario& imu : scenario.imus) {
    column.push_back("Plot!" + imu.name);
    json paths = json::array();
    for (const char* axis : {"x", "y", "z"})
      paths.push_back({{"value", imu.ros_topic() + ".linear_acceleration." + axis},
                       {"enabled", true}, {"timestampMethod", "receiveTime"}});
    panels[column.back()] = {{"paths", paths}};
  }
  const json file{{"configById", panels}, {"globalVariables", json::object()}, {"userNodes", json::object()},
                  {"playbackConfig", {{"speed", 1}}},
                  {"layout", {{"direction", "row"}, {"first", "3D!pile"}, {"second", rows_of(column, 0)}, {"splitPercentage", 65}}}};
  return file.dump(2) + "\n";
}

}  // namespace

std::map<std::string, std::string> make_viewer_settings(const Scenario& scenario) {
  const std::vector<Display> pictures = list_pictures(scenario);
  std::vector<Display> displays = pictures;
  for (const auto& more : {list_depths(scenario), list_scans(scenario)})
    displays.insert(displays.end(), more.begin(), more.end());
  return {{"ros1.rviz", make_rviz(displays, 1)},
          {"ros2.rviz", make_rviz(displays, 2)},
          {"foxglove.json", make_foxglove(scenario, pictures)}};
}

}  // namespace rubble
