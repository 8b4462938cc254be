#include <dds/dds.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <mutex>
#include <vector>

#include "io/live/complaints.h"
#include "io/live/dds_bytes.h"
#include "io/live/live_ros.h"
#include "io/live/pace.h"
#include "kernel/base/error.h"

namespace rubble {
namespace {

// How many pictures or other messages of a topic are kept for readers that have not confirmed them;
// then the oldest goes.
constexpr std::int32_t kPictureDepth = 30, kDepth = 1000;
// How long a write would wait for them if more than kMostHeld were kept, which is never.
constexpr dds_duration_t kPatience = DDS_MSECS(100);
constexpr char kMostHeld[] = "1 GiB";
constexpr std::int32_t kHeard = 100;  // commands; older ones go when steps are slower
constexpr dds_duration_t kLinger = DDS_SECS(2);  // for what readers have not confirmed at the end
constexpr dds_duration_t kIntroduction = DDS_SECS(2);  // that a request waits until the reader of its reply is known
constexpr std::size_t kMostClients = 100;              // of a service, among which that reader is looked for

// Cyclone binds its sockets to all addresses, but announces and sends on this interface alone. Linux
// calls the loopback interface unfit for multicast, and many participants believe it: those are looked
// for one by one, twice a second. The others are heard by multicast.
std::string configuration(const std::string& interface) {
  const char* environment = std::getenv("CYCLONEDDS_URI");
  if (interface.empty() && environment && *environment) return environment;
  const bool loopback = interface.empty() || interface == "lo";
  const std::string name = loopback ? "lo" : interface;
  std::string general = "<Interfaces><NetworkInterface name=\"" + name + "\"" +
                        (loopback ? " multicast=\"true\"" : "") + "/></Interfaces>";
  std::string discovery;
  if (loopback) {
    general += "<AllowMulticast>spdp</AllowMulticast>";
    discovery =
        "<Discovery><ParticipantIndex>auto</ParticipantIndex>"
        "<MaxAutoParticipantIndex>32</MaxAutoParticipantIndex>"
        "<Peers><Peer address=\"127.0.0.1\"/></Peers>"
        "<SPDPInterval>500 ms</SPDPInterval></Discovery>";
  }
  return "<CycloneDDS><Domain Id=\"any\"><General>" + general + "</General>" + discovery +
         "<Internal><WriterLingerDuration>0 s</WriterLingerDuration><Watermarks><WhcAdaptive>false</WhcAdaptive><WhcHigh>" + kMostHeld +
         "</WhcHigh><WhcHighInit>" + kMostHeld + "</WhcHighInit></Watermarks></Internal>"
         "<Tracing><Verbosity>none</Verbosity></Tracing></Domain></CycloneDDS>";
}

void check(dds_return_t code, const std::string& what) {
  if (code < 0) throw RunError("DDS: " + what + ": " + dds_strretcode(code));
}

// What Cyclone has to say, each of its functions for itself: a peer can make it say something of every
// packet. Called by threads of its own.
class DdsLog {
 public:
  explicit DdsLog(const std::function<void(const std::string&)>& notice) : complaints_(notice) {
    dds_set_log_sink(note, this);
  }
  ~DdsLog() { dds_set_log_sink(nullptr, nullptr); }
  DdsLog(const DdsLog&) = delete;
  DdsLog& operator=(const DdsLog&) = delete;

 private:
  static void note(void* log, const dds_log_data_t* data) {
    auto& self = *static_cast<DdsLog*>(log);
    const std::lock_guard<std::mutex> lock(self.mutex_);
    std::string line(data->message, data->size);
    while (!line.empty() && line.back() == '\n') line.pop_back();
    self.complaints_.note(std::string("DDS: ") + data->function, line);
  }

  Complaints complaints_;
  std::mutex mutex_;
};

// "geometry_msgs/msg/Twist" is geometry_msgs::msg::dds_::Twist_ to DDS; suffix: of a service's two messages.
std::string dds_type(const std::string& type, const std::string& suffix = "") {
  const std::size_t a = type.find('/'), b = type.rfind('/');
  return type.substr(0, a) + "::" + type.substr(a + 1, b - a - 1) + "::dds_::" + type.substr(b + 1) + suffix + "_";
}

using Qos = std::unique_ptr<dds_qos_t, void (*)(dds_qos_t*)>;

Qos make_qos(std::int32_t depth, dds_reliability_kind_t reliability) {
  Qos qos(dds_create_qos(), dds_delete_qos);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, depth);
  dds_qset_reliability(qos.get(), reliability, kPatience);
  return qos;
}

// Base: RosFile, or what does more than publish.
template <typename Base>
class Ros2Stream : public Base {
 public:
  explicit Ros2Stream(const Ros2Options& options) : complaints_(options.notice), pace_(options), log_(options.notice) {
    const auto number = dds_domainid_t(options.domain);
    domain_ = dds_create_domain(number, configuration(options.interface).c_str());
    check(domain_, "domain " + std::to_string(options.domain));
    participant_ = dds_create_participant(number, nullptr, nullptr);
    if (participant_ < 0) dds_delete(domain_);
    check(participant_, "no participant on " +
                            (options.interface.empty() ? "lo, or as $CYCLONEDDS_URI says"
                                                       : "interface " + options.interface));
  }
  ~Ros2Stream() override { close(); }

  ros::Version version() const override { return ros::Version::ros2; }

  std::uint32_t add(const std::string& topic, const ros::MessageType& type, bool latched) override {
    const bool picture = &type == &ros::kImage || &type == &ros::kCompressedImage;
    const std::int32_t depth = latched ? 1 : picture ? kPictureDepth : kDepth;
    const Qos qos = make_qos(depth, DDS_RELIABILITY_RELIABLE);
    dds_qset_writer_data_lifecycle(qos.get(), false);  // the end of a run takes nothing back
    dds_qset_durability(qos.get(), latched ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
    if (latched)
      dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_LAST, depth, DDS_LENGTH_UNLIMITED,
                                  DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
    writers_.push_back(make_writer("rt" + topic, dds_type(ros::type_name(type, ros::Version::ros2)), qos));
    return std::uint32_t(writers_.size() - 1);
  }

  void write(std::uint32_t topic, std::int64_t stamp_ns, std::string_view message) override {
    if (!started_) pace_.wait_for([this] { return all_have_readers(); });
    started_ = true;
    pace_.wait_until(stamp_ns);
    send(writers_[topic], message);
  }

  void finish() override {
    const dds_time_t end = dds_time() + kLinger;
    for (const dds_entity_t writer : all_writers_)
      if (dds_time() < end) dds_wait_for_acks(writer, end - dds_time());
    close();
  }

 protected:
  dds_entity_t make_reader(const std::string& topic, const std::string& type, dds_reliability_kind_t reliability) {
    const Qos qos = make_qos(kHeard, reliability);
    const dds_entity_t reader = dds_create_reader(participant_, make_topic(topic, type), qos.get(), nullptr);
    check(reader, "reader of " + topic);
    return reader;
  }
  dds_entity_t make_writer(const std::string& topic, const std::string& type, const Qos& qos) {
    const dds_entity_t writer = dds_create_writer(participant_, make_topic(topic, type), qos.get(), nullptr);
    check(writer, "writer of " + topic);
    all_writers_.push_back(writer);
    return writer;
  }
  void send(dds_entity_t writer, std::string_view message) {
    const dds_return_t code = dds_write(writer, &message);
    if (code != DDS_RETCODE_TIMEOUT) check(code, "write");
  }

  Complaints complaints_;

 private:
  dds_entity_t make_topic(const std::string& topic, const std::string& type) {
    const dds_entity_t entity = create_bytes_topic(participant_, topic, type);
    check(entity, "topic " + topic);
    return entity;
  }

  bool all_have_readers() const {
    for (const dds_entity_t writer : writers_) {
      dds_publication_matched_status_t status;
      if (dds_get_publication_matched_status(writer, &status) < 0 || status.current_count == 0)
        return false;
    }
    return true;
  }

  void close() {
    if (domain_ > 0) dds_delete(domain_);  // and all that is in it
    domain_ = 0;
  }

  Pace pace_;
  DdsLog log_;
  dds_entity_t domain_ = 0, participant_ = 0;
  std::vector<dds_entity_t> writers_;      // of topics
  std::vector<dds_entity_t> all_writers_;  // of services, too
  bool started_ = false;
};

class Ros2Drive : public Ros2Stream<DriveStream> {
 public:
  explicit Ros2Drive(const Ros2Options& options) : Ros2Stream(options) {
    // Best effort readers hear reliable writers, too; but of buttons none may be lost.
    twist_ = make_reader("rt/cmd_vel", dds_type("geometry_msgs/msg/Twist"), DDS_RELIABILITY_BEST_EFFORT);
    joy_ = make_reader("rt/joy", dds_type("sensor_msgs/msg/Joy"), DDS_RELIABILITY_RELIABLE);
    trajectory_ = make_reader("rt/joint_trajectory", dds_type("trajectory_msgs/msg/JointTrajectory"), DDS_RELIABILITY_RELIABLE);
  }

  DriveCommands take() override {
    DriveCommands commands;
    for (const std::string& bytes : take_bytes(twist_, kHeard)) hear("/cmd_vel", [&] {
        commands.twists.push_back(read_twist(version(), bytes));
      });
    for (const std::string& bytes : take_bytes(joy_, kHeard)) hear("/joy", [&] {
        commands.joys.push_back(read_joy(version(), bytes));
      });
    for (const std::string& bytes : take_bytes(trajectory_, kHeard)) hear("/joint_trajectory", [&] {
        commands.trajectories.push_back(read_joint_trajectory(version(), bytes));
      });
    dds_subscription_matched_status_t status;
    commands.joy_connected =
        dds_get_subscription_matched_status(joy_, &status) == 0 && status.current_count > 0;
    return commands;
  }

 private:
  // One that is no such message is said and left out: others go on driving.
  template <typename Read>
  void hear(const char* topic, Read read) {
    try {
      read();
    } catch (const RunError& error) {
      complaints_.note(topic, error.what());
    }
  }

  dds_entity_t twist_ = 0, joy_ = 0, trajectory_ = 0;
};

class Ros2Server : public Ros2Stream<LiveServer> {
 public:
  using Ros2Stream::Ros2Stream;

  std::uint32_t listen(const std::string& topic, const std::string& type, bool reliable) override {
    heard_.push_back(make_reader("rt" + topic, dds_type(type), reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT));
    return std::uint32_t(heard_.size() - 1);
  }
  std::vector<std::string> take(std::uint32_t topic) override { return take_bytes(heard_[topic], kHeard); }

  std::uint32_t serve(const std::string& service, const std::string& type) override {
    const Qos qos = make_qos(kHeard, DDS_RELIABILITY_RELIABLE);
    services_.push_back({make_reader("rq" + service + "Request", dds_type(type, "_Request"), DDS_RELIABILITY_RELIABLE),
                         make_writer("rr" + service + "Reply", dds_type(type, "_Response"), qos)});
    return std::uint32_t(services_.size() - 1);
  }
  // Each waits until its client hears replies.
  std::vector<std::string> take_requests(std::uint32_t service) override {
    Service& of = services_[service];
    for (DdsSample& sample : take_samples(of.requests, kHeard)) of.waiting.push_back({std::move(sample), dds_time() + kIntroduction});
    std::vector<std::string> ready;
    std::vector<Request> waiting;
    for (Request& request : of.waiting) {
      if (dds_time() >= request.latest || hears_replies(of, request.sample.writer)) ready.push_back(std::move(request.sample.bytes));
      else waiting.push_back(std::move(request));
    }
    of.waiting = std::move(waiting);
    return ready;
  }
  void reply(std::uint32_t service, std::string_view bytes) override { send(services_[service].replies, bytes); }

 private:
  struct Request {
    DdsSample sample;
    dds_time_t latest;  // then it is answered, whether its client hears it or not
  };
  struct Service {
    dds_entity_t requests = 0, replies = 0;
    std::vector<Request> waiting{};
  };
  using Endpoint = std::unique_ptr<dds_builtintopic_endpoint_t, void (*)(dds_builtintopic_endpoint_t*)>;

  // Whether the client that wrote a request has a reader of replies that is known here: its writer may be known earlier, and
  // what is sent before is lost. Also if the client has gone.
  static bool hears_replies(const Service& service, dds_instance_handle_t writer) {
    const Endpoint asks(dds_get_matched_publication_data(service.requests, writer), dds_builtintopic_free_endpoint);
    if (!asks) return true;
    dds_instance_handle_t readers[kMostClients];
    const dds_return_t count = dds_get_matched_subscriptions(service.replies, readers, kMostClients);
    for (dds_return_t i = 0; i < std::min(count, dds_return_t(kMostClients)); ++i) {
      const Endpoint reads(dds_get_matched_subscription_data(service.replies, readers[i]), dds_builtintopic_free_endpoint);
      if (reads && std::memcmp(&reads->participant_key, &asks->participant_key, sizeof reads->participant_key) == 0) return true;
    }
    return count > dds_return_t(kMostClients);
  }

  std::vector<dds_entity_t> heard_;
  std::vector<Service> services_;
};

}  // namespace

std::string describe_ros2() { return "Cyclone DDS " RUBBLE_CYCLONE_VERSION; }

void check_ros2(const Ros2Options& options) {
  const Ros2Stream<RosFile> attempt(options);
}

std::unique_ptr<RosFile> make_ros2_stream(const Ros2Options& options) {
  return std::make_unique<Ros2Stream<RosFile>>(options);
}

std::unique_ptr<DriveStream> make_ros2_drive(const Ros2Options& options) {
  return std::make_unique<Ros2Drive>(options);
}

std::unique_ptr<LiveServer> make_ros2_server(const Ros2Options& options) {
  return std::make_unique<Ros2Server>(options);
}

}  // namespace rubble
