// The folder of a dataset: its files, and what an unfinished run keeps there to be continued.
//
//   DIR/unfinished/lock               held by the process at work, from the first to the last
//   DIR/unfinished/run.json           what is being run: written first, removed last
//   DIR/unfinished/settle.checkpoint  where settling was a few seconds ago
//   DIR/unfinished/settle.track       who moved until then, where the run records it
//   DIR/unfinished/settled.txt        what pile.bin was made from, and its SHA-256
//   DIR/unfinished/frames.txt         hashes of the frames that were rendered
//   DIR/unfinished/files.txt          names of the files that it writes
//   DIR/pile.bin, ...                 a file has its final name when it is complete
//   DIR/manifest.json                 written when all the others are there
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "kernel/model/pile_state.h"

namespace rubble {

class FolderLock;

class RunFolder {
 public:
  // For a new run. Creates the folder, and locks it until the object goes. Throws InputError when
  // another process is at work in it, and when an unfinished run or anything else is in it, unless
  // `force`: then the files of that run are removed, and nothing else.
  static RunFolder create(const std::string& path, bool force);
  // For going on with an unfinished one. Throws InputError when there is none, or when another
  // process is at work in it.
  static RunFolder open_unfinished(const std::string& path);

  const std::string& path() const { return path_; }
  std::string file(const std::string& name) const { return path_ + "/" + name; }
  bool has(const std::string& name) const;
  std::string run_file() const { return file("unfinished/run.json"); }
  std::string checkpoint_file() const { return file("unfinished/settle.checkpoint"); }
  std::string track_so_far_file() const { return file("unfinished/settle.track"); }
  std::string frames_file() const { return file("unfinished/frames.txt"); }

  // Marks the folder as that of an unfinished run, until finish(). run_json: what is being run.
  void begin(const std::string& run_json);
  void finish() const;
  // Of pile.bin, which is complete: `work` is the hash of what it was made from (hash_work()).
  void note_pile(std::uint64_t work, const DeepestOverlap& overlap) const;
  // Whether pile.bin is there, is the one that was noted, and was made from this work.
  bool has_pile_of(std::uint64_t work) const;
  // What was noted beside it, which pile.bin does not hold.
  DeepestOverlap noted_overlap() const;

  // Notes files that are about to be written, so that --force finds them whatever happens.
  void expect(const std::vector<std::string>& names) const;

  // Notes a file that is complete; of a folder, every file in it.
  void add(const std::string& name);
  // SHA-256 by name of all that was added. A dataset has gigabytes, so threads share the files; what
  // was hashed before is not hashed again.
  const std::map<std::string, std::string>& hash_files(int threads);

 private:
  explicit RunFolder(std::string path) : path_(std::move(path)) {}

  std::string path_;
  std::shared_ptr<const FolderLock> lock_;     // while the run is not finished
  std::map<std::string, std::string> hashes_;  // name to SHA-256; empty: not calculated yet
};

// Whether `rubble resume` has something to continue there.
bool is_unfinished(const std::string& folder);

}  // namespace rubble
