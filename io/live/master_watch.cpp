#include "io/live/master_watch.h"

#include <ros/master.h>
#include <ros/this_node.h>
#include <ros/xmlrpc_manager.h>

#include <chrono>

namespace rubble {
namespace {

constexpr std::chrono::milliseconds kNap{50}, kPeriod{500};

// One request of the Master API; false when it fails, or no master answers.
bool ask(const char* method, const std::vector<std::string>& arguments) {
  XmlRpc::XmlRpcValue list, response, payload;
  for (std::size_t i = 0; i < arguments.size(); ++i) list[int(i)] = arguments[i];
  return ::ros::master::execute(method, list, response, payload, false);
}

}  // namespace

MasterWatch::MasterWatch(std::vector<PublishedTopic> topics,
                         std::function<void(const std::string&)> notice)
    : topics_(std::move(topics)), notice_(std::move(notice)), thread_([this] { work(); }) {}

MasterWatch::~MasterWatch() {
  stop_ = true;
  thread_.join();
}

void MasterWatch::work() {
  bool gone = false;
  for (int naps = 1; !stop_; ++naps) {
    std::this_thread::sleep_for(kNap);
    if (naps % (kPeriod / kNap) != 0 || knows_us()) continue;
    if (!gone) notice_("the ROS master at " + ::ros::master::getURI() + " is gone; publishing goes on");
    gone = !register_all();
    if (!gone) notice_("the ROS master is back; the topics are registered again");
  }
}

bool MasterWatch::knows_us() const {
  const std::string node = ::ros::this_node::getName();
  return ask("lookupNode", {node, node});
}

bool MasterWatch::register_all() const {
  const std::string uri = ::ros::XMLRPCManager::instance()->getServerURI();
  for (const PublishedTopic& each : topics_)
    if (!ask("registerPublisher", {::ros::this_node::getName(), each.topic, each.type, uri}))
      return false;
  return true;
}

}  // namespace rubble
