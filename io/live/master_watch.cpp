#include "io/live/master_watch.h"

#include <ros/master.h>
#include <ros/network.h>
#include <ros/this_node.h>
#include <ros/xmlrpc_manager.h>
#include <xmlrpcpp/XmlRpcException.h>

#include <chrono>

namespace rubble {
namespace {

constexpr std::chrono::milliseconds kNap{50}, kPeriod{500};

// One request of the Master API; false when it fails, or no master answers.
bool ask(const char* method, const std::vector<std::string>& arguments,
         XmlRpc::XmlRpcValue& payload) {
  XmlRpc::XmlRpcValue list, response;
  for (std::size_t i = 0; i < arguments.size(); ++i) list[int(i)] = arguments[i];
  try {
    return ::ros::master::execute(method, list, response, payload, false);
  } catch (const XmlRpc::XmlRpcException&) {  // an answer of no master
    return false;
  }
}

// What a master does when publishers change. roscpp has no other door for it.
void tell_ourselves(const std::string& uri, const std::string& topic,
                    const XmlRpc::XmlRpcValue& publishers) {
  std::string host;
  std::uint32_t port = 0;
  if (!::ros::network::splitURI(uri, host, port)) return;
  XmlRpc::XmlRpcClient client(host.c_str(), int(port), "/");
  XmlRpc::XmlRpcValue arguments, result;
  arguments[0] = "/master";
  arguments[1] = topic;
  arguments[2] = publishers;
  client.execute("publisherUpdate", arguments, result);
}

}  // namespace

MasterWatch::MasterWatch(std::vector<KnownTopic> topics,
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
    if (naps % (kPeriod / kNap) != 0 || (!gone && knows_us())) continue;
    if (!gone) notice_("the ROS master at " + ::ros::master::getURI() + " is gone; publishing goes on");
    gone = !register_all();
    if (!gone) notice_("the ROS master is back; the topics are registered again");
  }
}

bool MasterWatch::knows_us() const {
  const std::string node = ::ros::this_node::getName();
  XmlRpc::XmlRpcValue address;
  return ask("lookupNode", {node, node}, address);
}

// Who publishes what is heard comes back at once; whoever begins later, the master tells of.
bool MasterWatch::register_all() const {
  const std::string uri = ::ros::XMLRPCManager::instance()->getServerURI();
  for (const KnownTopic& each : topics_) {
    const bool heard = each.way == KnownTopic::heard;
    XmlRpc::XmlRpcValue publishers;
    if (!ask(heard ? "registerSubscriber" : "registerPublisher",
             {::ros::this_node::getName(), each.topic, each.type, uri}, publishers))
      return false;
    if (heard) tell_ourselves(uri, each.topic, publishers);
  }
  return true;
}

}  // namespace rubble
