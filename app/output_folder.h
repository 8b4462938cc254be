// The folder of a dataset: where its files go, and the hash of each once it is complete.
#pragma once

#include <map>
#include <string>

namespace rubble {

class OutputFolder {
 public:
  // Creates the folder. Throws InputError when it is not empty, unless `force`: then the files of an
  // earlier run are removed, and nothing else.
  OutputFolder(std::string path, bool force);

  const std::string& path() const { return path_; }
  std::string file(const std::string& name) const { return path_ + "/" + name; }
  // Records a file that is complete.
  void add(const std::string& name);
  const std::map<std::string, std::string>& hashes() const { return hashes_; }

 private:
  std::string path_;
  std::map<std::string, std::string> hashes_;  // name to SHA-256
};

}  // namespace rubble
