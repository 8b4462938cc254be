// What a dataset or a single recording holds, and whether it is still whole: `rubble info PATH`.
// Nothing is run again; `rubble verify` does that.
#pragma once

#include <optional>
#include <string>

namespace rubble {

enum class FileVerdict {
  sound,    // as the manifest says, or, without one, as its format wants it
  altered,  // or truncated
  missing,
  not_checked,  // of a kind that says nothing about itself, and without a manifest
};

struct FileReport {
  FileVerdict verdict = FileVerdict::sound;
  std::string detail;  // kind and content, or where it is damaged
};

// hash: the SHA-256 that a manifest states for it. Throws InputError when it cannot be read.
FileReport look_over_file(const std::string& path, const std::optional<std::string>& hash);

// Prints a row for the file, or for every file of the dataset. Returns whether all of it is sound.
// Throws InputError: no such path, a folder without a run.
bool print_report(const std::string& path);

}  // namespace rubble
