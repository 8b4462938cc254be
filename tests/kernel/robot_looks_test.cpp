// What the bundled robots look like: closed solids about what collides, which leave cameras and scanners their view.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>

#include "kernel/base/portable_math.h"
#include "kernel/geometry/hull.h"
#include "kernel/world/world_robots.h"
#include "robot_scenes.h"

namespace rubble {
namespace robot_looks_test {

std::vector<RobotModel> all_models() {
  VineOptions vine;
  vine.tube.links = 3;
  CrawlerOptions bare;
  bare.flippers = false;
  return {make_crawler(), make_crawler(bare), make_rover(), make_snake(), make_vine(vine)};
}

// Bodies of their own within a mesh: triangles that share corners.
std::vector<TriangleMesh> split(const TriangleMesh& mesh) {
  std::map<std::tuple<float, float, float>, std::size_t> known;
  std::vector<std::size_t> corner(mesh.positions.size()), root(mesh.positions.size());
  std::iota(root.begin(), root.end(), std::size_t{0});
  for (std::size_t i = 0; i < corner.size(); ++i) {
    const Vec3f& p = mesh.positions[i];
    corner[i] = known.emplace(std::make_tuple(p.x, p.y, p.z), i).first->second;
  }
  const auto find = [&](std::size_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t v : t) root[find(corner[v])] = find(corner[t[0]]);
  std::map<std::size_t, TriangleMesh> bodies;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    TriangleMesh& body = bodies[find(corner[mesh.triangles[t][0]])];
    body.positions = mesh.positions;
    body.triangles.push_back(mesh.triangles[t]);
    body.surfaces.push_back(0);
  }
  std::vector<TriangleMesh> list;
  for (auto& [first, body] : bodies) list.push_back(std::move(body));
  return list;
}

TEST(RobotLooks, AreClosedSolidsThatFaceOutwards) {
  for (const RobotModel& model : all_models()) {
    for (const RobotLink& link : model.links) {
      ASSERT_FALSE(link.looks.triangles.empty()) << model.name << " " << link.name;
      ASSERT_EQ(link.looks.normals.size(), link.looks.positions.size());
      std::size_t number = 0;
      for (const TriangleMesh& body : split(link.looks)) {
        const Vec3f& at = body.positions[body.triangles[0][0]];
        const std::string where = model.name + " " + link.name + " body " + std::to_string(number++) + " at " +
                                  std::to_string(at.x) + " " + std::to_string(at.y) + " " + std::to_string(at.z);
        EXPECT_TRUE(is_closed(body)) << where;
        EXPECT_GT(calc_volume_properties(body).volume, 0) << where;
      }
      for (const auto& t : link.looks.triangles) {
        const Vec3f &a = link.looks.positions[t[0]], &b = link.looks.positions[t[1]], &c = link.looks.positions[t[2]];
        const Vec3f face = cross(b - a, c - a);
        for (const std::uint32_t v : t) ASSERT_GT(dot(face, link.looks.normals[v]), 0) << link.name;
      }
    }
  }
}

TEST(RobotLooks, HaveFewTriangles) {
  for (const RobotModel& model : all_models()) {
    std::size_t all = 0;
    for (const RobotLink& link : model.links) {
      EXPECT_LE(link.looks.triangles.size(), 6500u) << model.name << " " << link.name;
      all += link.looks.triangles.size();
    }
    EXPECT_LE(all, 29000u) << model.name;
  }
}

// How far a point is beyond the faces of what collides of a link; negative inside. unit: m
double distance_beyond(const std::vector<Hull>& hulls, const Vec3& point) {
  double least = 1e9;
  for (const Hull& hull : hulls) {
    double beyond = -1e9;
    for (const std::vector<int>& face : hull.faces) {
      const auto corner = [&](std::size_t i) { return hull.points[std::size_t(face[i])]; };
      const Vec3 n = normalized(cross(corner(1) - corner(0), corner(2) - corner(0)));
      beyond = std::max(beyond, dot(n, point - corner(0)));
    }
    least = std::min(least, beyond);
  }
  return least;
}

struct Reach {
  double out = -1e9;  // how far the looks stand out of the hulls; unit: m
  double low = 1e9;   // their lowest point above that of the hulls; unit: m
};

Reach measure_reach(const RobotLink& link) {
  std::vector<Hull> hulls;
  double lowest = 1e9;
  for (const ConvexPart& part : link.parts) {
    hulls.push_back(calc_hull(part.points));
    for (const Vec3& p : part.points) lowest = std::min(lowest, p.z);
  }
  Reach reach;
  for (const Vec3f& p : link.looks.positions) {
    reach.out = std::max(reach.out, distance_beyond(hulls, Vec3(p)));
    reach.low = std::min(reach.low, double(p.z) - lowest);
  }
  return reach;
}

TEST(RobotLooks, StandOnWhatCollides) {
  const RobotModel crawler = make_crawler(), rover = make_rover(), snake = make_snake();
  for (const RobotModel* model : {&crawler, &rover, &snake}) {
    for (std::size_t i = 0; i < model->links.size(); ++i) {
      const RobotLink& link = model->links[i];
      const Reach reach = measure_reach(link);
      // A module's front joint reaches into its neighbour, a tether comes out of the tail, and sensors stand on a deck.
      const bool module = model == &snake;
      const bool tail = module && i + 1 == snake.links.size(), body = !module && i == 0;
      EXPECT_LT(reach.out, body ? 0.2 : tail ? 0.035 : module ? 0.021 : 0.0095) << link.name;
      // Their lowest points are where they would touch level ground.
      EXPECT_GT(reach.low, -0.001) << link.name;
      EXPECT_LT(reach.low, body ? 0.01 : 0.001) << link.name;
    }
  }
}

// Whether a ray meets the triangle nearer than `reach`, from either side (Moller and Trumbore 1997).
bool meets(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& origin, const Vec3& direction, double reach) {
  const Vec3 ab = b - a, ac = c - a, p = cross(direction, ac), from = origin - a, q = cross(from, ab);
  const double det = dot(ab, p);
  if (std::fabs(det) < 1e-15) return false;
  const double u = dot(from, p) / det, v = dot(direction, q) / det, t = dot(ac, q) / det;
  return u >= 0 && v >= 0 && u + v <= 1 && t >= 0 && t < reach;
}

// Whether a robot in its links' zero poses, its base in the origin, has anything within `reach` along a ray.
bool meets(const RobotModel& model, const Vec3& origin, const Vec3& direction, double reach) {
  std::vector<Pose> base_from_link(model.links.size());
  for (const RobotJoint& joint : model.joints)
    base_from_link[std::size_t(joint.child)] = base_from_link[std::size_t(joint.parent)] * joint.parent_from_child;
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const Pose link_from_base = base_from_link[i].inverse();
    const Vec3 from = link_from_base * origin, along = link_from_base.rotation.rotate(direction);
    const TriangleMesh& mesh = model.links[i].looks;
    for (const auto& t : mesh.triangles) {
      const auto corner = [&](std::size_t k) { return Vec3(mesh.positions[t[k]]); };
      if (meets(corner(0), corner(1), corner(2), from, along, reach)) return true;
    }
  }
  return false;
}

Vec3 direction_of(double yaw_deg, double up_deg) {
  const auto [ys, yc] = portable::sincos(yaw_deg * portable::kPi / 180);
  const auto [us, uc] = portable::sincos(up_deg * portable::kPi / 180);
  return {yc * uc, ys * uc, us};
}

struct Mount {
  const char* what;
  Vec3 position;
  double half_yaw_deg, down_deg, up_deg;  // what it sees
};

void expect_free_view(const RobotModel& model, const Mount& mount) {
  for (double yaw = -mount.half_yaw_deg; yaw <= mount.half_yaw_deg; yaw += 7.5)
    for (double up = -mount.down_deg; up <= mount.up_deg; up += 7.5)
      EXPECT_FALSE(meets(model, mount.position, direction_of(yaw, up), 1)) << mount.what << " " << yaw << " " << up;
}

// Where missions put cameras and scanners: docs/reference/robots.md and scripts/robots.
TEST(RobotLooks, LeaveSensorsTheirView) {
  CrawlerOptions bare;  // flippers are seen, as they should be
  bare.flippers = false;
  for (const Mount& mount :
       {Mount{"camera", {0.3, 0, 0.3}, 45, 52.5, 30}, Mount{"camera", {0.32, 0, 0.3}, 45, 52.5, 30},
        Mount{"LiDAR", {0, 0, 0.4}, 180, 15, 15}, Mount{"scanner", {0.3, 0, 0.3}, 135, 0, 0}})
    expect_free_view(make_crawler(bare), mount);
  const RobotModel rover = make_rover();
  for (const Mount& mount : {Mount{"camera", {0.2, 0, 0.25}, 45, 45, 30}, Mount{"camera", {0.22, 0, 0.25}, 45, 45, 30},
                             Mount{"camera", {0.3, 0, 0.2}, 45, 45, 30}, Mount{"scanner", {0.25, 0, 0.15}, 90, 0, 0},
                             Mount{"scanner", {0, 0, 0.3}, 180, 0, 0}, Mount{"LiDAR", {0, 0, 0.4}, 180, 15, 15}})
    expect_free_view(rover, mount);
  const RobotModel snake = make_snake();
  for (const double x : {0.05, 0.06}) expect_free_view(snake, {"camera", {x, 0, 0}, 60, 45, 45});
  expect_free_view(snake, {"camera", {0.05, 0, 0.04}, 45, 30, 30});
  // The test can fail: a camera in the crawler's mast sees it.
  EXPECT_TRUE(meets(make_crawler(bare), {0, 0, 0.25}, {1, 0, 0}, 1));
}

TEST(RobotLooks, DoNotChangeTheMotion) {
  for (RobotModel model : {make_crawler(), make_rover(), make_snake()}) {
    std::uint64_t hashes[2] = {};
    for (int k = 0; k < 2; ++k) {
      World world = testing::make_robot_world({testing::box_type("block", 0.1, 0.5, 0.06)});
      NewPiece piece;
      piece.placement = {0, 1, {{}, {0.5, 0, 0.03}}, false};
      world.add({piece});
      const int robot = world.robots().add(model, {{}, {0, 0, 0.03}});
      testing::drive(world, robot, 1, [&](double time) {
        if (model.sides.any()) return drive_sides(model, 0.5, 0.2);
        return calc_gait(model, sidewinding(), time);
      });
      hashes[k] = testing::hash_of(world);
      for (RobotLink& link : model.links) link.looks = {};
    }
    EXPECT_EQ(hashes[0], hashes[1]) << model.name;
  }
}

}  // namespace robot_looks_test
}  // namespace rubble
