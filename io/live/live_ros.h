// Live publishing: the messages of a recording, byte for byte those of its bag or MCAP file, over a
// network while the frames are drawn. Components of the build that may be missing; what is asked of
// a missing one throws InputError naming the Debian package.
//
// Simulation time goes out on /clock. Latched topics reach subscribers that come late. A slow
// subscriber never holds up the run: it loses messages (see kQueue in the sources).
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "io/live/drive_commands.h"
#include "io/ros/ros_recorder.h"

namespace rubble {

struct LiveOptions {
  double rate = 1;  // seconds of simulation in one of the wall's; 0: as fast as frames come
  double wait = 0;  // before the first frame, at most that long, until every topic has a
                    // subscriber; unit: s
  std::function<bool()> stopped = [] { return false; };       // then nothing waits any longer
  std::function<void(const std::string&)> notice = [](auto&) {};  // a line for a person; from any
                                                                  // thread
};

struct Ros1Options : LiveOptions {
  std::string node = "rubble";  // its name, to which roscpp adds a number
  std::string master;   // URI; empty: $ROS_MASTER_URI, or http://localhost:11311
  std::string address;  // by which others reach this machine; empty: $ROS_HOSTNAME, $ROS_IP, or
                        // 127.0.0.1, and then only programs of this machine can connect
};

struct Ros2Options : LiveOptions {
  int domain = 0;         // 0 to 232
  std::string interface;  // of the network, e.g. "eth0"; empty: as $CYCLONEDDS_URI says, or "lo"
};

// Whether the component is there, for `rubble info`: its version, or what is missing.
std::string describe_ros1();
// To be called once, before other threads run. InputError: not built in, or a URI that is none.
// RunError: no master answers.
void check_ros1(const Ros1Options& options);
// After check_ros1(), with the same options. Registers with the master; at most one at a time. A
// master that goes is waited for and told of every topic when it returns; who was connected keeps
// receiving meanwhile.
std::unique_ptr<RosFile> make_ros1_stream(const Ros1Options& options);

// A stream that hears commands, too: those of /cmd_vel, /joy and /joint_trajectory.
class DriveStream : public RosFile {
 public:
  virtual DriveCommands take() = 0;  // what came since the last call; never waits
};
std::unique_ptr<DriveStream> make_ros1_drive(const Ros1Options& options);

// A stream that answers services as well, and hears topics by any name. Numbers are those that listen() and serve() gave.
class LiveServer : public RosFile {
 public:
  // type: "geometry_msgs/msg/Twist". reliable: none may be lost.
  virtual std::uint32_t listen(const std::string& topic, const std::string& type, bool reliable) = 0;
  virtual std::vector<std::string> take(std::uint32_t topic) = 0;  // what came since the last call; never waits
  // type: "simulation_interfaces/srv/StepSimulation".
  virtual std::uint32_t serve(const std::string& service, const std::string& type) = 0;
  virtual std::vector<std::string> take_requests(std::uint32_t service) = 0;
  virtual void reply(std::uint32_t service, std::string_view bytes) = 0;
};

// The same for ROS 2. RunError: DDS cannot start, or knows no such interface. There is no master:
// readers come and go as they like.
std::string describe_ros2();
void check_ros2(const Ros2Options& options);
std::unique_ptr<RosFile> make_ros2_stream(const Ros2Options& options);
std::unique_ptr<DriveStream> make_ros2_drive(const Ros2Options& options);
// Services are those of rmw_cyclonedds: clients of other middleware see the topics, but get no answers.
std::unique_ptr<LiveServer> make_ros2_server(const Ros2Options& options);

}  // namespace rubble
