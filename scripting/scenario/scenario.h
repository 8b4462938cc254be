// A complete mission as plain data: the result of a script and the input of a run.
//
//   mission.lua --load_mission--> Scenario --> Pile, Scene, frames, files
//
// Every member has a default, so an empty mission is valid. scenario_schema.cpp lists every key that a
// script can set, with the names of these members.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kernel/base/error.h"
#include "kernel/base/math.h"
#include "kernel/model/fines.h"
#include "kernel/model/pile.h"
#include "kernel/model/surroundings.h"
#include "kernel/settling/settle.h"
#include "render/scene/device_kind.h"
#include "render/scene/scene.h"
#include "scripting/scenario/camera_scenario.h"
#include "scripting/scenario/robot_scenario.h"
#include "scripting/sensors/sensor_item.h"
#include "scripting/trajectory/trajectory.h"

namespace rubble {

// A material of a piece of the mix that replaces the material of its pack.
struct MixMaterial {
  std::string material;  // a name in materials.lua
  double weight = 1;     // relative; >= 0
};

// One kind of piece in the mix that is dropped.
struct MixItem {
  std::string asset;  // its name in a pack
  double weight = 1;  // relative; >= 0
  // From first to second; default: the asset's own range and spread. range: 0.01 to 100
  std::optional<std::array<double, 2>> scale;
  SizeDistribution spread{};  // over `scale`
  std::vector<MixMaterial> materials{};  // drawn for every piece; empty: the material of the pack
};

// A piece that is placed before the first layer falls: an asset of a pack, or a box of given size.
struct PlacedItem {
  std::string asset;  // empty: a box
  Vec3 position;      // of the piece's origin, in the world; unit: m
  Vec3 rpy_deg;       // roll, pitch, yaw: R = Rz(yaw) Ry(pitch) Rx(roll); unit: degree
  double scale = 1;   // range: 0.01 to 100
  bool fixed = true;  // immovable; false: it settles with the pile
  std::optional<Vec3> box{};  // full edge lengths; unit: m; range: 0.02 to 100; its origin is its middle
  std::string material = "reinforced_concrete";  // of a box
  std::vector<std::string> broken{};  // of a box, the faces that broke off: "+x", "-x", "+y", ...
  bool built_in = false;  // reaches into other fixed pieces on purpose; changes no result
};

// An asset that stands on every floor of a building before the collapse.
struct FurnitureItem {
  std::string asset;   // its name in a pack
  double per_bay = 1;  // mean number in each bay of each floor; range: 0 to 20
  bool roof = false;   // also on the roof
};

// Terrain above the ground z = 0: heights on a grid, or a mesh. Without both there is only the ground.
struct TerrainScenario {
  int columns = 0, rows = 0;     // corners of the grid along X and Y; range: 0 to 1024
  double spacing = 0.5;          // of neighbouring corners; unit: m; range: 0.01 to 100
  std::vector<double> heights{};  // row by row from the lowest y; above `position`; unit: m
  std::string file{};            // a mesh instead of a grid; path relative to the script
  double metres_per_unit = 1;    // of the file; range: > 0
  UpAxis up = UpAxis::z;         // of the file
  Vec3 position;                 // of the grid's middle, or of the mesh's origin; unit: m
  double friction = 0.8;         // Coulomb, against concrete; range: 0 to 2
  // Look of the grid, and of surfaces of the mesh without a look. Empty: such surfaces keep the colours of the file;
  // surfaces without colours, and the grid, have the look "ground".
  std::string look;

  bool given() const { return !heights.empty() || !file.empty(); }
};

struct PileScenario {
  Vec3 spawn_position{0, 0, 4.5};  // centre of the box that layers are drawn in; unit: m
  Vec3 spawn_bounds{10, 10, 7};    // its full edge lengths; unit: m; > 0
  SpawnDensity spawn_density;      // over the box; without weights uniform
  int layers = 4;                  // range: 0 to 1000
  int pieces_per_layer = 300;      // range: 0 to 100000
  std::vector<MixItem> mix;        // empty: every asset of the packs, by its own weight
  std::vector<PlacedItem> placed;  // placed before the first layer falls
  TerrainScenario terrain;         // below the pile
  BuildingSpec building;           // collapses before the first layer falls; its seed is that of the mission
  std::vector<FurnitureItem> furniture;  // of the building
  // A moment of this pile that settling goes on from, instead of its start: a file of `rubble inspect`. Path relative to
  // the script. Not given: from the start.
  std::optional<std::string> snapshot{};
};

struct LightScenario {
  LightSpec spec;  // as the mission states it
  // Draw the direction from the seed; then neither spec.rpy_deg nor the sun's place is used.
  bool random_rotation = false;
  // Draw the position from the box around spec.position of these full edge lengths.
  bool random_position = false;
  Vec3 position_bounds{8, 8, 4};  // unit: m; >= 0
  SkySpec sky;                    // of the sun
  // Place and time, instead of spec.elevation_deg and spec.azimuth_deg of the sun: all three or none.
  std::optional<double> latitude_deg{}, longitude_deg{};  // north and east are positive; unit: degree
  std::optional<std::string> time{};                      // UTC: parse_utc()
  double north_deg = 90;  // direction of north, from X towards Y; unit: degree
};

// Valid names of OutputScenario::meshes.
std::vector<std::string> export_names();

enum class DepthEncoding {
  millimetres,  // "16UC1": uint16, 0: no return
  metres,       // "32FC1": float, NaN: no return
};

enum class PictureEncoding { raw, png, jpeg };

// Of streams with several values a pixel, such as normals.
enum class VectorEncoding { values, colours };

enum class RawlogFormat {
  observations,  // a sequence of observations
  actions,       // actions of a robot and frames of observations in turn
};

struct OutputScenario {
  bool rawlog = true;               // MRPT: mission.rawlog
  RawlogFormat rawlog_format = RawlogFormat::observations;
  int rawlog_gzip = 0;              // range: 0 to 9
  bool simplemap = true;            // MRPT: mission.simplemap
  bool bag = true;                  // ROS 1: mission.bag
  bool mcap = false;                // ROS 2: mission.mcap
  bool tum = false;                 // TUM RGB-D: a folder
  bool euroc = false;               // EuRoC MAV: a folder
  bool colmap = false;              // COLMAP: a folder
  bool frames = false;              // plain PNG and EXR: a folder
  bool pcd = false;                 // PCL: a folder of a file a scan
  bool kitti = false;               // KITTI: a folder of a file a scan
  bool kitti_odometry = false;      // KITTI odometry: a folder with pictures, scans and poses
  bool nerfstudio = false;          // nerfstudio and splats: a folder with transforms.json
  bool coco = false;                // COCO: a folder with boxes and masks
  bool webdataset = false;          // WebDataset: a folder of tar files
  bool lerobot = false;             // LeRobot v3: a folder of Parquet files and videos
  bool stl = true;                  // pile.stl
  bool track = false;               // motion of the pieces: track.bin and, as glTF animation, track.glb
  std::vector<std::string> meshes;  // the pile in further formats, of export_names()
  bool groundtruth = true;          // TUM: groundtruth.txt
  bool sensors = true;              // tables of the readings of sensors: a folder
  bool preview = true;              // preview.png, a contact sheet
  DepthEncoding depth = DepthEncoding::millimetres;  // in bag and MCAP file
  PictureEncoding pictures = PictureEncoding::raw;   // in bag and MCAP file
  VectorEncoding vectors = VectorEncoding::values;   // in bag and MCAP file
};

// Records the pile while it settles, by a standing camera before its flight.
struct RecordSettlingScenario {
  bool on = false;                 // false: the recording begins when the pile rests
  double from = 0;                 // simulated time since the first step; unit: s; range: 0 to 86400
  std::optional<double> to{};      // by default until the pile rests; unit: s; range: from, to 86400
  std::optional<double> rate_hz{};  // by default that of the trajectory; unit: Hz
  // Position of the camera and the point in the middle of its view, in the world; by default as at the start of the
  // flight. Both or neither. unit: m
  std::optional<Vec3> position{}, look_at{};
};

// The voids of the settled pile, measured for suites and batches; kernel/voids/void_map.h.
struct VoidScenario {
  bool on = false;       // false: not measured
  double voxel = 0.05;   // unit: m; range: 0.01 to 1
  double radius = 0.15;  // of a robot, at least a voxel; unit: m; range: 0.02 to 5
};

// People who lie in the voids of the settled pile: figures of the bundled pack `victims`.
enum class VictimDifficulty { easy, medium, hard };
struct VictimScenario {
  int count = 0;  // range: 0 to 50
  // Distance from the entrances of the voids: the nearest, middle or farthest third of the places.
  VictimDifficulty difficulty = VictimDifficulty::medium;
  double radius = 0.15;  // of a robot that can reach and see each victim; unit: m; range: 0.05 to 1
};

struct Scenario {
  std::uint64_t seed = 0;                 // range: 0 to 2^63 - 1
  // No key. That of the run that settled the pile, where another mission keeps it: of its fines, its surroundings and
  // what each piece looks like.
  std::optional<std::uint64_t> kept_pile_seed{};
  std::uint64_t pile_seed() const { return kept_pile_seed.value_or(seed); }
  std::int64_t start_ns = 1'000'000'000;  // stamp of the first frame; ROS time 0 means invalid
  std::vector<std::string> packs;         // folders; empty: the bundled pack `concrete`
  PileScenario pile;                      // pieces, terrain, building
  VictimScenario victims;                 // people in the voids
  FinesSpec fines;                        // small debris
  SurroundingsSpec surroundings;          // street around the pile
  SettleOptions settle;  // its `threads` is not part of a scenario: results do not depend on it
  // At least the main light, which has the sky; of the others `spec` alone counts. At most kMostLights.
  std::vector<LightScenario> lights{LightScenario{}};
  DeviceKind device = DeviceKind::software;  // draws what cameras see
  double wetness = 0;             // of all surfaces; range: 0 to 1
  AirSpec air;                    // fog, smoke, dust
  std::vector<MountedCamera> cameras{MountedCamera{}};  // at least one; if it is not `named`, no other
  LampSpec lamp;                  // on the camera
  TrajectorySpec trajectory;      // path of the camera
  std::vector<ImuScenario> imus;  // inertial units; if one is not `named`, no other
  std::vector<SensorItem> sensors;  // of the kinds of sensor_kinds(), in their order, then by name
  RecordSettlingScenario record_settling;  // recording before the flight
  OutputScenario outputs;         // files
  VoidScenario voids;             // measurement of voids
  std::vector<RobotItem> robots;  // driven through the settled pile
  RobotRunScenario robot_run;     // duration and rates

  // Whether files and folders of cameras have their names.
  bool names_cameras() const { return cameras.front().named; }
  // Whether an inertial unit flies with the rig, whose path must then be smooth.
  bool has_unit_on_rig() const;
  // Throws InputError with every mistake: values out of range, not finite, or in contradiction.
  void validate() const;
};

// The mistakes that validate() throws; empty: none. Keys are schema paths such as "pile.mix[1].scale".
std::vector<Diagnostic> find_mistakes(const Scenario& scenario);

// Whether a camera has this stream of ground truth.
bool has_channel(const Scenario& scenario, const std::string& name);

// The trajectory with a default smoothing if the mission sets none: kUsualSmoothing with an inertial unit on the rig and for
// curves around obstacles, else none. The path of a ride is known only after the robot was driven; until then a
// placeholder with the same times is returned.
TrajectorySpec flown_trajectory(const Scenario& scenario);

// Whether settling records a track: track.bin.
bool needs_track(const Scenario& scenario);

// The main light after random draws. With random_rotation, the seed draws a pitch of 20 to 80 degrees down and any yaw
// (a sun 5 to 70 degrees high at any azimuth); with random_position, a position in its box.
LightSpec resolve_light(const Scenario& scenario);

// All members in the order of the schema. Numbers read back to the same bits. null: not set.
std::string scenario_to_json(const Scenario& scenario);
// The inverse. `file` names the text in errors. Throws InputError with every mistake.
Scenario scenario_from_json(const std::string& text, const std::string& file);

}  // namespace rubble
