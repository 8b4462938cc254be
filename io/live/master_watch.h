// Keeps the topics of this process known to the ROS 1 master. roscpp tells a master of a topic once;
// a master that was started anew knows nothing of it.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <thread>
#include <vector>

namespace rubble {

struct KnownTopic {
  std::string topic, type;  // as the master lists them
  enum Way { published, heard } way = published;
};

class MasterWatch {
 public:
  // From now on asks the master twice a second whether it knows this node, and registers `topics`
  // when it does not. notice: told when the master is gone and when it is back.
  MasterWatch(std::vector<KnownTopic> topics, std::function<void(const std::string&)> notice);
  ~MasterWatch();  // waits for a request under way

 private:
  void work();
  bool knows_us() const;
  bool register_all() const;

  std::vector<KnownTopic> topics_;
  std::function<void(const std::string&)> notice_;
  std::atomic<bool> stop_{false};
  std::thread thread_;  // last: it uses the others
};

}  // namespace rubble
