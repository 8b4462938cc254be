// Services and commands over DDS: between participants of this process, and of the program.
#include <gtest/gtest.h>
#include <unistd.h>

#include <string>
#include <string_view>
#include <vector>

#include "io/live/dds_bytes.h"
#include "io/live/live_ros.h"
#include "io/live/simulation_services.h"
#include "kernel/base/error.h"
#include "tests/app/program.h"
#include "tests/live/background.h"

namespace rubble {
namespace dds_server_test {

constexpr double kPatience = 20;  // unit: s

// A reader and a writer of a client, in the domain that the server made.
struct Client {
  explicit Client(int domain) : participant(dds_create_participant(dds_domainid_t(domain), nullptr, nullptr)) {}
  ~Client() { dds_delete(participant); }
  dds_entity_t reader(const std::string& topic, const std::string& type) const { return make(topic, type, false); }
  dds_entity_t writer(const std::string& topic, const std::string& type) const { return make(topic, type, true); }

  dds_entity_t participant;

 private:
  dds_entity_t make(const std::string& topic, const std::string& type, bool writes) const {
    dds_qos_t* const qos = dds_create_qos();
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 100);
    dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_MSECS(100));
    const dds_entity_t of = create_bytes_topic(participant, topic, type);
    const dds_entity_t made = writes ? dds_create_writer(participant, of, qos, nullptr) : dds_create_reader(participant, of, qos, nullptr);
    dds_delete_qos(qos);
    EXPECT_GT(made, 0) << topic;
    return made;
  }
};

bool is_read(dds_entity_t writer) {
  dds_publication_matched_status_t status;
  return dds_get_publication_matched_status(writer, &status) == 0 && status.current_count > 0;
}

bool is_written(dds_entity_t reader) {
  dds_subscription_matched_status_t status;
  return dds_get_subscription_matched_status(reader, &status) == 0 && status.current_count > 0;
}

Ros2Options options() {
  Ros2Options options;
  options.domain = 1 + getpid() % 100;  // their ports are free on Linux
  options.interface = "lo";
  options.rate = 0;
  return options;
}

const std::string kBytes("\0\1\0\0whatever", 12);

TEST(DdsServer, RequestsComeAndRepliesGoByTheNamesOfRos2) {
  const Ros2Options of = options();
  const auto server = make_ros2_server(of);
  const std::uint32_t service = server->serve("/step_simulation", "simulation_interfaces/srv/StepSimulation");
  const Client client(of.domain);
  const dds_entity_t ask = client.writer("rq/step_simulationRequest", "simulation_interfaces::srv::dds_::StepSimulation_Request_");
  const dds_entity_t hear = client.reader("rr/step_simulationReply", "simulation_interfaces::srv::dds_::StepSimulation_Response_");
  ASSERT_TRUE(testing::eventually(kPatience, [&] { return is_read(ask) && is_written(hear); }));
  EXPECT_TRUE(server->take_requests(service).empty());
  const std::string_view request = kBytes;
  ASSERT_EQ(dds_write(ask, &request), 0);
  std::vector<std::string> requests;
  ASSERT_TRUE(testing::eventually(kPatience, [&] { return !(requests = server->take_requests(service)).empty(); }));
  EXPECT_EQ(requests, std::vector<std::string>{kBytes});
  server->reply(service, kBytes);
  std::vector<std::string> replies;
  ASSERT_TRUE(testing::eventually(kPatience, [&] { return !(replies = take_bytes(hear, 10)).empty(); }));
  EXPECT_EQ(replies, std::vector<std::string>{kBytes});
}

TEST(DdsServer, CommandsComeAndMessagesGo) {
  const Ros2Options of = options();
  const auto server = make_ros2_server(of);
  const std::uint32_t heard = server->listen("/tank/cmd_vel", "geometry_msgs/msg/Twist", false);
  const std::uint32_t clock = server->add("/clock", ros::kClock, false);
  const Client client(of.domain);
  const dds_entity_t drive = client.writer("rt/tank/cmd_vel", "geometry_msgs::msg::dds_::Twist_");
  const dds_entity_t hear = client.reader("rt/clock", "rosgraph_msgs::msg::dds_::Clock_");
  ASSERT_TRUE(testing::eventually(kPatience, [&] { return is_read(drive) && is_written(hear); }));
  const std::string_view twist = kBytes;
  ASSERT_EQ(dds_write(drive, &twist), 0);
  std::vector<std::string> twists;
  ASSERT_TRUE(testing::eventually(kPatience, [&] { return !(twists = server->take(heard)).empty(); }));
  EXPECT_EQ(twists, std::vector<std::string>{kBytes});
  const std::string message = ros::clock(ros::Version::ros2, 5'000'000'000);
  server->write(clock, 5'000'000'000, message);
  std::vector<std::string> clocks;
  ASSERT_TRUE(testing::eventually(kPatience, [&] { return !(clocks = take_bytes(hear, 10)).empty(); }));
  EXPECT_EQ(clocks, std::vector<std::string>{message});
  server->finish();
}

TEST(DdsServer, AnInterfaceThatIsNotThereIsAnError) {
  Ros2Options of = options();
  of.interface = "none57";
  EXPECT_THROW(make_ros2_server(of), RunError);
}

// In a process of its own, over the loopback interface.
TEST(DdsServer, TheProgramAnswersAndQuits) {
  const testing::ScratchFolder scratch;
  testing::write_file(scratch / "m.lua", "return rubble.mission { pile = { layers = 0 },\n"
                                         "  robots = { { name = 'rover', model = 'rover', position = { 0, 0, 0.001 } } } }\n");
  const Ros2Options of = options();
  const auto node = make_ros2_stream(of);  // and the domain, as it must be on loopback
  testing::Background program("exec env -u CYCLONEDDS_URI '" RUBBLE_PROGRAM "' serve '" + (scratch / "m.lua") + "' --paused --quiet --ros-domain " +
                              std::to_string(of.domain), scratch / "said.txt");
  const Client client(of.domain);
  const auto ask = [&](const std::string& service, const std::string& type, const auto& body) {
    const std::string dds = "simulation_interfaces::srv::dds_::" + type;
    const dds_entity_t writer = client.writer("rq/" + service + "Request", dds + "_Request_");
    const dds_entity_t reader = client.reader("rr/" + service + "Reply", dds + "_Response_");
    EXPECT_TRUE(testing::eventually(kPatience, [&] { return is_read(writer) && is_written(reader); })) << testing::read_file(scratch / "said.txt");
    ros::Wire request(ros::Version::ros2);
    request.number(std::uint64_t{7}), request.number(std::int64_t{1});
    body(request);
    const std::string bytes = request.take();
    const std::string_view view = bytes;
    EXPECT_EQ(dds_write(writer, &view), 0);
    std::vector<std::string> replies;
    EXPECT_TRUE(testing::eventually(kPatience, [&] { return !(replies = take_bytes(reader, 10)).empty(); })) << service;
    return replies.empty() ? std::string(24, '\0') : replies.front();
  };
  const std::string state = ask("get_simulation_state", "GetSimulationState", [](ros::Wire&) {});
  EXPECT_EQ(state[20], 2) << "paused, behind the header and the numbers of the request";
  EXPECT_EQ(ask("step_simulation", "StepSimulation", [](ros::Wire& w) { w.number(std::uint64_t{3}); })[20], 1) << "done";
  EXPECT_EQ(ask("step_simulation", "StepSimulation", [](ros::Wire&) {})[20], 4) << "of how many steps it does not say";
  EXPECT_EQ(ask("set_simulation_state", "SetSimulationState", [](ros::Wire& w) { w.number(std::uint8_t{3}); })[20], 1);
  EXPECT_EQ(program.wait(kPatience), 0) << testing::read_file(scratch / "said.txt");
}

}  // namespace dds_server_test
}  // namespace rubble
