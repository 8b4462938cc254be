// Whether a dataset can be had again: everything is run anew from its manifest alone, and compared.
#pragma once

#include <string>
#include <vector>

#include "app/pipeline/run_request.h"

namespace rubble {

enum class Verdict { equal, differs, skipped };

// What became of one part of a dataset: "manifest", "recorded files", "scenario", "assets", "pile",
// "frames", "metrics", "files".
struct Finding {
  std::string part;
  Verdict verdict = Verdict::equal;
  std::string detail;  // where it differs first, or what was compared
};

struct Verification {
  std::vector<Finding> findings;   // in the order of the run
  std::vector<std::string> notes;  // what is another here: versions, graphics driver
  bool equal() const;              // nothing differs
};

struct VerifyRequest {
  FolderRequest of;
  std::string work;        // --work: where the run is made anew; empty: a temporary folder
  bool pile_only = false;  // --pile-only: no frames
  bool json = false;       // --json
};

// Throws InputError for a folder without a manifest, or with one that cannot be read, and for packs
// that are nowhere to be found.
Verification verify(const VerifyRequest& request);

// For a person, and for a program.
std::string to_text(const Verification& verification);
std::string to_json(const Verification& verification);

}  // namespace rubble
