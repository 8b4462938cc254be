#include "bench/equilibrium/record_file.h"

#include <fstream>

#include "kernel/base/error.h"

namespace rubble {
namespace {

std::pair<std::string, std::uint64_t> key_of(const Record& record) {
  return {record.value("work", ""), record.value("seed", std::uint64_t(0))};
}

}  // namespace

RecordFile::RecordFile(const std::string& path) : path_(path) {
  if (path_.empty()) return;
  std::ifstream file(path_);
  for (std::string line; std::getline(file, line);) {
    const Record record = Record::parse(line, nullptr, false);
    if (record.is_object()) records_[key_of(record)] = record;
    torn_ = file.eof();  // no line end
  }
}

const Record* RecordFile::find(const std::string& work, std::uint64_t seed) const {
  const auto found = records_.find({work, seed});
  return found == records_.end() ? nullptr : &found->second;
}

void RecordFile::add(const Record& record) {
  records_[key_of(record)] = record;
  if (path_.empty()) return;
  std::ofstream file(path_, std::ios::app);
  if (torn_) file << "\n";
  torn_ = false;
  file << record.dump() << "\n" << std::flush;
  if (!file) throw RunError("cannot write " + path_);
}

}  // namespace rubble
