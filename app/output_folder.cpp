#include "app/output_folder.h"

#include "io/atomic_file.h"
#include "kernel/base/hash.h"

namespace rubble {

OutputFolder::OutputFolder(std::string path, bool force) : path_(std::move(path)) {
  prepare_output_folder(path_, force,
                        {"mission.rawlog", "mission.bag", "pile.stl", "pile.bin", "groundtruth.txt",
                         "preview.png", "manifest.json"});
}

void OutputFolder::add(const std::string& name) { hashes_[name] = sha256_of_file(file(name)); }

}  // namespace rubble
