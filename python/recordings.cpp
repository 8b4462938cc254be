// Messages of recordings, as they are on the wire; rubble/dataset.py knows what they mean.

#include <nanobind/stl/pair.h>

#include <map>
#include <set>
#include <utility>

#include "io/ros/ros_message_reader.h"
#include "kernel/base/error.h"
#include "python/arrays.h"
#include "python/parts.h"

namespace rubble::python {
namespace {

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

template <typename Take>
void read_whole(const std::string& path, const Take& take) {
  const auto fault = ends_with(path, ".mcap") ? read_mcap(path, take) : read_bag(path, take);
  if (fault) throw InputError({path, 0, "", "the file is damaged", "a whole recording", fault->what, "rubble info says more"});
}

// Each message's bytes as an array of their own, by topic; topics: empty: of all.
std::map<std::string, std::vector<nb::bytes>> read_messages(const nb::object& given, const std::set<std::string>& topics) {
  const std::string path = to_path(given, "path");
  std::map<std::string, std::vector<nb::bytes>> messages;
  const auto take = [&](const RosMessage& m) {
    const std::string topic(m.topic);
    if (topics.empty() || topics.count(topic)) messages[topic].emplace_back(m.bytes.data(), m.bytes.size());
    return true;
  };
  read_whole(path, take);
  return messages;
}

// By topic: the type of its messages, as a bag names it, and how many there are.
std::map<std::string, std::pair<std::string, std::int64_t>> list_topics(const nb::object& given) {
  const std::string path = to_path(given, "path");
  std::map<std::string, std::pair<std::string, std::int64_t>> topics;
  const auto take = [&](const RosMessage& m) {
    auto& [type, count] = topics[std::string(m.topic)];
    type = m.type, ++count;
    return true;
  };
  read_whole(path, take);
  return topics;
}

}  // namespace

void add_recordings(nb::module_& module) {
  module.def("read_messages", &read_messages, nb::arg("path"), nb::arg("topics"));
  module.def("list_topics", &list_topics, nb::arg("path"));
}

}  // namespace rubble::python
