// Files that have their final name only when they are complete.
//
// Everything is written as "NAME.part" in the same folder, flushed to the disk, and then renamed,
// so a full disk, a kill or a power cut leaves either no NAME or a whole one. Links are not followed: what has one
// of the two names is replaced. A second writer of the same name is refused while the first one is at work
// (kernel/base/system/output_files.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace rubble {

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
  const std::string& path() const { return path_; }
  void commit();  // nothing may be written afterwards

 private:
  void flush();

  std::string path_, part_;
  int descriptor_ = -1;
  bool committed_ = false;
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

// Throws InputError when one of these files is in the folder, unless `force`: somebody else may have written it.
void refuse_to_replace(const std::string& folder, const std::vector<std::string>& names, bool force);

// Where a command writes: `asked`, or, if that is empty, DATASET/NAME, which is made there and must be no link.
std::string output_folder_of(const std::string& asked, const std::string& dataset, const std::string& name);

}  // namespace rubble
