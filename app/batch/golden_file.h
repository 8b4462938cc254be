// SUITE.golden.json: the hashes that a suite's runs gave when somebody last said they were right.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "app/provenance/manifest.h"
#include "scripting/suite_script.h"

namespace rubble {

// Name of a hash to its value: "state_hash", "frames", and the name of each file.
using GoldenHashes = std::map<std::string, std::string>;

// Those that this run is held to.
GoldenHashes golden_hashes(const Manifest& manifest, GoldenParts parts);

class GoldenFile {
 public:
  // A missing file is an empty one. Throws InputError for one that cannot be read.
  explicit GoldenFile(const std::string& path);

  // What differs, a sentence each; empty: nothing. run: "heap/seed_3".
  std::vector<std::string> compare(const std::string& run, const GoldenHashes& found) const;
  // Takes them; returns the lines of a diff.
  std::vector<std::string> update(const std::string& run, const GoldenHashes& found);
  // Forgets the runs that are not in the list; returns the lines of a diff.
  std::vector<std::string> keep_only(const std::vector<std::string>& runs);
  void save() const;

 private:
  std::string path_;
  std::map<std::string, GoldenHashes> runs_;
};

}  // namespace rubble
