#include "app/eval/map/map_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "io/base/atomic_file.h"
#include "io/base/little_endian.h"
#include "kernel/base/number_text.h"

namespace rubble {
namespace {

std::optional<double> percent_of(double part, double whole) {
  if (!(whole > 0)) return std::nullopt;
  return 100 * part / whole;
}

double count_found(const FoundVoids& voids) {
  double found = 0;
  for (const auto& entrances : voids.entrances)
    found += double(std::count(entrances.begin(), entrances.end(), 1));
  return found;
}

double count_entrances(const RobotVoids& robot) {
  double count = 0;
  for (const Void& v : robot.voids) count += double(v.entrances.size());
  return count;
}

void add_robot(const MapFindings& f, const VoidMap& voids, std::size_t r,
               std::vector<ScoreCell>& cells) {
  const RobotVoids& robot = voids.robots[r];
  const std::string key = "r" + std::to_string(int(std::lround(robot.radius * 1000)));
  const std::string of = "robot of " + fixed_text(robot.radius, 3) + " m: ";
  const FoundVoids &found = f.found.robots[r], &best = f.best.robots[r];
  cells.push_back({key + "_void_m3", of + "void, m3", robot.volume, 3});
  cells.push_back({key + "_found_percent", of + "void found, %",
                   percent_of(found.volume, robot.volume), 1});
  cells.push_back({key + "_visible_percent", of + "the most that could be, %",
                   percent_of(best.volume, robot.volume), 1});
  cells.push_back({key + "_entrances", of + "entrances", count_entrances(robot), 0});
  cells.push_back({key + "_entrances_found", of + "entrances found", count_found(found), 0});
  cells.push_back({key + "_entrances_visible", of + "the most that could be", count_found(best), 0});
}

// visit(radius, rank of the void, entrance, found, best)
template <typename Visit>
void for_each_entrance(const MapFindings& f, const VoidMap& voids, Visit&& visit) {
  for (std::size_t r = 0; r < voids.robots.size(); ++r)
    for (std::size_t v = 0; v < voids.robots[r].voids.size(); ++v) {
      const std::vector<Entrance>& entrances = voids.robots[r].voids[v].entrances;
      for (std::size_t e = 0; e < entrances.size(); ++e)
        visit(voids.robots[r].radius, v + 1, entrances[e],
              bool(f.found.robots[r].entrances[v][e]), bool(f.best.robots[r].entrances[v][e]));
    }
}

struct Colour {
  std::uint8_t r, g, b;
};

void write_cloud(const std::string& path, const std::vector<Vec3>& points,
                 const std::vector<double>& distances, const Colour& near, const Colour& far) {
  std::string bytes;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (int k = 0; k < 3; ++k) put(bytes, float(points[i][k]));
    const Colour& c = distances[i] <= kNearSurface ? near : far;
    put(bytes, c.r), put(bytes, c.g), put(bytes, c.b);
    put(bytes, float(distances[i]));
  }
  write_text_file(path, "ply\nformat binary_little_endian 1.0\nelement vertex " +
                            std::to_string(points.size()) +
                            "\nproperty float x\nproperty float y\nproperty float z\n"
                            "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                            "property float distance\nend_header\n" +
                            bytes);
}

std::string comma_text(const Vec3& p) {
  return exact_text(p.x) + "," + exact_text(p.y) + "," + exact_text(p.z);
}

}  // namespace

ScoreRow make_map_row(const std::string& name, const MapFindings& f, const VoidMap& voids) {
  ScoreRow row{name, {}};
  const auto add = [&](const char* key, const char* heading, std::optional<double> value,
                       int digits) { row.cells.push_back({key, heading, value, digits}); };
  add("triangles", "triangles", double(f.map.triangles.size()), 0);
  add("samples", "samples", double(f.samples.size()), 0);
  add("within_1cm_percent", "within 1 cm of the surface, %", 100 * f.accuracy.within_1cm, 1);
  add("within_2cm_percent", "within 2 cm, %", 100 * f.accuracy.within_2cm, 1);
  add("within_5cm_percent", "within 5 cm, %", 100 * f.accuracy.within_5cm, 1);
  add("median_distance_m", "median distance, m", f.accuracy.median, 4);
  add("percentile_90_distance_m", "90 % are within, m", f.accuracy.percentile_90, 4);
  add("unseen_percent", "at a surface that no frame saw, %", 100 * f.accuracy.unseen, 1);
  add("visible_m2", "visible surface, m2", f.seen.area(), 1);
  const bool any = !f.seen.points.empty();
  const auto complete = [&](double share) {
    return any ? std::optional<double>(100 * share) : std::nullopt;
  };
  add("complete_1cm_percent", "visible surface within 1 cm, %",
      complete(f.completeness.within_1cm), 1);
  add("complete_2cm_percent", "visible surface within 2 cm, %",
      complete(f.completeness.within_2cm), 1);
  add("complete_5cm_percent", "visible surface within 5 cm, %",
      complete(f.completeness.within_5cm), 1);
  add("void_m3", "void, m3", voids.void_volume, 3);
  add("void_found_percent", "void found, %", percent_of(f.found.volume, voids.void_volume), 1);
  add("void_visible_percent", "the most that could be, %",
      percent_of(f.best.volume, voids.void_volume), 1);
  for (std::size_t r = 0; r < voids.robots.size(); ++r) add_robot(f, voids, r, row.cells);
  return row;
}

std::string entrance_text(const MapFindings& findings, const VoidMap& voids) {
  std::string text = "  entrance of        void  at x, y, z, m                clear radius, m\n";
  const std::size_t heading = text.size();
  for_each_entrance(findings, voids, [&](double radius, std::size_t rank, const Entrance& e,
                                         bool found, bool best) {
    char line[160];
    std::snprintf(line, sizeof line, "  robot of %.3f m %6zu  %8.2f %8.2f %8.2f %16.3f   %s\n",
                  radius, rank, e.position.x, e.position.y, e.position.z, e.radius,
                  found  ? "found"
                  : best ? "missed"
                         : "not seen by the run");
    text += line;
  });
  return text.size() > heading ? text : "";
}

void write_map_details(const std::string& folder, const std::string& name,
                       const MapFindings& f, const VoidMap& voids) {
  const std::string stem = folder + "/" + name;
  const Colour green{40, 160, 70}, blue{60, 110, 200}, red{200, 60, 40};
  write_cloud(stem + "_map.ply", f.samples, f.accuracy.distances, blue, red);
  write_cloud(stem + "_seen.ply", f.seen.points, f.completeness.distances, green, red);
  std::string text =
      "radius_m,void,x,y,z,inward_x,inward_y,inward_z,clear_radius_m,visible,found\n";
  for_each_entrance(f, voids, [&](double radius, std::size_t rank, const Entrance& e, bool found,
                                  bool best) {
    text += exact_text(radius) + "," + std::to_string(rank) + "," + comma_text(e.position) + "," +
            comma_text(e.inward) + "," + exact_text(e.radius) + (best ? ",1" : ",0") +
            (found ? ",1\n" : ",0\n");
  });
  write_text_file(stem + "_entrances.csv", text);
}

}  // namespace rubble
