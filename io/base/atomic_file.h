// Files that have their final name only when they are complete.
//
// Everything is written as "NAME.part" in the same folder, flushed to the disk, and then renamed,
// so a full disk, a kill or a power cut leaves either no NAME or a whole one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace rubble {

// A final name and the temporary one beside it, for a library that opens files by itself.
class PendingPath {
 public:
  explicit PendingPath(std::string final_path);
  ~PendingPath();  // without commit(): removes the temporary file
  PendingPath(const PendingPath&) = delete;
  PendingPath& operator=(const PendingPath&) = delete;

  const std::string& part() const { return part_; }
  const std::string& path() const { return path_; }
  // Flushes the temporary file to the disk and renames it. Throws RunError.
  void commit();

 private:
  std::string path_, part_;
  bool committed_ = false;
};

// A buffered binary file. Every call throws RunError, with path and reason, on any failure.
class AtomicFile {
 public:
  explicit AtomicFile(const std::string& final_path);  // creates "NAME.part"
  ~AtomicFile();                                       // without commit(): removes it
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(const void* data, std::size_t size);
  void write(std::string_view text) { write(text.data(), text.size()); }
  // Replaces bytes that were written before, e.g. a header with offsets known at the end.
  void overwrite(std::uint64_t offset, std::string_view bytes);
  std::uint64_t size() const { return size_; }  // bytes written so far
  const std::string& path() const { return pending_.path(); }
  void commit();  // nothing may be written afterwards

 private:
  void flush();

  PendingPath pending_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
  std::vector<char> buffer_;
};

// Writes a file of a folder that has its final name later (io/base/folder_writer.h); not flushed to the
// disk. Throws RunError.
void write_part_file(const std::string& path, std::string_view bytes);
// Flushes all that was written into the folder `part` to the disk and renames it. Throws RunError.
void commit_folder(const std::string& part, const std::string& path);

// Writes `text` as the whole of `path`, atomically. Throws RunError.
void write_text_file(const std::string& path, std::string_view text);

// The whole file. Throws InputError naming the path and the reason: what is read is the user's. See
// kernel/base/read_file.h for pipes and devices.
std::string read_whole_file(const std::string& path);

// Makes `folder` ready for a run whose files are `outputs` (names, without folders). A missing one
// is created; one that is not empty is refused (InputError) without `force`. With it, files of
// those names, and their ".part", are removed; any other file stays untouched.
void prepare_output_folder(const std::string& folder, bool force,
                           const std::vector<std::string>& outputs);

}  // namespace rubble
