// fastdds_driver DOMAIN [robot]: drives a camera by /cmd_vel and /joy as drive_by_topics.py does, over ROS 2's
// topics, with Fast DDS and messages that Fast CDR writes; a robot by /joint_trajectory, too; then ends the drive.
// fastdds_driver DOMAIN flood: as fast as it can for 3 s, commands that are not finite, huge, cut off or
// no messages at all; then one of 0.125 m/s, again and again, for 20 s.
#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <thread>
#include <vector>

#include "tests/live/fastdds_bytes.h"

namespace rubble::testing {
namespace {

template <typename Write>
std::string cdr(Write write) {
  char room[1000];
  eprosima::fastcdr::FastBuffer buffer(room, sizeof room);
  eprosima::fastcdr::Cdr out(buffer, eprosima::fastcdr::Cdr::LITTLE_ENDIANNESS,
                             eprosima::fastcdr::Cdr::DDS_CDR);
  out.serialize_encapsulation();
  write(out);
  return std::string(room, out.getSerializedDataLength());
}

std::string twist(double forward, double up, double left_turn) {
  return cdr([&](eprosima::fastcdr::Cdr& out) {
    for (const double value : {forward, 0.0, up, 0.0, 0.0, left_turn}) out << value;
  });
}

std::string joy(const std::vector<float>& axes, const std::vector<std::int32_t>& buttons) {
  return cdr([&](eprosima::fastcdr::Cdr& out) {
    out << std::int32_t(1) << std::uint32_t(2) << std::string("joy");
    out << axes << buttons;
  });
}

// One joint, to that position.
std::string trajectory(const std::string& joint, double position) {
  return cdr([&](eprosima::fastcdr::Cdr& out) {
    out << std::int32_t(1) << std::uint32_t(2) << std::string("base_link");
    out << std::vector<std::string>{joint} << std::uint32_t(1);
    const std::vector<double> none;
    out << std::vector<double>{position} << std::vector<double>{0.0} << none << none;
    out << std::int32_t(0) << std::uint32_t(500000000);
  });
}

class Driver {
 public:
  explicit Driver(unsigned domain) : participant_(join(domain, false)) {
    fast::Publisher* const publisher = participant_->create_publisher(fast::PUBLISHER_QOS_DEFAULT);
    fast::DataWriterQos qos;
    qos.endpoint().history_memory_policy =
        eprosima::fastrtps::rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
    velocity_ = publisher->create_datawriter(
        make_topic(participant_, "/cmd_vel", "geometry_msgs::msg::dds_::Twist_"), qos);
    stick_ = publisher->create_datawriter(
        make_topic(participant_, "/joy", "sensor_msgs::msg::dds_::Joy_"), qos);
    joints_ = publisher->create_datawriter(
        make_topic(participant_, "/joint_trajectory", "trajectory_msgs::msg::dds_::JointTrajectory_"), qos);
    fast::DataReaderQos reading;
    reading.endpoint().history_memory_policy = qos.endpoint().history_memory_policy;
    fast::Subscriber* const subscriber =
        participant_->create_subscriber(fast::SUBSCRIBER_QOS_DEFAULT);
    frames_ = subscriber->create_datareader(
        make_topic(participant_, "/ground_truth/pose", "geometry_msgs::msg::dds_::PoseStamped_"),
        reading);
  }
  ~Driver() { leave(participant_); }

  int readers() const {
    fast::PublicationMatchedStatus a, b, c;
    velocity_->get_publication_matched_status(a);
    stick_->get_publication_matched_status(b);
    joints_->get_publication_matched_status(c);
    return a.current_count + b.current_count + c.current_count;
  }
  void say_velocity(std::string bytes) { velocity_->write(&bytes); }
  void say_stick(std::string bytes) { stick_->write(&bytes); }
  void say_joints(std::string bytes) { joints_->write(&bytes); }

  // Until so many frames more have come, saying it all the while; false: none come any longer.
  template <typename Say>
  bool steps(int count, Say say) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (count > 0 && std::chrono::steady_clock::now() < end) {
      std::string bytes;
      fast::SampleInfo info;
      while (frames_->take_next_sample(&bytes, &info) == ReturnCode_t::RETCODE_OK)
        count -= info.valid_data;
      say();
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return count <= 0;
  }

 private:
  fast::DomainParticipant* participant_;
  fast::DataWriter *velocity_ = nullptr, *stick_ = nullptr, *joints_ = nullptr;
  fast::DataReader* frames_ = nullptr;
};

bool wait_for_readers(const Driver& driver, int count) {
  for (int i = 0; i < 3000 && driver.readers() != count; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  std::printf("%d readers\n", driver.readers());
  return driver.readers() == count;
}

// The same steps as in drive_by_topics.py, which check_drive.py looks for.
bool drive(Driver& driver, bool robot) {
  const std::vector<float> still(8, 0.0f);
  std::vector<float> forward = still;
  forward[1] = 1;
  std::vector<std::int32_t> none(11, 0), lamp = none, quit = none;
  lamp[0] = 1, quit[6] = 1;
  bool well = wait_for_readers(driver, 3) && driver.steps(5, [] {});
  well = well && driver.steps(15, [&] { driver.say_velocity(twist(0.5, 0.25, 0.4)); });
  well = well && driver.steps(15, [] {});
  if (robot) {
    driver.say_joints(trajectory("tail", 1));
    driver.say_joints(trajectory("front_left_flipper_joint", std::nan("")));
    driver.say_joints(trajectory("front_left_flipper_joint", 0.25));
    well = well && driver.steps(12, [] {});
  }
  driver.say_stick(joy(still, lamp));
  well = well && driver.steps(10, [&] { driver.say_stick(joy(forward, none)); });
  well = well && driver.steps(3, [&] { driver.say_velocity(twist(std::nan(""), 0, 0)); });
  driver.say_stick(joy(still, quit));
  return wait_for_readers(driver, 0) && well;
}

bool flood(Driver& driver) {
  using Clock = std::chrono::steady_clock;
  if (!wait_for_readers(driver, 3)) return false;
  const std::string whole = joy({0.5f, -0.5f}, {1, 0, 1});
  std::size_t said = 0;
  for (const auto end = Clock::now() + std::chrono::seconds(3); Clock::now() < end; ++said) {
    const double value = (said % 3 == 0) ? std::nan("") : (said % 3 == 1) ? 1.5e308 : HUGE_VAL;
    driver.say_velocity(twist(value, 0, value));
    driver.say_velocity(std::string(4 + said % 7, '\xff'));
    driver.say_joints(std::string(4 + said % 90, '\x03'));
    driver.say_stick(said % 2 ? whole.substr(0, 4 + said % (whole.size() - 4)) : std::string(60000, '\x7f'));
  }
  std::printf("%zu times\n", said);
  for (const auto end = Clock::now() + std::chrono::seconds(20);
       Clock::now() < end && driver.readers() > 0;) {
    driver.say_velocity(twist(0.125, 0, 0));
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return said > 100;
}

}  // namespace
}  // namespace rubble::testing

int main(int count, char** argv) {
  rubble::testing::Driver driver(unsigned(std::atoi(argv[1])));
  const std::string what = count > 2 ? argv[2] : "";
  if (what == "flood") return rubble::testing::flood(driver) ? 0 : 1;
  return rubble::testing::drive(driver, what == "robot") ? 0 : 1;
}
