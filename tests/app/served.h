// A mission served in this process to clients that a network would bring: what they ask and send, and what they hear.
#pragma once

#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "app/serve/simulation_server.h"
#include "app/support/run_request.h"
#include "io/live/live_ros.h"
#include "tests/app/program.h"

namespace rubble::testing {

// Messages by topic and requests by service instead of a network.
class ServerInMemory : public LiveServer {
 public:
  ros::Version version() const override { return ros::Version::ros2; }
  std::uint32_t add(const std::string& topic, const ros::MessageType& type, bool latched) override;
  void write(std::uint32_t topic, std::int64_t stamp_ns, std::string_view message) override;
  void finish() override {}
  std::uint32_t listen(const std::string& topic, const std::string& type, bool reliable) override;
  std::vector<std::string> take(std::uint32_t topic) override;
  std::uint32_t serve(const std::string& service, const std::string& type) override;
  std::vector<std::string> take_requests(std::uint32_t service) override;
  void reply(std::uint32_t service, std::string_view bytes) override;

  // Of the test's thread.
  void send(const std::string& topic, std::string message);
  void request(const std::string& service, std::string bytes);
  std::string wait_for_reply(const std::string& service);  // empty: none within 20 s
  std::vector<std::string> take_messages(const std::string& topic);
  std::vector<std::string> topics();
  std::vector<std::string> services() const { return services_; }

 private:
  std::mutex mutex_;
  std::condition_variable replied_;
  std::vector<std::string> topics_, heard_, services_;  // by number
  std::map<std::string, std::vector<std::string>> messages_, sent_, requests_, replies_;
};

// An answer, read field by field from behind the result.
class Answer {
 public:
  explicit Answer(std::string bytes);
  WireCursor& rest() { return *cursor_; }
  std::vector<std::string> texts();

  int result = -1;  // of simulation_interfaces/Result
  std::string message;

 private:
  std::unique_ptr<std::string> bytes_;
  std::unique_ptr<WireCursor> cursor_;
};

class ServedMission {
 public:
  explicit ServedMission(const char* mission, bool paused = true);
  ~ServedMission();

  using Body = std::function<void(ros::Wire&)>;
  // Of the service `name`; result_first: whether it answers with a result first.
  Answer ask(const std::string& name, const Body& body = [](ros::Wire&) {});
  std::string ask_bytes(const std::string& name, const std::string& request);
  int step(std::uint64_t steps);
  Answer entities(const std::string& pattern = "", const std::vector<std::uint8_t>& categories = {},
                  const std::vector<std::string>& tags = {}, const Body& bounds = [](ros::Wire& w) { w.number(std::uint8_t{0}), w.count(0); });
  struct State {
    int result = -1;
    std::int64_t stamp_ns = 0;
    Pose pose;
    Vec3 linear, angular;
  };
  State state(const std::string& entity);
  Answer set_state(const std::string& entity, const Vec3& place, const Quat& turned = {}, bool pose = true);
  Answer spawn(const std::string& name, const std::string& uri, const Vec3& place, bool renaming = false);

  ServerInMemory& network() { return network_; }
  std::string said();

 private:
  ScratchFolder scratch_;
  RunContext context_;
  ServerInMemory network_;
  std::mutex mutex_;
  std::string said_;
  std::unique_ptr<ServedWorld> world_;
  std::unique_ptr<SimulationServer> server_;
  std::thread thread_;
};

// A request with the numbers of its client.
std::string make_request(const ServedMission::Body& body);

}  // namespace rubble::testing
