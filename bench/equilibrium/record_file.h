// The file of judged piles: a line of JSON each, so that a long list can be stopped and continued.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "bench/equilibrium/pile_record.h"

namespace rubble {

class RecordFile {
 public:
  // Reads what is there; a line that was cut short counts as absent. path empty: keeps no file.
  explicit RecordFile(const std::string& path);

  // Null when that pile was not judged yet.
  const Record* find(const std::string& work, std::uint64_t seed) const;

  // Appends and flushes. Throws RunError when the file cannot be written.
  void add(const Record& record);

 private:
  std::string path_;
  bool torn_ = false;  // the last line was cut short
  std::map<std::pair<std::string, std::uint64_t>, Record> records_;  // by work and seed
};

}  // namespace rubble
