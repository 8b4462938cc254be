#include "app/view/page_parts.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/eval/scores/trajectory_file.h"
#include "io/base/atomic_file.h"
#include "io/mesh/mesh_file.h"
#include "io/robot/urdf_writer.h"
#include "io/state/track_file.h"
#include "kernel/base/error.h"

namespace rubble {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t kMostSamples = 300;        // of a way
constexpr std::size_t kMostTriangles = 20'000;   // of a link; one that has more is shown by its convex parts

void add_mesh(const TriangleMesh& mesh, PackedMesh& packed) {
  const auto first = std::uint32_t(packed.positions.size() / 3);
  for (const Vec3f& p : mesh.positions) add(packed.positions, Vec3(p));
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t v : t) packed.indices.push_back(first + v);
}

// As write_robot_description() left them; nothing for a link without a shape.
PackedMesh load_link(const std::string& robots, const std::string& meshes, const std::string& link, MeshImporter& importer) {
  PackedMesh packed;
  std::error_code failed;
  const std::string whole = robots + "/" + link_mesh_file(meshes, link);
  if (!fs::is_regular_file(whole, failed)) return packed;
  const TriangleMesh mesh = importer.load_mesh(whole);
  if (mesh.triangles.size() <= kMostTriangles) {
    add_mesh(mesh, packed);
    return packed;
  }
  for (std::size_t part = 0; fs::is_regular_file(robots + "/" + part_mesh_file(meshes, link, part), failed); ++part)
    add_mesh(importer.load_mesh(robots + "/" + part_mesh_file(meshes, link, part)), packed);
  return packed;
}

std::vector<double> choose_times(const Track& track) {
  const std::size_t every = track.times.size() / kMostSamples + 1;
  std::vector<double> times;
  for (std::size_t i = 0; i < track.times.size(); i += every) times.push_back(track.times[i]);
  return times;
}

// Position and x, y, z, w of the rotation for each time; where it is not there, as before.
std::vector<float> list_poses(const Track& track, int id, const std::vector<double>& times) {
  std::vector<float> poses;
  Pose last;
  const TrackBody* const body = track.find(id);
  for (const double time : times) {
    if (body)
      if (const auto motion = track.motion_at(*body, time)) last = motion->world_from_body;
    add(poses, last.translation);
    for (const double v : {last.rotation.x, last.rotation.y, last.rotation.z, last.rotation.w}) poses.push_back(float(v));
  }
  return poses;
}

}  // namespace

Json describe_robots_of(const std::string& folder) {
  Json list = Json::array();
  const std::string robots = folder + "/robots";
  std::error_code failed;
  if (!fs::is_regular_file(robots + "/robots.json", failed)) return list;
  const Track track = load_track(robots + "/track.bin");
  const std::vector<double> times = choose_times(track);
  MeshImporter importer;
  try {
    const Json told = Json::parse(read_whole_file(robots + "/robots.json"));
    for (const Json& robot : told.at("robots")) {
      const std::string name = robot.at("name").get<std::string>();
      // Its rows are samples of the track, from its time 0 on.
      const std::vector<StampedPose> poses = load_trajectory(robots + "/" + name + ".txt");
      std::vector<double> stamps;
      for (const double time : times) stamps.push_back(poses.front().stamp + time);
      Json links = Json::array();
      for (const Json& link : robot.at("links")) {
        const PackedMesh mesh = load_link(robots, name + "_meshes", link.at("name").get<std::string>(), importer);
        if (mesh.indices.empty()) continue;
        Json one = mesh.json();
        one["poses"] = pack(list_poses(track, link.at("id").get<int>(), times));
        links.push_back(std::move(one));
      }
      const std::vector<float> base = list_poses(track, robot.at("links").at(0).at("id").get<int>(), times);
      std::vector<float> way;
      for (std::size_t i = 0; i < base.size(); i += 7) way.insert(way.end(), base.begin() + std::ptrdiff_t(i), base.begin() + std::ptrdiff_t(i) + 3);
      list.push_back({{"name", name}, {"stamps", stamps}, {"positions", pack(way)}, {"links", links}});
    }
  } catch (const Json::exception&) {
    throw InputError({robots + "/robots.json", 0, "", "is not what a run writes", "the robots of the run", "", "run the mission again"});
  }
  return list;
}

}  // namespace rubble
