#include "io/base/sealed_file.h"

#include "io/base/atomic_file.h"
#include "kernel/base/error.h"
#include "kernel/base/hash.h"

namespace rubble {
namespace {

constexpr std::size_t kHeaderSize = 8 + 4 + 8;
constexpr std::size_t kDigestSize = 32;

std::string digest_of(std::string_view bytes) {
  const std::string hex = sha256(bytes);
  const auto nibble = [](char c) { return c <= '9' ? c - '0' : c - 'a' + 10; };
  std::string digest;
  for (std::size_t i = 0; i < hex.size(); i += 2) {
    digest += static_cast<char>(nibble(hex[i]) * 16 + nibble(hex[i + 1]));
  }
  return digest;
}

}  // namespace

void SealedReader::fail(const std::string& message, std::string_view hint) const {
  Diagnostic diagnostic;
  diagnostic.file = path_;
  diagnostic.message = message;
  diagnostic.hint = hint;
  throw InputError(diagnostic);
}

void SealedReader::fail_short() const {
  fail("the " + std::string(kind_.name) + " ends too early");
}

Vec3 SealedReader::vector() {
  Vec3 v;
  for (int i = 0; i < 3; ++i) v[i] = number<double>();
  return v;
}

std::string_view SealedReader::bytes(std::uint64_t size) {
  if (size > bytes_.size()) fail_short();
  const std::string_view value = bytes_.substr(0, size);
  bytes_.remove_prefix(size);
  return value;
}

std::string SealedReader::text() { return std::string(bytes(number<std::uint32_t>())); }

void save_sealed(const SealedKind& kind, std::string_view content, const std::string& path) {
  std::string bytes(kind.magic);
  put(bytes, kind.version);
  put(bytes, static_cast<std::uint64_t>(content.size()));
  bytes += content;
  bytes += digest_of(bytes);
  write_text_file(path, bytes);
}

std::string load_sealed(const SealedKind& kind, const std::string& path) {
  const std::string bytes = read_whole_file(path);
  const std::string_view all(bytes);
  const std::string name(kind.name);
  SealedReader header(kind, all, path);
  if (all.substr(0, kind.magic.size()) != kind.magic) header.fail("is not a " + name, kind.where);
  if (all.size() < kHeaderSize + kDigestSize) header.fail("the " + name + " is truncated");
  header.bytes(kind.magic.size());
  const auto version = header.number<std::uint32_t>();
  if (version > kind.version || version < (kind.oldest > 0 ? kind.oldest : kind.version)) {
    header.fail("the " + name + " has format version " + std::to_string(version) +
                    "; this program reads version " + std::to_string(kind.version),
                kind.if_other_version);
  }
  const auto size = header.number<std::uint64_t>();
  const std::size_t stored = all.size() - kHeaderSize - kDigestSize;
  if (size > stored) {
    header.fail("the " + name + " is truncated: " + std::to_string(size - stored) +
                " bytes are missing");
  }
  if (size < stored) header.fail("the " + name + " is longer than it says");
  if (digest_of(all.substr(0, kHeaderSize + size)) != all.substr(kHeaderSize + size)) {
    header.fail("the " + name + " is damaged: its content does not match its checksum");
  }
  return std::string(all.substr(kHeaderSize, size));
}

}  // namespace rubble
