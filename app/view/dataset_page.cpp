#include "app/view/dataset_page.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "app/eval/scores/trajectory_file.h"
#include "app/formats/recording_formats.h"
#include "app/report/html_text.h"
#include "app/scene/build_scene.h"
#include "app/view/page_parts.h"
#include "io/image/image_file.h"
#include "io/mesh_formats/ply_reader.h"
#include "io/playback/recorded_picture.h"
#include "io/voids/void_files.h"
#include "kernel/base/error.h"
#include "kernel/base/quick_math.h"

namespace rubble {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t kMostVoids = 40;

PackedMesh pick_surface(const TriangleMesh& mesh, std::size_t surface) {
  PackedMesh picked;
  std::map<std::uint32_t, std::uint32_t> moved;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!mesh.surfaces.empty() && mesh.surfaces[t] != surface) continue;
    for (const std::uint32_t v : mesh.triangles[t]) {
      const auto [at, is_new] = moved.try_emplace(v, std::uint32_t(moved.size()));
      if (is_new) add(picked.positions, Vec3(mesh.positions[v]));
      picked.indices.push_back(at->second);
    }
  }
  return picked;
}

// As the eye sees an albedo on a screen.
double to_screen(float linear) { return quick::pow(std::max(0.0, double(linear)), 1 / 2.2); }

// Columns one after another, as three.js has a matrix.
void add_matrix(std::vector<float>& values, const PileModel::Piece& piece) {
  for (const Vec3& axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
    add(values, piece.world_from_body.rotation.rotate(axis) * piece.scale);
    values.push_back(0);
  }
  add(values, piece.world_from_body.translation);
  values.push_back(1);
}

// The finest mesh that keeps the sum of all types within its share.
const TriangleMesh& choose_level(const SceneMesh& mesh, std::size_t pieces, std::size_t allowed) {
  for (const TriangleMesh& level : mesh.levels)
    if (level.triangles.size() * pieces <= allowed) return level;
  return mesh.levels.back();
}

Json describe_types(const PileModel& model, const AssetLibrary& assets, int triangles) {
  std::vector<std::vector<float>> instances(model.types.size());
  for (const PileModel::Piece& piece : model.pieces) add_matrix(instances[piece.type], piece);
  const auto used = std::count_if(instances.begin(), instances.end(), [](const auto& i) { return !i.empty(); });
  Json types = Json::array();
  for (std::size_t t = 0; t < model.types.size(); ++t) {
    if (instances[t].empty()) continue;
    const TriangleMesh& mesh = choose_level(*assets.meshes[t], instances[t].size() / 16,
                                            std::size_t(triangles) / std::size_t(used));
    Json groups = Json::array();
    const std::size_t surfaces = std::max<std::size_t>(1, mesh.surface_names.size());
    for (std::size_t s = 0; s < surfaces; ++s) {
      const PackedMesh picked = pick_surface(mesh, s);
      if (picked.indices.empty()) continue;
      Json group = picked.json();
      const Vec3f c = model.colour_of(s < mesh.surface_names.size() ? mesh.surface_names[s] : "");
      group["colour"] = {to_screen(c.x), to_screen(c.y), to_screen(c.z)};
      groups.push_back(std::move(group));
    }
    types.push_back({{"name", model.types[t].name}, {"groups", groups}, {"instances", pack(instances[t])}});
  }
  return types;
}

// Surfaces of voids in the folder: those of this pile, and how many are of another one, or do not say of which.
struct FoundVoids {
  std::vector<fs::path> files;
  int of_other_piles = 0;
};

FoundVoids find_voids(const std::string& folder, const PileState& pile) {
  FoundVoids found;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder + "/voids", failed)) {
    if (entry.path().extension() != ".ply") continue;
    if (is_void_surface_of(entry.path().string(), pile.state_hash()))
      found.files.push_back(entry.path());
    else
      ++found.of_other_piles;
  }
  std::sort(found.files.begin(), found.files.end());
  return found;
}

// Of the smallest robot that was asked for: its voids hold those of the larger ones.
Json describe_voids(const std::vector<fs::path>& files) {
  Json voids = Json::array();
  std::string robot;
  for (const fs::path& file : files) {
    const std::string name = file.stem().string(), of = name.substr(0, name.rfind('_'));
    if (robot.empty()) robot = of;
    if (of != robot || voids.size() >= kMostVoids) continue;
    const PlyMesh mesh = load_ply(file.string());
    PackedMesh packed;
    for (const Vec3& p : mesh.positions) add(packed.positions, p);
    for (const auto& t : mesh.triangles) packed.indices.insert(packed.indices.end(), t.begin(), t.end());
    Json one = packed.json();
    one["name"] = name;
    voids.push_back(std::move(one));
  }
  return voids;
}

// The way of a camera, from its groundtruth.txt: in the folder, or in cameras/NAME.
struct CameraWay {
  std::string name;    // empty: the mission has one
  std::string topic;   // ROS: prefix of its topics
  double aspect = 0.75;
  std::vector<StampedPose> poses;
};

std::vector<CameraWay> find_ways(const std::string& folder, const Scenario& scenario) {
  std::vector<CameraWay> ways;
  std::error_code failed;
  for (const MountedCamera& camera : scenario.cameras) {
    CameraWay way;
    way.name = camera.named ? camera.name : "";
    way.aspect = double(camera.camera.height) / camera.camera.width;
    way.topic = camera.topic();
    const std::string file = camera.folder_in(folder) + "/groundtruth.txt";
    if (fs::is_regular_file(file, failed)) way.poses = load_trajectory(file);
    ways.push_back(std::move(way));
  }
  return ways;
}

Json describe_way(const CameraWay& way) {
  std::vector<float> positions, rotations;
  std::vector<double> stamps;
  for (const StampedPose& pose : way.poses) {
    add(positions, pose.world_from_body.translation);
    const Quat& q = pose.world_from_body.rotation;
    for (const double v : {q.x, q.y, q.z, q.w}) rotations.push_back(float(v));
    stamps.push_back(pose.stamp);
  }
  return {{"name", way.name},  {"positions", pack(positions)}, {"rotations", pack(rotations)},
          {"stamps", stamps},  {"view", {0.6, 0.6 * way.aspect}}, {"length", 0.25}};
}

RgbImage to_image(const RecordedPicture& picture, int width) {
  const int across = std::min(width, picture.width);
  RgbImage image{across, std::max(1, picture.height * across / picture.width), {}};
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < across; ++x)
      for (int c = 0; c < 3; ++c) {
        const std::size_t from = std::size_t(y * picture.height / image.height) * std::size_t(picture.width) +
                                 std::size_t(x * picture.width / across);
        image.rgb.push_back(std::uint8_t(picture.values[from * 3 + std::size_t(c)]));
      }
  return image;
}

Json describe_frames(const std::string& folder, const CameraWay& way, const ViewOptions& options) {
  Json list = Json::array();
  const std::size_t frames = way.poses.size();
  const std::size_t count = std::min(frames, std::size_t(options.frames));
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t frame = count == 1 ? 0 : i * (frames - 1) / (count - 1);
    PictureWanted wanted;
    wanted.channel = "rgb";
    wanted.frame = int(frame);
    wanted.camera = way.name, wanted.topic = way.topic;
    const auto picture = find_recorded_picture(folder, wanted);
    if (!picture || picture->components != 3) break;
    const RgbImage image = to_image(*picture, options.width);
    list.push_back({{"frame", frame},
                    {"jpeg", base64(encode_jpeg(image.width, image.height, image.rgb.data(), 80))}});
  }
  return list;
}

constexpr const char* kLooks = R"(<style>
html, body { margin: 0; height: 100%; font: 14px/1.4 system-ui, sans-serif; }
#view { width: 100%; height: 100%; display: block; touch-action: none; cursor: grab; }
#panel { position: absolute; top: .6rem; left: .6rem; width: 17rem; padding: .6rem .8rem; color: #222;
  background: #fffd; border-radius: .4rem; }
#panel h1 { font-size: 1rem; margin: 0 0 .3rem; } #panel label { display: block; }
[hidden] { display: none !important; } #panel input[type=range] { width: 100%; } #picture { max-width: 100%; } #status, #frame { font-size: .8rem; }
</style>
)";

// What the mission has and the page has not: too many triangles, or of another pile.
std::string left_out(const Scenario& scenario, int voids_of_other_piles) {
  std::string names;
  if (scenario.fines.amount > 0) names = "fines";
  if (scenario.surroundings.on()) names += names.empty() ? "surroundings" : ", surroundings";
  if (voids_of_other_piles > 0) names += std::string(names.empty() ? "" : ", ") + "voids of another pile";
  return names.empty() ? "" : "<p id=\"left_out\">not on this page: " + names + "</p>\n";
}

std::string panel(const std::string& title, bool has_voids, bool has_robots, bool has_frames, const std::string& note) {
  const auto box = [](const char* id, const char* text) {
    return "<label><input type=\"checkbox\" id=\"" + std::string(id) + "\" checked> " + text + "</label>\n";
  };
  return "<canvas id=\"view\"></canvas>\n<div id=\"panel\">\n<h1>" + html_escape(title) + "</h1>\n" +
         box("pieces", "pieces") + "<label>opacity <input type=\"range\" id=\"opacity\" min=\"0.05\" max=\"1\" "
         "step=\"0.05\" value=\"1\"></label>\n<label>cut away <input type=\"range\" id=\"cut\" min=\"0\" "
         "max=\"1\" step=\"0.01\" value=\"1\"></label>\n" +
         box("voids", has_voids ? "voids" : "voids (none here: `rubble voids` maps them)") +
         box("track", "ways of cameras and robots") +
         (has_robots ? box("robots", "robots") : "") +
         "<label id=\"which\" hidden>camera <select id=\"camera\"></select></label>\n" +
         "<input type=\"range\" id=\"time\" min=\"0\" max=\"0\" value=\"0\"" +
         std::string(has_frames ? "" : " hidden") + ">\n<div id=\"frame\"></div>\n<img id=\"picture\" alt=\"\">\n" +
         note + "<p id=\"status\">loading</p>\n</div>\n";
}

}  // namespace

int count_voids_of_other_piles(const FinishedRun& saved) {
  return find_voids(saved.folder, load_pile_of(saved)).of_other_piles;
}

std::string make_dataset_page(const FinishedRun& saved, const AssetLibrary& assets, const ViewOptions& options) {
  const PileState pile = load_pile_of(saved);
  PileState pieces = pile;  // fines are too many triangles for a page
  pieces.fines = {};
  const PileModel model = build_pile_model(assets, pieces);
  Aabb bounds;
  for (const PileModel::Piece& piece : model.pieces) bounds.include(piece.world_from_body.translation);
  const Vec3 centre = model.pieces.empty() ? Vec3{} : (bounds.min + bounds.max) * 0.5;
  const double radius = model.pieces.empty() ? 1 : std::max(1.0, 0.5 * norm(bounds.max - bounds.min));
  const FoundVoids voids = find_voids(saved.folder, pile);
  const Scenario scenario = stated_scenario(saved.manifest.provenance);
  const std::string title = saved.manifest.provenance.script.path + ", seed " + std::to_string(saved.manifest.seed);
  Json data = {{"title", title},
               {"pieces", model.pieces.size()},
               {"centre", {centre.x, centre.y, centre.z}},
               {"radius", radius},
               {"types", describe_types(model, assets, options.triangles)},
               {"voids", describe_voids(voids.files)},
               {"tracks", Json::array()}};
  std::string not_shown = left_out(scenario, voids.of_other_piles);
  bool has_frames = false;
  for (const CameraWay& way : find_ways(saved.folder, scenario)) {
    Json track = describe_way(way);
    track["frames"] = describe_frames(saved.folder, way, options);
    data["tracks"].push_back(std::move(track));
    has_frames = has_frames || !way.poses.empty();
  }
  data["robots"] = describe_robots_of(saved.folder);
  if (!data["robots"].empty()) not_shown += "<p>Pieces are where they rested before robots moved them.</p>\n";
  std::string json = data.dump(-1, ' ', true, Json::error_handler_t::replace);
  for (std::size_t at = 0; (at = json.find('<', at)) != std::string::npos;) json.replace(at, 1, "\\u003c");
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>" + html_escape(title) +
         "</title>\n" + kLooks + "</head>\n<body>\n" + panel(title, !data["voids"].empty(), !data["robots"].empty(), has_frames, not_shown) +
         "<script type=\"application/json\" id=\"data\">" + json + "</script>\n<script>\n" + three_code() +
         "\n</script>\n<script>\n" + viewer_code() + "</script>\n</body>\n</html>\n";
}

}  // namespace rubble
