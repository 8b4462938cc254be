#include "io/live/ros1_robot.h"

#include <xmlrpcpp/XmlRpcException.h>

#include <chrono>
#include <exception>
#include <iterator>
#include <thread>

#include "io/live/complaints.h"
#include "io/live/master_watch.h"
#include "io/live/ros1_bytes.h"
#include "io/ros/ros_messages.h"
#include "kernel/base/error.h"

namespace rubble {
namespace {

// Messages that wait; older ones go, and who hears them sees the gap in their stamps.
constexpr std::uint32_t kClouds = 3, kPoses = 1000;
constexpr char kTwistMd5[] = "9f195f881246fdfa2798d1d3eebca84a";
constexpr char kTwistDefinition[] =
    "Vector3  linear\nVector3  angular\n\n"
    "================================================================================\n"
    "MSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n";
constexpr std::chrono::milliseconds kLastTwist{100};  // roscpp does not say when it has been sent

template <typename T>
void append(std::vector<T> more, std::vector<T>& all) {
  all.insert(all.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

}  // namespace

struct Ros1Robot::Impl {
  explicit Impl(const Ros1RobotOptions& options) : complaints(options.ros.notice) {
    constexpr auto kRos1 = ros::Version::ros1;
    hear(options.odometry, ros::kOdometry, kPoses,
         [this](const std::string& bytes) { heard.odometry.push_back(read_odometry(kRos1, bytes)); });
    for (const char* const topic : {"/tf", "/tf_static"})
      hear(topic, ros::kTfMessage, kPoses,
           [this](const std::string& bytes) { append(read_transforms(kRos1, bytes), heard.transforms); });
    hear(options.cloud, ros::kPointCloud, kClouds,
         [this](const std::string& bytes) { heard.clouds.push_back(read_point_cloud(kRos1, bytes)); });
    hear(options.scan, ros::kLaserScan, kClouds,
         [this](const std::string& bytes) { heard.clouds.push_back(read_laser_scan(kRos1, bytes)); });
    ::ros::AdvertiseOptions advertise(options.velocity, 1, kTwistMd5, "geometry_msgs/Twist", kTwistDefinition);
    advertise.has_header = false;
    velocity = node.advertise(advertise);
    topics.push_back({options.velocity, "geometry_msgs/Twist"});
    watch = std::make_unique<MasterWatch>(topics, options.ros.notice);
  }

  template <typename Read>
  void hear(const std::string& topic, const ros::MessageType& type, std::uint32_t size, Read read) {
    if (topic.empty()) return;
    const auto take = [this, topic, read](const std::string& bytes) {
      try {
        read(bytes);
      } catch (const std::exception& error) {
        complaints.note(topic, error.what());
      }
    };
    const std::string name = ros::type_name(type, ros::Version::ros1);
    subscribers.push_back(subscribe_to_bytes(node, queue, {topic, name, type.md5}, size, take));
    topics.push_back({topic, name, KnownTopic::heard});
  }

  Complaints complaints;
  ::ros::CallbackQueue queue;
  HeardRobot heard;
  std::vector<KnownTopic> topics;
  ::ros::NodeHandle node;
  std::vector<::ros::Subscriber> subscribers;  // these use the others
  ::ros::Publisher velocity;
  std::unique_ptr<MasterWatch> watch;
};

Ros1Robot::Ros1Robot(const Ros1RobotOptions& options) {
  try {
    impl_ = std::make_unique<Impl>(options);
  } catch (const XmlRpc::XmlRpcException& error) {
    throw RunError("the ROS master at " + ::ros::master::getURI() + " gives answers of no ROS master: " + error.getMessage());
  } catch (const ::ros::Exception& error) {
    throw RunError(std::string("roscpp refuses a topic: ") + error.what());
  }
}

Ros1Robot::~Ros1Robot() {
  drive(0, 0);
  std::this_thread::sleep_for(kLastTwist);
  impl_->watch.reset();
  try {
    impl_.reset();
    ::ros::shutdown();
  } catch (const XmlRpc::XmlRpcException&) {  // nobody is left to be told
  }
}

HeardRobot Ros1Robot::take(double seconds) {
  impl_->queue.callAvailable(::ros::WallDuration(seconds));
  HeardRobot heard = std::move(impl_->heard);
  impl_->heard = {};
  return heard;
}

void Ros1Robot::drive(double linear, double angular) {
  ros::Wire twist(ros::Version::ros1);
  for (const double value : {linear, 0.0, 0.0, 0.0, 0.0, angular}) twist.number(value);
  const std::string bytes = twist.take();
  impl_->velocity.publish(SerializedBytes{bytes});
}

bool Ros1Robot::is_driven() const { return impl_->velocity.getNumSubscribers() > 0; }

}  // namespace rubble
