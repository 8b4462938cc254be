#include "tests/app/served.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>

#include "app/pipeline/stages.h"

namespace rubble::testing {
namespace {

constexpr std::uint64_t kClient = 77;
constexpr std::int64_t kNumber = 5;

std::uint32_t number_of(std::vector<std::string>& names, const std::string& name) {
  names.push_back(name);
  return std::uint32_t(names.size() - 1);
}

std::vector<std::string> taken(std::map<std::string, std::vector<std::string>>& all, const std::string& name) {
  std::vector<std::string> list;
  list.swap(all[name]);
  return list;
}

RunOptions quiet() {
  RunOptions options;
  options.quiet = true;
  return options;
}

}  // namespace

std::uint32_t ServerInMemory::add(const std::string& topic, const ros::MessageType&, bool) {
  const std::lock_guard<std::mutex> lock(mutex_);
  return number_of(topics_, topic);
}

void ServerInMemory::write(std::uint32_t topic, std::int64_t, std::string_view message) {
  const std::lock_guard<std::mutex> lock(mutex_);
  messages_[topics_.at(topic)].emplace_back(message);
}

std::uint32_t ServerInMemory::listen(const std::string& topic, const std::string&, bool) {
  const std::lock_guard<std::mutex> lock(mutex_);
  return number_of(heard_, topic);
}

std::vector<std::string> ServerInMemory::take(std::uint32_t topic) {
  const std::lock_guard<std::mutex> lock(mutex_);
  return taken(sent_, heard_.at(topic));
}

std::uint32_t ServerInMemory::serve(const std::string& service, const std::string&) {
  return number_of(services_, service);
}

std::vector<std::string> ServerInMemory::take_requests(std::uint32_t service) {
  const std::lock_guard<std::mutex> lock(mutex_);
  return taken(requests_, services_.at(service));
}

void ServerInMemory::reply(std::uint32_t service, std::string_view bytes) {
  const std::lock_guard<std::mutex> lock(mutex_);
  replies_[services_.at(service)].emplace_back(bytes);
  replied_.notify_all();
}

void ServerInMemory::send(const std::string& topic, std::string message) {
  const std::lock_guard<std::mutex> lock(mutex_);
  sent_[topic].push_back(std::move(message));
}

void ServerInMemory::request(const std::string& service, std::string bytes) {
  const std::lock_guard<std::mutex> lock(mutex_);
  requests_[service].push_back(std::move(bytes));
}

std::string ServerInMemory::wait_for_reply(const std::string& service) {
  std::unique_lock<std::mutex> lock(mutex_);
  std::vector<std::string>& replies = replies_[service];
  if (!replied_.wait_for(lock, std::chrono::seconds(20), [&] { return !replies.empty(); })) return "";
  std::string first = std::move(replies.front());
  replies.erase(replies.begin());
  return first;
}

std::vector<std::string> ServerInMemory::take_messages(const std::string& topic) {
  const std::lock_guard<std::mutex> lock(mutex_);
  return taken(messages_, topic);
}

std::vector<std::string> ServerInMemory::topics() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return topics_;
}

Answer::Answer(std::string bytes)
    : bytes_(std::make_unique<std::string>(std::move(bytes))),
      cursor_(std::make_unique<WireCursor>("answer", ros::Version::ros2, *bytes_)) {
  EXPECT_EQ(cursor_->number<std::uint64_t>(), kClient);
  EXPECT_EQ(cursor_->number<std::int64_t>(), kNumber);
}

std::vector<std::string> Answer::texts() {
  std::vector<std::string> list;
  for (std::size_t i = cursor_->count(4); i > 0; --i) list.push_back(cursor_->text());
  return list;
}

std::string make_request(const ServedMission::Body& body) {
  ros::Wire wire(ros::Version::ros2);
  wire.number(kClient), wire.number(kNumber);
  body(wire);
  return wire.take();
}

ServedMission::ServedMission(const char* mission, bool paused) : context_(quiet()) {
  write_file(scratch_ / "m.lua", mission);
  RunRequest request;
  request.mission = scratch_ / "m.lua";
  ResolvedMission resolved = resolve_mission(request, RunKind::run, context_);
  PileState pile = settle_in_memory(resolved, context_, [] { return true; }).state;
  world_ = std::make_unique<ServedWorld>(std::move(resolved), std::move(pile), context_);
  server_ = std::make_unique<SimulationServer>(*world_, network_, paused, [this](const std::string& line) {
    const std::lock_guard<std::mutex> lock(mutex_);
    said_ += line + "\n";
  });
  thread_ = std::thread([this] { server_->run(0); });
}

ServedMission::~ServedMission() {
  network_.request("/set_simulation_state", make_request([](ros::Wire& w) { w.number(std::uint8_t{3}); }));
  thread_.join();
}

std::string ServedMission::said() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return said_;
}

std::string ServedMission::ask_bytes(const std::string& name, const std::string& request) {
  network_.request("/" + name, request);
  std::string bytes = network_.wait_for_reply("/" + name);
  if (bytes.empty()) throw RunError("no answer of " + name);
  return bytes;
}

Answer ServedMission::ask(const std::string& name, const Body& body) {
  Answer answer(ask_bytes(name, make_request(body)));
  if (name == "get_simulator_features" || name == "get_simulation_state") return answer;  // their results are not the first
  answer.result = answer.rest().number<std::uint8_t>();
  answer.message = answer.rest().text();
  return answer;
}

int ServedMission::step(std::uint64_t steps) {
  return ask("step_simulation", [&](ros::Wire& w) { w.number(steps); }).result;
}

Answer ServedMission::entities(const std::string& pattern, const std::vector<std::uint8_t>& categories,
                               const std::vector<std::string>& tags, const Body& bounds) {
  return ask("get_entities", [&](ros::Wire& w) {
    w.text(pattern);
    w.count(categories.size());
    for (const std::uint8_t category : categories) w.number(category);
    w.count(tags.size());
    for (const std::string& tag : tags) w.text(tag);
    w.number(std::uint8_t{0});  // any of the tags
    bounds(w);
  });
}

ServedMission::State ServedMission::state(const std::string& entity) {
  Answer answer = ask("get_entity_state", [&](ros::Wire& w) { w.text(entity); });
  State state;
  state.result = answer.result;
  state.stamp_ns = answer.rest().header().stamp_ns;
  state.pose = answer.rest().pose();
  state.linear = answer.rest().vector(), state.angular = answer.rest().vector();
  return state;
}

Answer ServedMission::set_state(const std::string& entity, const Vec3& place, const Quat& turned, bool pose) {
  return ask("set_entity_state", [&](ros::Wire& w) {
    w.text(entity);
    w.time(0), w.text("");
    for (const double value : {place.x, place.y, place.z, turned.x, turned.y, turned.z, turned.w}) w.number(value);
    for (int i = 0; i < 12; ++i) w.number(0.0);  // at rest
    w.boolean(pose), w.boolean(true), w.boolean(false);
  });
}

Answer ServedMission::spawn(const std::string& name, const std::string& uri, const Vec3& place, bool renaming) {
  return ask("spawn_entity", [&](ros::Wire& w) {
    w.text(name), w.boolean(renaming), w.text(uri), w.text(""), w.text("");
    w.time(0), w.text("world");
    for (const double value : {place.x, place.y, place.z, 0.0, 0.0, 0.0, 1.0}) w.number(value);
  });
}

}  // namespace rubble::testing
