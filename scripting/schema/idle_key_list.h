// Keys that nothing reads in a script as it is, gathered table by table (scripting/scenario/idle_keys.h, scripting/packs/pack_schema.h).
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace rubble {

struct IdleKey {
  std::string path;        // of a key, or of a table with all that is in it
  std::string why;         // as in "has no effect, because ..."
  std::string switch_key;  // that switches it off; empty: another choice of the script stands against it
};

// Gathers the keys below one table. at: "lamp."
class IdleKeys {
 public:
  using Names = std::vector<std::string>;

  IdleKeys(std::string at, std::vector<IdleKey>& keys) : at_(std::move(at)), keys_(keys) {}

  // Keys that a choice of the script leaves unread.
  void against(bool idle, const std::string& why, const Names& names) {
    if (!names.empty()) add(idle, why, "", names);
  }
  // Keys of what is off as long as `switch_name` has its default. No names: the whole table.
  void off(bool idle, const std::string& switch_name, const std::string& is, const Names& names = {}) {
    const std::string whole = at_ + switch_name;
    add(idle, whole + " is " + is, whole, names);
  }

 private:
  void add(bool idle, const std::string& why, const std::string& switch_key, const Names& names) {
    if (!idle) return;
    if (names.empty()) keys_.push_back({at_.substr(0, at_.size() - 1), why, switch_key});
    for (const std::string& name : names) keys_.push_back({at_ + name, why, switch_key});
  }

  std::string at_;
  std::vector<IdleKey>& keys_;
};

inline std::string idle_sentence(const IdleKey& key) { return "has no effect, because " + key.why; }

}  // namespace rubble
