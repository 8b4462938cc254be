#include <ros/ros.h>
#include <xmlrpcpp/XmlRpcException.h>

#include <cstdlib>
#include <memory>
#include <thread>
#include <vector>

#include "io/live/live_ros.h"
#include "io/live/master_watch.h"
#include "io/live/pace.h"
#include "io/live/ros1_bytes.h"
#include "io/live/ros1_commands.h"
#include "kernel/base/error.h"

namespace rubble {
namespace {

// Messages held for a slow subscriber before the oldest goes; pictures are what memory is for.
constexpr std::uint32_t kPictureQueue = 30, kQueue = 1000;
// roscpp does not say when all has been sent: after the last message it gets so long to do it.
constexpr std::chrono::milliseconds kLinger{1000};

std::string from_environment(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

std::string master_of(const Ros1Options& options) {
  if (!options.master.empty()) return options.master;
  const std::string environment = from_environment("ROS_MASTER_URI");
  return environment.empty() ? "http://localhost:11311" : environment;
}

// roscpp ends the program over a URI that it cannot read.
void check_uri(const std::string& uri, const char* source) {
  const std::string scheme = "http://";
  const std::size_t colon = uri.rfind(':');
  const bool has_host = uri.compare(0, scheme.size(), scheme) == 0 && colon > scheme.size();
  std::string port = has_host ? uri.substr(colon + 1) : "";
  if (!port.empty() && port.back() == '/') port.pop_back();
  const bool digits = !port.empty() && port.size() <= 5 &&
                      port.find_first_not_of("0123456789") == std::string::npos;
  if (!digits || std::stoi(port) < 1 || std::stoi(port) > 65535)
    throw InputError({"", 0, source, "not the address of a ROS master", "http://HOST:PORT", uri,
                      "usually http://localhost:11311"});
}

// The environment, because roscpp listens on the loopback interface alone only when told by it.
void choose_address(const std::string& address) {
  if (!address.empty()) {
    unsetenv("ROS_HOSTNAME");
    setenv("ROS_IP", address.c_str(), 1);
  } else if (from_environment("ROS_HOSTNAME").empty() && from_environment("ROS_IP").empty()) {
    setenv("ROS_IP", "127.0.0.1", 1);
  }
}

// roscpp throws what is no std::exception over an answer of another type than it expects.
template <typename Call>
void ask_master(Call call) {
  try {
    call();
  } catch (const XmlRpc::XmlRpcException& error) {
    throw RunError("the ROS master at " + ::ros::master::getURI() +
                   " gives answers of no ROS master: " + error.getMessage());
  }
}

class Ros1Stream : public DriveStream {
 public:
  Ros1Stream(const Ros1Options& options, bool hears) : options_(options), pace_(options) {
    ::ros::master::setRetryTimeout(::ros::WallDuration(5));
    ask_master([&] { connect(hears); });
  }
  ~Ros1Stream() override { close(); }

  ros::Version version() const override { return ros::Version::ros1; }

  std::uint32_t add(const std::string& topic, const ros::MessageType& type, bool latched) override {
    const bool picture = &type == &ros::kImage || &type == &ros::kCompressedImage;
    ::ros::AdvertiseOptions advertise(topic, picture ? kPictureQueue : kQueue, type.md5,
                                      ros::type_name(type, version()), type.definition1);
    advertise.latch = latched;
    advertise.has_header = false;  // or roscpp would write its own sequence numbers
    ask_master([&] { publishers_.push_back(node_->advertise(advertise)); });
    if (!publishers_.back())
      throw RunError("the ROS master at " + ::ros::master::getURI() + " did not take " + topic);
    topics_.push_back({publishers_.back().getTopic(), advertise.datatype});
    return std::uint32_t(publishers_.size() - 1);
  }

  void write(std::uint32_t topic, std::int64_t stamp_ns, std::string_view message) override {
    if (!watch_) start();
    pace_.wait_until(stamp_ns);
    publishers_[topic].publish(SerializedBytes{message});
  }

  DriveCommands take() override { return commands_ ? commands_->take() : DriveCommands{}; }

  void finish() override {
    if (any_subscriber()) std::this_thread::sleep_for(kLinger);
    close();
  }

 private:
  void connect(bool hears) {
    node_ = std::make_unique<::ros::NodeHandle>();
    if (!hears) return;
    commands_ = std::make_unique<Ros1Commands>(*node_, options_.notice);
    topics_ = commands_->topics();
  }

  void start() {
    watch_ = std::make_unique<MasterWatch>(topics_, options_.notice);
    pace_.wait_for([this] { return all_have_subscribers(); });
  }

  bool any_subscriber() const {
    for (const ::ros::Publisher& each : publishers_)
      if (each.getNumSubscribers() > 0) return true;
    return false;
  }
  bool all_have_subscribers() const {
    for (const ::ros::Publisher& each : publishers_)
      if (each.getNumSubscribers() == 0) return false;
    return true;
  }

  void close() {
    watch_.reset();
    try {
      commands_.reset();
      publishers_.clear();
      node_.reset();
      ::ros::shutdown();
    } catch (const XmlRpc::XmlRpcException&) {  // nobody is left to be told
    }
  }

  Ros1Options options_;
  Pace pace_;
  std::unique_ptr<::ros::NodeHandle> node_;
  std::vector<::ros::Publisher> publishers_;
  std::unique_ptr<Ros1Commands> commands_;  // of a stream that hears
  std::vector<KnownTopic> topics_;
  std::unique_ptr<MasterWatch> watch_;  // from the first message on
};

}  // namespace

std::string describe_ros1() { return "roscpp " RUBBLE_ROSCPP_VERSION; }

void check_ros1(const Ros1Options& options) {
  const std::string uri = master_of(options);
  check_uri(uri, options.master.empty() ? "ROS_MASTER_URI" : "--ros-master");
  choose_address(options.address);
  // With a log file named, even one that is none, roscpp makes no folder in the user's home.
  ::ros::init(::ros::M_string{{"__master", uri}, {"__log", "/dev/null"}}, options.node,
              ::ros::init_options::NoSigintHandler | ::ros::init_options::AnonymousName |
                  ::ros::init_options::NoRosout);
  bool answers = false;
  ask_master([&] { answers = ::ros::master::check(); });
  if (!answers)
    throw RunError("no ROS master answers at " + uri +
                   "\nstart one in another terminal: `roscore` (Debian: python3-roslaunch, "
                   "python3-rosmaster, rosout), or name another: --ros-master http://HOST:PORT");
}

std::unique_ptr<RosFile> make_ros1_stream(const Ros1Options& options) {
  return std::make_unique<Ros1Stream>(options, false);
}

std::unique_ptr<DriveStream> make_ros1_drive(const Ros1Options& options) {
  return std::make_unique<Ros1Stream>(options, true);
}

}  // namespace rubble
