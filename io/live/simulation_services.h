// The services of ROS 2's package simulation_interfaces (version 2.1.0) on the wire: what is asked, and what is answered.
//
// A request and its reply begin with the client's number and the request's, as rmw_cyclonedds sends them; Request keeps
// both for the reply.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "io/live/wire_cursor.h"
#include "kernel/base/math.h"

namespace rubble::simulation_services {

// simulation_interfaces/Result; services have more codes of their own, above 100.
enum : std::uint8_t { kUnsupported = 0, kOk = 1, kNotFound = 2, kIncorrectState = 3, kFailed = 4 };

struct Result {
  std::uint8_t code = kOk;
  std::string message;
};

enum class State : std::uint8_t { stopped = 0, playing = 1, paused = 2, quitting = 3 };

// What a service is asked. Its members are read in the order of the service's definition. All throw RunError where the
// bytes are no such request.
class Request {
 public:
  // service: as errors name it. It and the bytes must outlive this.
  Request(const char* service, std::string_view bytes) : cursor_(service, ros::Version::ros2, bytes) {
    client_ = cursor_.number<std::uint64_t>();
    number_ = cursor_.number<std::int64_t>();
  }

  WireCursor& body() { return cursor_; }
  // Which the answer follows.
  ros::Wire reply() const {
    ros::Wire wire(ros::Version::ros2);
    wire.number(client_);
    wire.number(number_);
    return wire;
  }

 private:
  WireCursor cursor_;
  std::uint64_t client_ = 0;
  std::int64_t number_ = 0;
};

// simulation_interfaces/Bounds.
struct Bounds {
  std::uint8_t type = 0;  // 0: none, 1: box, 2: convex hull, 3: sphere
  std::vector<Vec3> points;  // box: upper right and lower left corner; sphere: centre, {radius, 0, 0}
};

// simulation_interfaces/EntityFilters.
struct Filters {
  std::string pattern;  // POSIX extended regular expression; empty: all
  std::vector<std::uint8_t> categories;
  std::vector<std::string> tags;
  bool all_tags = false;
  Bounds bounds;
};

// simulation_interfaces/EntityState.
struct EntityState {
  std::int64_t stamp_ns = 0;
  std::string frame;
  Pose pose;             // unit: m
  Vec3 linear, angular;  // of the entity's origin, in that frame; unit: m/s, rad/s
  bool valid_pose = true;  // whether the quaternion that came was one
};

struct SpawnRequest {
  std::string name;
  bool allow_renaming = false;
  std::string uri, resource_string;
  std::string entity_namespace, frame;
  Pose pose;
  bool valid_pose = true;
};

struct SetStateRequest {
  std::string entity;
  EntityState state;
  bool pose = false, twist = false, acceleration = false;  // what of it is set
};

Filters read_filters(WireCursor& body);
SetStateRequest read_set_state(WireCursor& body);
SpawnRequest read_spawn(WireCursor& body);

void put(ros::Wire& wire, const Result& result);
void put(ros::Wire& wire, const std::vector<std::string>& texts);
void put(ros::Wire& wire, const EntityState& state);

}  // namespace rubble::simulation_services
