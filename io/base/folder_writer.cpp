#include "io/base/folder_writer.h"

#include <unistd.h>

#include <filesystem>
#include <memory>

#include "io/base/atomic_file.h"
#include "io/base/remove_files.h"
#include "kernel/base/error.h"
#include "kernel/base/system/output_files.h"

namespace rubble {

namespace fs = std::filesystem;

FolderWriter::FolderWriter(std::string final_path, const std::vector<std::string>& folders,
                           int threads)
    : path_(std::move(final_path)), part_(path_ + ".part"), folders_(folders), tasks_(threads) {
  std::error_code error;
  if (fs::exists(fs::symlink_status(path_, error)))
    throw RunError("cannot create " + path_ + ": something of that name is there");
  lock_ = create_locked_folder(part_);
  try {
    for (const std::string& folder : folders) make_folder_below(part_, folder);
  } catch (...) {
    remove_output_folder(part_);  // the destructor will not run
    close(lock_);
    throw;
  }
}

FolderWriter::~FolderWriter() {
  if (!finished_) remove_output_folder(part_);
  close(lock_);
}

void FolderWriter::write(const std::string& name, std::string_view bytes) {
  write_part_file(part_ + "/" + name, bytes);
}

void FolderWriter::add(const std::string& name, std::function<std::string()> make) {
  tasks_.add([this, name, make = std::move(make)]() -> OrderedTasks::Commit {
    const auto bytes = std::make_shared<const std::string>(make());
    return [this, name, bytes] { write(name, *bytes); };
  });
}

void FolderWriter::append(const std::string& name, std::function<std::string()> make, std::function<void(std::size_t)> written) {
  tasks_.add([this, name, make = std::move(make), written = std::move(written)]() -> OrderedTasks::Commit {
    const auto bytes = std::make_shared<const std::string>(make());
    return [this, name, bytes, written] {
      AppendedFile(part_ + "/" + name).append(*bytes);
      if (written) written(bytes->size());
    };
  });
}

void FolderWriter::wait() { tasks_.finish(); }

void FolderWriter::finish() {
  tasks_.finish();
  // A folder without a file says nothing, and nothing states it as ours when the next run or export replaces this one.
  std::vector<std::string> inside;
  for (const std::string& folder : folders_) inside.push_back(folder + "/file");
  remove_empty_parents(part_, inside);
  commit_folder(part_, path_);
  finished_ = true;
}

}  // namespace rubble
