// What a dataset or a single recording holds, and whether it is still whole: `rubble info PATH`.
// Nothing is run again; `rubble verify` does that.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kernel/base/error.h"

namespace rubble {

enum class FileVerdict {
  sound,    // as the manifest says, or, without one, as its format wants it
  altered,  // or truncated
  missing,
  not_checked,  // of a kind that says nothing about itself, and without a manifest
};

struct FileReport {
  FileVerdict verdict = FileVerdict::sound;  // what became of the file
  std::string detail;                        // kind and content, or where it is damaged
  std::uint64_t bytes = 0;                   // size of one that is there
};

// hash: the SHA-256 that a manifest states for it. Throws InputError when it cannot be read.
FileReport inspect_file(const std::string& path, const std::optional<std::string>& hash);

// Prints a row for the file; for every file of a dataset, those of a folder as one row as long as
// they are sound; or how far the seeds of a batch are. Returns whether all of it is sound and no seed
// failed.
// Throws InputError: no such path, a folder without a run.
bool print_report(const std::string& path);

// All of them. `differs` when one is damaged.
ExitCode inspect_datasets(const std::vector<std::string>& paths);

}  // namespace rubble
