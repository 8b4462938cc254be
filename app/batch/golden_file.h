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

// What tells where two runs part; golden files of earlier programs have none.
struct GoldenDetails {
  std::string pieces;  // digest_pieces(); empty: not kept
  FrameHashes frames;  // none: not kept
};
GoldenDetails golden_details(const Manifest& manifest, const PileState& pile, GoldenParts parts);

class GoldenFile {
 public:
  // A missing file is an empty one. Throws InputError for one that cannot be read.
  explicit GoldenFile(const std::string& path);

  // What differs, a sentence each; empty: nothing. run: "heap/seed_3".
  std::vector<std::string> compare(const std::string& run, const GoldenHashes& found) const;
  // The first piece that differs and the first frame with its channel, a sentence each, as far as the
  // file holds details of the run.
  std::vector<std::string> find_first(const std::string& run, const PileState& pile,
                                      const FrameHashes& frames) const;
  // Takes them; returns the lines of a diff.
  std::vector<std::string> update(const std::string& run, const GoldenHashes& found,
                                  const GoldenDetails& details);
  // Forgets the runs that are not in the list; returns the lines of a diff.
  std::vector<std::string> keep_only(const std::vector<std::string>& runs);
  void save() const;

 private:
  std::string path_;
  std::map<std::string, GoldenHashes> runs_;
  std::map<std::string, GoldenDetails> details_;
};

}  // namespace rubble
