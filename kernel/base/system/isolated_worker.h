// Reads untrusted files in a child process with limits. If a third-party importer crashes, takes all memory or never
// ends on a hostile file, this process gets an InputError.
//
// The child is forked without exec. A separate program would have to be found and would load two hundred libraries
// again. After a fork of a process with several threads, only the forking thread exists in the child, and locks of
// other threads stay locked: a child that takes one waits for ever. glibc handles the locks of malloc, stdio and the
// loader. Most importers run in such children only, so no thread holds their locks. Where other threads use the
// library of an importer, as writers of pictures use OpenEXR, they do so under a ForkHold. The child leaves by _exit:
// no destructor and no buffer of stdio runs twice. It closes all files of the parent, including locks of folders.
//
// A fork of `rubble` costs about 13 ms, mostly for its 200 libraries, so one child reads many files of one folder, or
// of one recording. After an error, and when the folder changes, the child ends and the next file gets a new one. So
// files of different owners do not share a child.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <string>

namespace rubble {

// While it lives, no other thread forks a child to read a file in. For a thread that uses a library which such children use
// too. It must be short, and ask() must not be called under it.
class ForkHold {
 public:
  ForkHold();
  ~ForkHold();
  ForkHold(const ForkHold&) = delete;
  ForkHold& operator=(const ForkHold&) = delete;
};

struct ImportLimits {
  // memory: beyond what this process has already. Not held under the sanitizers, whose shadow memory
  // alone is larger. unit: byte
#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
  std::uint64_t memory = std::uint64_t(64) << 20;  // a fuzzer has a million files to try
  int cpu_seconds = 1;                             // a fiftieth, in truth
#else
  std::uint64_t memory = std::uint64_t(4) << 30;  // as above
  int cpu_seconds = 120;                          // for one file
#endif
  int wall_seconds = 300;  // for a file that never comes, such as a pipe behind a `mtllib`
};

// For one thread at a time.
class IsolatedWorker {
 public:
  // Computes the bytes of an answer from those of a request, in the child.
  using Handler = std::function<std::string(const std::string& request)>;

  // what: as in "mesh"; completes "cannot be read as a ...".
  IsolatedWorker(std::string what, Handler handler, const ImportLimits& limits = {});
  ~IsolatedWorker();
  IsolatedWorker(const IsolatedWorker&) = delete;
  IsolatedWorker& operator=(const IsolatedWorker&) = delete;

  // Files below that folder, which one owner made, have one child. Empty: each folder has its own.
  void share_folder(const std::string& folder) { shared_ = folder.empty() ? "" : folder + "/"; }

  // What the handler makes of the request, which is about the file `path`. An InputError of the
  // handler is thrown here as it was; otherwise, InputError naming `path` when the child crashed,
  // ran into a limit or threw. RunError: no process could be made.
  std::string ask(const std::string& path, const std::string& request);

 private:
  void start();
  void stop();
  int wait();  // for the child's end; its status
  // answered: whether the child lives on to answer again.
  std::string answer_of(const std::string& path, const std::string& request, bool& answered);

  std::string what_;
  Handler handler_;
  ImportLimits limits_;
  std::string shared_;  // with a slash at its end
  std::string folder_;  // whose files the child reads
  pid_t child_ = -1;
  int socket_ = -1;
};

// One file, in a child of its own. (Under a fuzzer, which would fork a million times, one child serves
// until it dies, here and above: what makes it die is what is looked for.)
std::string run_isolated(const std::string& path, const std::string& what,
                         const std::function<std::string()>& work,
                         const ImportLimits& limits = {});

}  // namespace rubble
