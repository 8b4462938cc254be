// All functions that write to the disk or remove files. A folder may be untrusted, with links and pipes in place of output
// files. They are never followed or waited for. In a sandbox (file_sandbox.h) each of these functions refuses what lies
// outside the output folder of the run.
//
// tests/app/guarded_calls_test.cpp finds the sources that open, make or remove files by other means.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace rubble {

// Creates a file for writing and locks it while the descriptor is open. A file, link or pipe of that name is
// removed first, never followed; a file that another writer has open is left alone. The descriptor is closed on
// exec. Throws RunError naming the path.
int create_output_file(const std::string& path);

// The same without the lock, for a log: a process that is about to end may still write one of that name, and goes on
// in a file without a name.
int create_log_file(const std::string& path);

// Whether the descriptor is that of the file which has this name now.
bool is_file_at(int descriptor, const std::string& path);

// Writes all of the bytes. Throws RunError naming `path`.
void write_all(int descriptor, std::string_view bytes, const std::string& path);

// A file of records that grows, such as a journal. Closed with the object.
class AppendedFile {
 public:
  // Opens or creates it. Throws InputError when it is a link, a pipe or a folder, or has a second name elsewhere, and
  // RunError when it cannot be opened.
  explicit AppendedFile(const std::string& path);
  ~AppendedFile();
  AppendedFile(const AppendedFile&) = delete;
  AppendedFile& operator=(const AppendedFile&) = delete;

  std::string read_all() const;
  void cut(std::uint64_t size);        // keeps the first so many bytes
  void append(std::string_view bytes);  // throws RunError

 private:
  std::string path_;
  int descriptor_ = -1;
};

// Makes a folder that the user named, with its parents; links in the way are the user's own. Throws InputError when
// something else has the name, RunError when it cannot be made.
void make_output_folder(const std::string& folder);

// Makes FOLDER/NAME (NAME may be "a/b/c") below a folder that is there, and returns its path. Throws InputError when
// a part of NAME is "..", a link, or no folder: what is written there would land elsewhere.
std::string make_folder_below(const std::string& folder, const std::string& name);

// Makes `path` as an empty folder, locked while the descriptor is open. What a writer left there that died is removed.
// Throws RunError when another process has it open.
int create_locked_folder(const std::string& path);

// A new folder for this process alone in one that others may write to, with a name that nobody can guess. Throws
// RunError.
std::string make_private_folder(const std::string& parent, const std::string& name);

// Removes a file, link or pipe; never what a link leads to, never a folder. False: it was not there, or could not be
// removed.
bool remove_output_file(const std::string& path);

// Removes a folder that only this program writes to, with all that is in it, or a link of that name itself; never
// what a link leads to.
void remove_output_folder(const std::string& path);

}  // namespace rubble
