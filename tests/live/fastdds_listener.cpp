// fastdds_listener FOLDER DOMAIN SECONDS [--sensor-data|--as-installed] TOPIC TYPE COUNT ...: hears ROS 2 topics by
// Fast DDS, another maker's DDS than that which publishes, with rmw's names and qualities of service.
// Writes every message as it came, CDR and all, to FOLDER/<number of the topic>.<number of the message>
// and succeeds when COUNT of each topic have come. With --sensor-data: best effort, as drivers' readers
// have it. With --as-installed: over every interface, multicast and shared memory, as Fast DDS does
// unless told otherwise, and not by UDP on the loopback interface alone. Prints "ready" when it listens.
#include <fastdds/dds/core/policy/QosPolicies.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/live/fastdds_bytes.h"

namespace {

using namespace rubble::testing;


struct Heard {
  fast::DataReader* reader;
  int wanted, count;
};

fast::DataReader* listen(fast::DomainParticipant* participant, fast::Subscriber* subscriber,
                        const std::string& topic, const std::string& type, bool sensor_data) {
  fast::Topic* const entity = make_topic(participant, topic, type);
  fast::DataReaderQos qos;
  qos.history().kind = fast::KEEP_LAST_HISTORY_QOS;
  qos.history().depth = 100;
  qos.endpoint().history_memory_policy =
      eprosima::fastrtps::rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
  qos.reliability().kind =
      sensor_data ? fast::BEST_EFFORT_RELIABILITY_QOS : fast::RELIABLE_RELIABILITY_QOS;
  const bool latched = topic == "/tf_static";
  qos.durability().kind = latched ? fast::TRANSIENT_LOCAL_DURABILITY_QOS : fast::VOLATILE_DURABILITY_QOS;
  return subscriber->create_datareader(entity, qos);
}

bool take(std::vector<Heard>& all, const std::string& folder) {
  bool complete = true;
  for (std::size_t i = 0; i < all.size(); ++i) {
    std::string bytes;
    fast::SampleInfo info;
    while (all[i].reader->take_next_sample(&bytes, &info) == ReturnCode_t::RETCODE_OK) {
      if (!info.valid_data) continue;
      const std::string name = std::to_string(i) + "." + std::to_string(all[i].count++);
      std::ofstream(folder + "/" + name, std::ios::binary) << bytes;
    }
    complete = complete && all[i].count >= all[i].wanted;
  }
  return complete;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string folder = argv[1];
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(std::atoi(argv[3]));
  const bool sensor_data = argc > 4 && std::strcmp(argv[4], "--sensor-data") == 0;
  const bool as_installed = argc > 4 && std::strcmp(argv[4], "--as-installed") == 0;
  fast::DomainParticipant* const participant = join(unsigned(std::atoi(argv[2])), as_installed);
  if (!participant) return 2;
  fast::Subscriber* const subscriber = participant->create_subscriber(fast::SUBSCRIBER_QOS_DEFAULT);
  std::vector<Heard> all;
  for (int i = sensor_data || as_installed ? 5 : 4; i + 2 < argc; i += 3) {
    fast::DataReader* const reader =
        listen(participant, subscriber, argv[i], argv[i + 1], sensor_data);
    if (!reader) return 2;
    all.push_back({reader, std::atoi(argv[i + 2]), 0});
  }
  std::printf("ready\n");
  std::fflush(stdout);
  bool complete = false;
  while (!(complete = take(all, folder)) && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  for (const Heard& each : all) std::printf("%d of %d\n", each.count, each.wanted);
  leave(participant);
  return complete ? 0 : 1;
}
