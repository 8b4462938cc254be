#include "render/reference/tile_journal.h"

#include <cstring>
#include <type_traits>

#include "kernel/base/error.h"
#include "kernel/base/hash.h"
#include "kernel/base/system/output_files.h"

namespace rubble {

namespace {

struct RecordHead {
  std::uint64_t checksum = 0;  // of all that follows
  std::uint64_t pixels = 0;
  std::uint64_t tile = 0;
};

static_assert(std::is_trivially_copyable_v<PixelSums>, "tiles are kept as this machine holds them");

std::string record_of(std::uint32_t tile, const std::vector<PixelSums>& sums) {
  RecordHead head;
  head.pixels = sums.size(), head.tile = tile;
  std::string bytes(sizeof head + sums.size() * sizeof(PixelSums), 0);
  std::memcpy(bytes.data() + sizeof head, sums.data(), sums.size() * sizeof(PixelSums));
  std::memcpy(bytes.data(), &head, sizeof head);
  head.checksum = hash64(std::string_view(bytes).substr(sizeof head.checksum));
  std::memcpy(bytes.data(), &head, sizeof head);
  return bytes;
}

}  // namespace

TileJournal::TileJournal(const std::string& folder, const std::string& key) {
  if (folder.empty()) return;
  std::string bytes;
  try {
    make_output_folder(folder);
    path_ = folder + "/" + key + ".tiles";
    file_ = std::make_unique<AppendedFile>(path_);
    bytes = file_->read_all();
  } catch (const std::runtime_error&) {  // what cannot be kept is traced again
    file_.reset();
    return;
  }
  std::string_view rest(bytes);
  RecordHead head;
  while (rest.size() >= sizeof head) {
    std::memcpy(&head, rest.data(), sizeof head);
    if (head.pixels > (rest.size() - sizeof head) / sizeof(PixelSums)) break;
    const std::size_t size = sizeof head + std::size_t(head.pixels) * sizeof(PixelSums);
    constexpr std::size_t kSkipped = sizeof head.checksum;
    if (hash64(rest.substr(kSkipped, size - kSkipped)) != head.checksum) break;
    std::vector<PixelSums> sums(std::size_t(head.pixels));
    std::memcpy(static_cast<void*>(sums.data()), rest.data() + sizeof head, size - sizeof head);
    tiles_[std::uint32_t(head.tile)] = std::move(sums);
    rest.remove_prefix(size);
  }
  // What a kill cut off must not stand before the records to come.
  if (!rest.empty()) file_->cut(bytes.size() - rest.size());
}

const std::vector<PixelSums>* TileJournal::find(std::uint32_t tile, std::size_t pixels) const {
  const auto found = tiles_.find(tile);
  return found != tiles_.end() && found->second.size() == pixels ? &found->second : nullptr;
}

void TileJournal::note(std::uint32_t tile, const std::vector<PixelSums>& sums) {
  if (!file_) return;
  const std::string record = record_of(tile, sums);
  const std::lock_guard<std::mutex> lock(mutex_);
  try {
    file_->append(record);
  } catch (const RunError&) {
  }
}

void TileJournal::remove() {
  if (!file_) return;
  file_.reset();
  remove_output_file(path_);
}

}  // namespace rubble
