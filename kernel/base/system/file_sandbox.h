// --sandbox DIR: the files that a mission from a stranger may read and write.
//
// It holds for the whole process and for the child processes that import meshes, like the user that a process runs
// as: files are opened in many parts, some by libraries. Whoever opens a file asks here; read_file() and
// check_readable_file() do it for their callers. Without a sandbox nothing is refused.
//
// Paths are compared after links are resolved. A file that is replaced by a link meanwhile is not noticed.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kernel/base/error.h"

namespace rubble {

// A file outside the sandbox. Readers that go on without a picture or a material file do not go on without this one.
class RefusedFile : public InputError {
 public:
  using InputError::InputError;
};

// From now on files are read only below `folder` and below folders of the program itself: `own`, and its `cache` (empty:
// none). Throws InputError when `folder` is no folder.
void enter_sandbox(const std::string& folder, const std::vector<std::string>& own, const std::string& cache);
void leave_sandbox();

// Its folder, absolute, links resolved; empty: there is no sandbox.
std::string sandbox_folder();

// A folder of results that the user named, which may be read, too. No name from a mission or a pack may get here.
void allow_results(const std::string& folder);
// The same of the output folder of a run. From now on files are written there and into the cache only.
void allow_output(const std::string& folder);

// Throws RefusedFile for a file outside. at: file, line and key where it is named; by default `path` itself is the
// file of the message.
void check_may_read(const std::string& path, const Diagnostic& at = {});
// The same as a mistake among others; nothing: it may be read.
std::optional<Diagnostic> find_refusal(const std::string& path, const Diagnostic& at = {});

void check_may_write(const std::string& path);  // throws RefusedFile

}  // namespace rubble
