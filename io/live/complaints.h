// What is said of bad messages: the first of a topic, then the tenth, the hundredth and so on, so
// that a peer who sends thousands a second does not bury what else is said.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>

namespace rubble {

class Complaints {
 public:
  explicit Complaints(std::function<void(const std::string&)> notice)
      : notice_(std::move(notice)) {}

  void note(const std::string& topic, const std::string& what) {
    const std::uint64_t count = ++counts_[topic];
    std::uint64_t power = 1;
    while (power * 10 <= count) power *= 10;
    if (count != power) return;
    notice_(topic + ": " + what + (count > 1 ? ", " + std::to_string(count) + " times" : ""));
  }

 private:
  std::function<void(const std::string&)> notice_;
  std::map<std::string, std::uint64_t> counts_;
};

}  // namespace rubble
