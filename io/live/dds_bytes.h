// A type of Cyclone DDS whose samples are CDR already, whatever the type: what is written is sent as
// it is, so that what is heard live is what a file holds; what is read comes as it was sent.
#pragma once

#include <dds/dds.h>

#include <string>
#include <string_view>
#include <vector>

namespace rubble {

// The sample that dds_write() of such a topic takes a pointer to: CDR with its header of 4 bytes.
using DdsBytes = std::string_view;

// type: e.g. "sensor_msgs::msg::dds_::Image_". A topic, or a negative number as dds_create_topic()
// gives it.
dds_entity_t create_bytes_topic(dds_entity_t participant, const std::string& topic,
                                const std::string& type);

// What has come to a reader of such a topic, in order; no more than `most`, as a writer may be faster.
std::vector<std::string> take_bytes(dds_entity_t reader, std::size_t most);

struct DdsSample {
  std::string bytes;
  dds_instance_handle_t writer = 0;  // that sent it
};
// Likewise, with their writers.
std::vector<DdsSample> take_samples(dds_entity_t reader, std::size_t most);

}  // namespace rubble
