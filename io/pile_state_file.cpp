#include "io/pile_state_file.h"

#include <string_view>

#include "io/atomic_file.h"
#include "io/little_endian.h"
#include "kernel/base/error.h"
#include "kernel/base/hash.h"

namespace rubble {
namespace {

constexpr std::string_view kMagic = "RUBPILE\n";
constexpr std::size_t kHeaderSize = 8 + 4 + 8;
constexpr std::size_t kDigestSize = 32;
constexpr std::size_t kPieceSize = 2 * 4 + 14 * 8 + 1;  // unit: byte

std::string digest_of(std::string_view bytes) {
  const std::string hex = sha256(bytes);
  const auto nibble = [](char c) { return c <= '9' ? c - '0' : c - 'a' + 10; };
  std::string digest;
  for (std::size_t i = 0; i < hex.size(); i += 2) {
    digest += static_cast<char>(nibble(hex[i]) * 16 + nibble(hex[i + 1]));
  }
  return digest;
}

void put_vector(std::string& bytes, const Vec3& v) {
  for (int i = 0; i < 3; ++i) put(bytes, v[i]);
}

void put_piece(std::string& bytes, const PieceState& piece) {
  put(bytes, piece.type);
  put(bytes, piece.layer);
  put(bytes, piece.scale);
  const Quat& q = piece.world_from_body.rotation;
  for (const double c : {q.w, q.x, q.y, q.z}) put(bytes, c);
  put_vector(bytes, piece.world_from_body.translation);
  put_vector(bytes, piece.linear_velocity);
  put_vector(bytes, piece.angular_velocity);
  put(bytes, static_cast<std::uint8_t>(piece.status));
}

std::string make_content(const PileState& state) {
  std::string bytes;
  put(bytes, static_cast<std::uint32_t>(state.types.size()));
  for (const std::string& name : state.types) {
    put(bytes, static_cast<std::uint32_t>(name.size()));
    bytes += name;
  }
  put(bytes, state.steps);
  put(bytes, state.simulated);
  put(bytes, static_cast<std::uint8_t>(state.settled));
  put(bytes, static_cast<std::int32_t>(state.layers_at_limit));
  put(bytes, static_cast<std::int32_t>(state.lost));
  put(bytes, static_cast<std::uint64_t>(state.pieces.size()));
  for (const PieceState& piece : state.pieces) put_piece(bytes, piece);
  return bytes;
}

// Reads the content; every step fails rather than reading past the end.
class Reader {
 public:
  Reader(std::string_view bytes, const std::string& path) : bytes_(bytes), path_(path) {}

  [[noreturn]] void fail(const std::string& message, const std::string& hint = "") const {
    Diagnostic diagnostic;
    diagnostic.file = path_;
    diagnostic.message = message;
    diagnostic.hint = hint;
    throw InputError(diagnostic);
  }

  template <typename T>
  T number() {
    T value{};
    if (!take(bytes_, value)) fail("the pile state ends too early");
    return value;
  }

  std::string text() {
    const auto size = number<std::uint32_t>();
    if (size > bytes_.size()) fail("the pile state ends too early");
    std::string value(bytes_.substr(0, size));
    bytes_.remove_prefix(size);
    return value;
  }

  Vec3 vector() {
    Vec3 v;
    for (int i = 0; i < 3; ++i) v[i] = number<double>();
    return v;
  }

  PieceState piece(std::size_t type_count) {
    PieceState p;
    p.type = number<std::int32_t>();
    p.layer = number<std::int32_t>();
    p.scale = number<double>();
    Quat& q = p.world_from_body.rotation;
    for (double* c : {&q.w, &q.x, &q.y, &q.z}) *c = number<double>();
    p.world_from_body.translation = vector();
    p.linear_velocity = vector();
    p.angular_velocity = vector();
    const auto status = number<std::uint8_t>();
    if (status > static_cast<std::uint8_t>(PieceStatus::lost)) fail("a piece has no known status");
    p.status = static_cast<PieceStatus>(status);
    if (p.type < 0 || static_cast<std::size_t>(p.type) >= type_count) {
      fail("a piece is of a type that the pile does not have");
    }
    return p;
  }

  std::size_t left() const { return bytes_.size(); }

 private:
  std::string_view bytes_;
  const std::string& path_;
};

PileState parse_content(std::string_view content, const std::string& path) {
  Reader reader(content, path);
  PileState state;
  const auto types = reader.number<std::uint32_t>();
  for (std::uint32_t i = 0; i < types; ++i) state.types.push_back(reader.text());
  state.steps = reader.number<std::int64_t>();
  state.simulated = reader.number<double>();
  state.settled = reader.number<std::uint8_t>() != 0;
  state.layers_at_limit = reader.number<std::int32_t>();
  state.lost = reader.number<std::int32_t>();
  const auto pieces = reader.number<std::uint64_t>();
  if (pieces != reader.left() / kPieceSize || reader.left() % kPieceSize != 0) {
    reader.fail("the pile state does not hold as many pieces as it says");
  }
  state.pieces.reserve(pieces);
  for (std::uint64_t i = 0; i < pieces; ++i) state.pieces.push_back(reader.piece(types));
  return state;
}

}  // namespace

void save_pile_state(const PileState& state, const std::string& path) {
  const std::string content = make_content(state);
  std::string bytes(kMagic);
  put(bytes, kPileStateVersion);
  put(bytes, static_cast<std::uint64_t>(content.size()));
  bytes += content;
  bytes += digest_of(bytes);
  write_text_file(path, bytes);
}

PileState load_pile_state(const std::string& path) {
  const std::string bytes = read_whole_file(path);
  Reader header(bytes, path);
  if (std::string_view(bytes).substr(0, kMagic.size()) != kMagic) {
    header.fail("is not a pile state", "a pile state is the pile.bin of a run");
  }
  if (bytes.size() < kHeaderSize + kDigestSize) header.fail("the pile state is truncated");
  header.number<std::uint64_t>();  // the magic
  const auto version = header.number<std::uint32_t>();
  if (version != kPileStateVersion) {
    header.fail("the pile state has format version " + std::to_string(version) +
                    "; this program reads version " + std::to_string(kPileStateVersion),
                "settle the pile again, or use the program that wrote it");
  }
  const auto size = header.number<std::uint64_t>();
  const std::size_t stored = bytes.size() - kHeaderSize - kDigestSize;
  if (size > stored) {
    header.fail("the pile state is truncated: " + std::to_string(size - stored) +
                " bytes are missing");
  }
  if (size < stored) header.fail("the pile state is longer than it says");
  const std::string_view all(bytes);
  if (digest_of(all.substr(0, kHeaderSize + size)) != all.substr(kHeaderSize + size)) {
    header.fail("the pile state is damaged: its content does not match its checksum");
  }
  return parse_content(all.substr(kHeaderSize, size), path);
}

}  // namespace rubble
