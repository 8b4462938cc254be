#include "kernel/base/hash.h"

#include <xxhash.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <vector>

#include "kernel/base/error.h"
#include "kernel/base/read_file.h"

namespace rubble {

struct StateHash::State {
  XXH64_state_t* xxh = XXH64_createState();
  ~State() { XXH64_freeState(xxh); }
};

StateHash::StateHash() : state_(std::make_unique<State>()) { XXH64_reset(state_->xxh, 0); }
StateHash::~StateHash() = default;
void StateHash::add_bytes(const void* data, std::size_t size) {
  XXH64_update(state_->xxh, data, size);
}
std::uint64_t StateHash::digest() const { return XXH64_digest(state_->xxh); }

std::uint64_t hash64(std::string_view bytes) { return XXH64(bytes.data(), bytes.size(), 0); }

std::string hex64(std::uint64_t value) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value));
  return text;
}

std::string sha256(std::string_view bytes) {
  Sha256 hash;
  hash.add(bytes.data(), bytes.size());
  return hash.hex();
}

std::string sha256_of_file(const std::string& path) {
  check_readable_file(path);
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                       &std::fclose);
  if (!file) throw RunError(path + ": cannot be read: " + std::strerror(errno));
  Sha256 hash;
  std::vector<char> buffer(1 << 20);
  while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), file.get()))
    hash.add(buffer.data(), n);
  if (std::ferror(file.get())) throw RunError(path + ": reading failed: " + std::strerror(errno));
  return hash.hex();
}

}  // namespace rubble
