#include "app/serve/simulation_server.h"

#include <regex.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "app/formats/recording_formats.h"
#include "app/pipeline/live.h"
#include "app/pipeline/recorders.h"
#include "app/support/stop.h"
#include "io/live/drive_commands.h"
#include "io/live/live_ros.h"
#include "kernel/world/world_robots.h"

namespace rubble {

using namespace simulation_services;

namespace {

// A POSIX extended regular expression; an empty one fits all.
class NamePattern {
 public:
  explicit NamePattern(const std::string& text)
      : empty_(text.empty()), valid_(empty_ || regcomp(&compiled_, text.c_str(), REG_EXTENDED | REG_NOSUB) == 0) {}
  NamePattern(const NamePattern&) = delete;
  NamePattern& operator=(const NamePattern&) = delete;
  ~NamePattern() {
    if (valid_ && !empty_) regfree(&compiled_);
  }
  bool is_valid() const { return valid_; }
  bool fits(const std::string& name) const { return empty_ || regexec(&compiled_, name.c_str(), 0, nullptr, 0) == 0; }

 private:
  regex_t compiled_;
  bool empty_, valid_;
};

constexpr std::chrono::milliseconds kNap{2};  // between looks at requests while nothing is simulated

enum : std::uint8_t { kRobot = 1, kHuman = 2, kDynamic = 4, kStatic = 5 };  // EntityCategory

std::uint8_t category_of(const ServedWorld& world, const Entity& entity) {
  if (entity.robot) return kRobot;
  return entity.human ? kHuman : world.movable(entity) ? kDynamic : kStatic;
}

std::vector<std::string> tags_of(const Entity& entity) { return {entity.robot ? "robot" : "piece", entity.asset}; }

bool has_tags(const Entity& entity, const Filters& filters) {
  const std::vector<std::string> own = tags_of(entity);
  const auto has = [&](const std::string& tag) { return std::find(own.begin(), own.end(), tag) != own.end(); };
  return filters.all_tags ? std::all_of(filters.tags.begin(), filters.tags.end(), has)
                          : std::any_of(filters.tags.begin(), filters.tags.end(), has);
}

bool within(const Bounds& bounds, const Vec3& p) {
  if (bounds.type == 3) return distance(p, bounds.points[0]) <= bounds.points[1].x;
  const Vec3 low = min(bounds.points[0], bounds.points[1]), high = max(bounds.points[0], bounds.points[1]);
  return p.x >= low.x && p.y >= low.y && p.z >= low.z && p.x <= high.x && p.y <= high.y && p.z <= high.z;
}

// What follows the result of a service that did nothing.
using Rest = void (*)(ros::Wire&);
constexpr Rest kNothing = [](ros::Wire&) {};
constexpr Rest kNoList = [](ros::Wire& reply) { reply.count(0); };
constexpr Rest kNoLists = [](ros::Wire& reply) { reply.count(0), reply.count(0); };
constexpr Rest kNoName = [](ros::Wire& reply) { reply.text(""); };
constexpr Rest kNoState = [](ros::Wire& reply) { put(reply, EntityState()); };
constexpr Rest kNoInfo = [](ros::Wire& reply) { reply.number(std::uint8_t{0}), reply.text(""), reply.count(0); };

bool is_name(const std::string& name) {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  return !name.empty() && letter(name[0]) &&
         std::all_of(name.begin(), name.end(), [&](char c) { return letter(c) || (c >= '0' && c <= '9'); });
}

}  // namespace

const std::vector<SimulationServer::Service>& SimulationServer::services() {
  static const std::vector<Service> all{
      {"get_simulator_features", "GetSimulatorFeatures", &SimulationServer::get_features, kNothing},
      {"get_simulation_state", "GetSimulationState", &SimulationServer::get_state, kNothing},
      {"set_simulation_state", "SetSimulationState", &SimulationServer::set_state, kNothing},
      {"reset_simulation", "ResetSimulation", &SimulationServer::reset, kNothing},
      {"step_simulation", "StepSimulation", &SimulationServer::step_simulation, kNothing},
      {"get_entities", "GetEntities", &SimulationServer::get_entities, kNoList},
      {"get_entities_states", "GetEntitiesStates", &SimulationServer::get_entities_states, kNoLists},
      {"get_entity_state", "GetEntityState", &SimulationServer::get_entity_state, kNoState},
      {"set_entity_state", "SetEntityState", &SimulationServer::set_entity_state, kNothing},
      {"get_entity_info", "GetEntityInfo", &SimulationServer::get_entity_info, kNoInfo},
      {"get_spawnables", "GetSpawnables", &SimulationServer::get_spawnables, kNoList},
      {"spawn_entity", "SpawnEntity", &SimulationServer::spawn, kNoName},
      {"delete_entity", "DeleteEntity", &SimulationServer::remove, kNothing},
  };
  return all;
}

SimulationServer::SimulationServer(ServedWorld& world, LiveServer& server, bool paused,
                                   const std::function<void(const std::string&)>& notice)
    : world_(world), server_(server), complaints_(notice), state_(paused ? State::paused : State::playing) {
  for (const Service& service : services())
    numbers_.push_back(server_.serve(std::string("/") + service.name, std::string("simulation_interfaces/srv/") + service.type));
  begin();
}

SimulationServer::~SimulationServer() = default;

void SimulationServer::begin() {
  Session& session = world_.session();
  Recording recording = describe_recording(world_.mission().scenario, world_.mission().assets, world_.pile(), session.records());
  recording.cameras.clear();
  recording.mount = session.mount();
  recorder_ = make_ros_recorder("the live stream", keep_stream(server_, topics_),
                                ros_options(world_.mission().scenario.outputs, recording));
  twists_until_.clear();
  stepping_ = false;
  for (std::size_t i = 0; i < session.records().size(); ++i) {
    if (!world_.teleop(i)) continue;
    const std::string& prefix = session.records()[i].topic;
    const auto listen = [&](const char* topic, const char* type, bool reliable) {
      if (heard_.count(prefix + topic) == 0) heard_[prefix + topic] = server_.listen(prefix + topic, type, reliable);
    };
    listen("/cmd_vel", "geometry_msgs/msg/Twist", false);
    listen("/joint_trajectory", "trajectory_msgs/msg/JointTrajectory", true);
    listen("/joint_commands", "sensor_msgs/msg/JointState", true);
  }
}

void SimulationServer::run(double duration) {
  while (state_ != State::quitting && !stop_requested() && (duration <= 0 || world_.time() < duration)) {
    answer_all();
    if (state_ == State::playing)
      step();
    else if (state_ != State::quitting)
      std::this_thread::sleep_for(kNap);
  }
}

void SimulationServer::step() {
  hear();
  world_.step();
  for (const Sample& sample : world_.session().observe()) write_sample(*recorder_, sample);
}

// A message that is none is said and left out.
void SimulationServer::hear() {
  const Session& session = world_.session();
  for (std::size_t i = 0; i < session.records().size(); ++i) {
    TeleopRobot* const robot = world_.teleop(i);
    if (!robot) continue;
    const std::string& prefix = session.records()[i].topic;
    const auto take = [&](const char* topic, const auto& use) {
      for (const std::string& bytes : server_.take(heard_.at(prefix + topic))) {
        try {
          use(bytes);
        } catch (const std::runtime_error& error) {
          complaints_.note(prefix + topic, error.what());
        }
      }
    };
    const auto follow = [&](const JointTrajectoryCommand& command) {
      robot->follow(command, session.robots()[i].model, session.world().robots().state(int(i)), world_.time());
    };
    take("/cmd_vel", [&](const std::string& bytes) {
      const TwistCommand twist = read_twist(ros::Version::ros2, bytes);
      TeleopCommand asked;
      asked.linear = twist.linear, asked.angular = twist.angular;
      robot->ask(asked);
      twists_until_[prefix] = world_.time() + kTwistHolds;
    });
    take("/joint_trajectory", [&](const std::string& bytes) { follow(read_joint_trajectory(ros::Version::ros2, bytes)); });
    take("/joint_commands", [&](const std::string& bytes) { follow(read_joint_command(ros::Version::ros2, bytes)); });
    const auto until = twists_until_.find(prefix);
    if (until == twists_until_.end() || world_.time() <= until->second) continue;
    robot->ask({});
    twists_until_.erase(until);
  }
}

void SimulationServer::answer_all() {
  for (std::size_t i = 0; i < numbers_.size(); ++i)
    for (const std::string& bytes : server_.take_requests(numbers_[i])) answer(i, bytes);
}

// One that does not even say who asks is left without an answer.
void SimulationServer::answer(std::size_t number, const std::string& bytes) {
  const Service& service = services()[number];
  try {
    Request request(service.type, bytes);
    ros::Wire reply = request.reply();
    try {
      (this->*service.answer)(request.body(), reply);
    } catch (const RunError& error) {
      complaints_.note(service.name, error.what());
      reply = request.reply();
      put(reply, Result{kFailed, error.what()});
      service.rest(reply);
    }
    server_.reply(numbers_[number], reply.take());
  } catch (const RunError& error) {
    complaints_.note(service.name, error.what());
  }
}

// Of simulation_interfaces/SimulatorFeatures. 21 to 23, to reset time, state or what was spawned each alone, are not there.
void SimulationServer::get_features(WireCursor&, ros::Wire& reply) {
  const std::uint16_t features[] = {0, 1, 4, 6, 8, 10, 11, 12, 14, 20, 24, 25, 26, 31, 32};
  reply.count(std::size(features));
  for (const std::uint16_t feature : features) reply.number(feature);
  put(reply, std::vector<std::string>{"urdf"});
  reply.text("Rubble; simulation_interfaces 2.1.0; docs/how_to/live.md");
}

void SimulationServer::get_state(WireCursor&, ros::Wire& reply) {
  reply.number(std::uint8_t(state_));
  put(reply, Result());
}

Result SimulationServer::change_state(State target) {
  if (target > State::quitting) return {kUnsupported, "states 0 to 3: stopped, playing, paused, quitting"};
  if (target == state_) return {101, "it is in this state already"};
  if (target == State::paused && state_ == State::stopped) return {103, "it is stopped: play first"};
  if (target == State::stopped) world_.restart(false), begin();
  state_ = target;
  stepping_ = false;
  return {};
}

void SimulationServer::set_state(WireCursor& body, ros::Wire& reply) {
  const auto target = State(body.number<std::uint8_t>());
  body.end();
  put(reply, change_state(target));
}

void SimulationServer::reset(WireCursor& body, ros::Wire& reply) {
  const int scope = body.number<std::uint8_t>();
  body.end();
  if (scope != 0 && scope != 3 && scope != 7 && scope != 255)
    return put(reply, Result{kUnsupported, "time and state are reset together: scope 0, 3 (keeps what was spawned), 7 or 255"});
  world_.restart(scope != 3);
  begin();
  put(reply, Result());
}

void SimulationServer::step_simulation(WireCursor& body, ros::Wire& reply) {
  const auto steps = body.number<std::uint64_t>();
  body.end();
  if (state_ != State::paused) return put(reply, Result{kIncorrectState, "it is not paused"});
  if (stepping_) return put(reply, Result{kIncorrectState, "steps are being made"});
  stepping_ = true;
  for (std::uint64_t i = 0; i < steps; ++i) {
    answer_all();  // who pauses, plays or resets ends it
    if (!stepping_ || stop_requested()) {
      stepping_ = false;
      return put(reply, Result{kFailed, "ended after " + std::to_string(i) + " steps"});
    }
    step();
  }
  stepping_ = false;
  put(reply, Result());
}

Result SimulationServer::select(const Filters& filters, std::vector<const Entity*>& selected) const {
  const Bounds& bounds = filters.bounds;
  if (bounds.type == 2 || bounds.type > 3) return {kUnsupported, "bounds: a box (1) or a sphere (3)"};
  if (bounds.type != 0 && bounds.points.size() != 2) return {kFailed, "bounds: two points"};
  const NamePattern pattern(filters.pattern);
  if (!pattern.is_valid()) return {kFailed, "filter: no POSIX extended regular expression: " + filters.pattern};
  for (const Entity& entity : world_.entities()) {
    const auto& categories = filters.categories;
    if (!categories.empty() && std::find(categories.begin(), categories.end(), category_of(world_, entity)) == categories.end())
      continue;
    if (!filters.tags.empty() && !has_tags(entity, filters)) continue;
    if (!pattern.fits(entity.name)) continue;
    const auto state = world_.state_of(entity);
    if (state && (bounds.type == 0 || within(bounds, state->pose.translation))) selected.push_back(&entity);
  }
  return {};
}

EntityState SimulationServer::state_of(const Entity& entity) const {
  const auto now = world_.state_of(entity);
  EntityState state;
  state.stamp_ns = world_.stamp_ns();
  state.frame = ros::kWorld;
  if (now) state.pose = now->pose, state.linear = now->linear, state.angular = now->angular;
  return state;
}

void SimulationServer::get_entities(WireCursor& body, ros::Wire& reply) {
  std::vector<const Entity*> selected;
  put(reply, select(read_filters(body), selected));
  std::vector<std::string> names;
  for (const Entity* entity : selected) names.push_back(entity->name);
  put(reply, names);
}

void SimulationServer::get_entities_states(WireCursor& body, ros::Wire& reply) {
  std::vector<const Entity*> selected;
  put(reply, select(read_filters(body), selected));
  std::vector<std::string> names;
  for (const Entity* entity : selected) names.push_back(entity->name);
  put(reply, names);
  reply.count(selected.size());
  for (const Entity* entity : selected) put(reply, state_of(*entity));
}

void SimulationServer::get_entity_state(WireCursor& body, ros::Wire& reply) {
  const std::string name = body.text();
  body.end();
  const Entity* const entity = world_.find(name);
  const bool there = entity && world_.state_of(*entity);
  put(reply, there ? Result() : Result{kNotFound, entity ? name + " has left the world" : "no entity `" + name + "`"});
  put(reply, there ? state_of(*entity) : EntityState());
}

void SimulationServer::set_entity_state(WireCursor& body, ros::Wire& reply) {
  const SetStateRequest asked = read_set_state(body);
  const Entity* const entity = world_.find(asked.entity);
  if (!entity || !world_.state_of(*entity)) return put(reply, Result{kNotFound, "no entity `" + asked.entity + "`"});
  if (!world_.movable(*entity)) return put(reply, Result{kFailed, "`" + asked.entity + "` is fixed"});
  if (asked.acceleration) return put(reply, Result{kUnsupported, "accelerations follow from forces"});
  if (!asked.state.frame.empty() && asked.state.frame != ros::kWorld)
    return put(reply, Result{kNotFound, "frame `" + asked.state.frame + "`: only `world`"});
  if (asked.pose && !asked.state.valid_pose) return put(reply, Result{101, "no pose: expected finite numbers and a quaternion of length 1"});
  world_.set_state(*entity, {asked.state.pose, asked.state.linear, asked.state.angular}, asked.pose, asked.twist);
  put(reply, Result());
}

void SimulationServer::get_entity_info(WireCursor& body, ros::Wire& reply) {
  const std::string name = body.text();
  body.end();
  const Entity* const entity = world_.find(name);
  put(reply, entity ? Result() : Result{kNotFound, "no entity `" + name + "`"});
  reply.number(entity ? category_of(world_, *entity) : std::uint8_t{0});
  reply.text(entity ? entity->asset : "");
  put(reply, entity ? tags_of(*entity) : std::vector<std::string>());
}

void SimulationServer::get_spawnables(WireCursor& body, ros::Wire& reply) {
  const std::size_t sources = body.count(4);
  for (std::size_t i = 0; i < sources; ++i) body.text();
  body.end();
  put(reply, sources == 0 ? Result() : Result{kUnsupported, "sources: none"});
  const std::size_t kinds = sources == 0 ? robot_kinds().size() : 0;
  reply.count(kinds);
  for (std::size_t i = 0; i < kinds; ++i) {
    reply.text("rubble://" + robot_kinds()[i]->name());
    reply.text("");
    reply.text("a bundled robot: docs/reference/robots.md");
    reply.number(std::uint8_t{0}), reply.count(0);  // no bounds
  }
}

Result SimulationServer::try_spawn(const SpawnRequest& asked, std::string& name) {
  if (world_.session().steps() > 0)
    return {kIncorrectState, "robots are spawned before the first step: reset first (scope 3 keeps those that were spawned)"};
  if (asked.uri.empty() && asked.resource_string.empty()) return {104, "no uri: get_spawnables lists bundled robots"};
  if (asked.uri.empty()) return {kUnsupported, "resource_string: give the uri of a file"};
  if (!asked.frame.empty() && asked.frame != ros::kWorld) return {109, "frame `" + asked.frame + "`: only `world`"};
  if (!asked.valid_pose) return {109, "no pose: expected finite numbers and a quaternion of length 1"};
  RobotItem item;
  try {
    if (asked.uri.rfind("rubble://", 0) == 0) {
      item = make_robot_item(asked.uri.substr(9), "uri");
    } else {
      item.urdf = asked.uri.rfind("file://", 0) == 0 ? asked.uri.substr(7) : asked.uri;
      const std::size_t dot = item.urdf.rfind('.');
      const std::string ending = dot == std::string::npos ? "" : item.urdf.substr(dot);
      if (ending != ".urdf" && ending != ".xacro") return {103, "`" + asked.uri + "`: expected rubble://KIND, or a .urdf or .xacro file"};
    }
  } catch (const InputError& error) {
    return {103, error.what()};
  }
  name = asked.name;
  if (name.empty() && asked.allow_renaming) name = item.urdf.empty() ? kind_of(item).name() : "robot";
  if (!is_name(name) || name.rfind("piece_", 0) == 0) return {102, "`" + name + "`: letters, digits and _, and not piece_"};
  if (world_.find(name) && !asked.allow_renaming) return {101, "there is an entity `" + name + "`"};
  const std::string stem = name;
  for (int i = 2; world_.find(name); ++i) name = stem + "_" + std::to_string(i);
  if (!asked.entity_namespace.empty() && asked.entity_namespace != name && asked.entity_namespace != "/" + name)
    return {105, "topics are under the robot's name: leave entity_namespace empty"};
  item.name = name;
  try {
    world_.spawn(item, asked.pose);
  } catch (const InputError& error) {
    return {item.urdf.empty() ? std::uint8_t{kFailed} : std::uint8_t{106}, error.what()};
  }
  begin();
  return {};
}

void SimulationServer::spawn(WireCursor& body, ros::Wire& reply) {
  std::string name;
  const Result result = try_spawn(read_spawn(body), name);
  put(reply, result);
  reply.text(result.code == kOk ? name : "");
}

void SimulationServer::remove(WireCursor& body, ros::Wire& reply) {
  const std::string name = body.text();
  body.end();
  const Entity* const entity = world_.find(name);
  if (!entity) return put(reply, Result{kNotFound, "no entity `" + name + "`"});
  if (!entity->robot) return put(reply, Result{kFailed, "pieces stay"});
  if (world_.session().names().size() == 1) return put(reply, Result{kFailed, "the last robot stays"});
  if (world_.session().steps() > 0) return put(reply, Result{kIncorrectState, "robots are deleted before the first step: reset first"});
  try {
    world_.remove(entity->number);
  } catch (const InputError& error) {
    return put(reply, Result{kFailed, error.what()});
  }
  begin();
  put(reply, Result());
}

}  // namespace rubble
