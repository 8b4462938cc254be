// The finished tiles of an image that is still being traced, in one file, so that an interrupted image
// goes on. Each record has a checksum: what a kill cut off does not count.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>
#include <vector>

#include "kernel/base/system/output_files.h"
#include "render/reference/path_tracer.h"

namespace rubble {

class TileJournal {
 public:
  TileJournal() = default;  // keeps nothing
  // Reads what is there. folder: made if need be; key: of all that the image follows from.
  TileJournal(const std::string& folder, const std::string& key);

  // Null: the tile is not there, or of another size.
  const std::vector<PixelSums>* find(std::uint32_t tile, std::size_t pixels) const;
  // From any thread. A disk that is full costs only the resumption.
  void note(std::uint32_t tile, const std::vector<PixelSums>& sums);
  void remove();  // the image is finished

 private:
  std::string path_;
  std::unique_ptr<AppendedFile> file_;  // null: keeps nothing
  std::unordered_map<std::uint32_t, std::vector<PixelSums>> tiles_;
  std::mutex mutex_;
};

}  // namespace rubble
