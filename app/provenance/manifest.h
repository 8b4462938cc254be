// manifest.json: everything needed to make a dataset again and to check that it is the same.
//
// Stable keys that other programs read: "state_hash" (16 hexadecimal digits), "outputs" (file name
// to SHA-256), "frames" (their number), "metrics". All but "not_reproducible" is the same for the
// same input and program. docs/how_to/reproducing.md describes every member.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "app/provenance/frame_hashes.h"
#include "app/provenance/provenance.h"
#include "app/support/build_info.h"
#include "kernel/model/pile_state.h"

namespace rubble {

struct PileSummary {
  std::string state_hash;                                             // of the pile, 16 hexadecimal digits
  bool settled = false;                                               // false: the time limit came first
  std::int64_t pieces = 0, lost = 0, steps = 0, layers_at_limit = 0;  // as in PileState
  double simulated = 0;                                               // unit: s
};
PileSummary summarize(const PileState& pile);

struct Manifest {
  BuildInfo program;                           // which made it
  Provenance provenance;                       // from which all can be made again
  std::uint64_t seed = 0;                      // of the scenario
  PileSummary pile;                            // what settled
  FrameHashes frames;                          // of every channel of every frame
  std::map<std::string, double> metrics;       // of the pile and the frames: app/measures/metrics.h
  std::map<std::string, std::string> outputs;  // file name to SHA-256

  std::vector<std::string> warnings;           // what is likely not as it was meant

  // What may differ from run to run.
  std::map<std::string, double> wall_seconds;      // a stage's name to its time
  std::map<std::string, std::string> environment;  // what this machine drew with, and the like
  std::vector<std::string> pack_folders;           // where the packs were
};

// Indented JSON, ending in a line feed. "seals" holds the SHA-256 of each part.
std::string manifest_to_json(const Manifest& manifest);

// Throws InputError, naming `file`: not JSON, of another format, a member missing.
Manifest manifest_from_json(const std::string& text, const std::string& file);

// The parts of a manifest whose seal they do not match: somebody changed them. One sentence each.
std::vector<std::string> find_altered_parts(const std::string& text, const std::string& file);

}  // namespace rubble
