#include "bench/workload_file.h"

#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string_view>

#include "kernel/base/error.h"
#include "kernel/base/number_text.h"
#include "kernel/base/random.h"

namespace rubble {
namespace {

constexpr int kMostShapes = 100000;
constexpr int kMostCorners = 100000;
constexpr int kMostPieces = 1000000;
constexpr int kMostRows = 2000;

// Hands out the words of the text and knows the line they stand in.
class WordReader {
 public:
  WordReader(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  bool at_end() {
    skip_blanks();
    return next_ == text_.size();
  }

  std::string_view word(const char* expected) {
    if (at_end()) fail("ends too early", expected, "the end of the file");
    const std::size_t begin = next_;
    while (next_ < text_.size() && !is_blank(text_[next_])) ++next_;
    return text_.substr(begin, next_ - begin);
  }

  void keyword(const char* expected) {
    const std::string_view found = word(expected);
    if (found != expected) fail("wrong record", expected, quoted(found));
  }

  template <typename T>
  T number(const char* expected) {
    const std::string_view found = word(expected);
    T value{};
    const auto [end, error] = std::from_chars(found.data(), found.data() + found.size(), value);
    if (error != std::errc() || end != found.data() + found.size()) {
      fail("not a number", expected, quoted(found));
    }
    return value;
  }

  double real(const char* expected) {
    const double value = number<double>(expected);
    if (!std::isfinite(value)) fail("not finite", expected, plain_text(value));
    return value;
  }

  int integer(const char* expected, int low, int high) {
    const auto value = number<long long>(expected);
    if (value < low || value > high) fail("out of range", expected, std::to_string(value));
    return int(value);
  }

  static std::string quoted(std::string_view word) { return '"' + std::string(word) + '"'; }

  [[noreturn]] void fail(const char* message, const std::string& expected,
                         const std::string& found) const {
    Diagnostic d;
    d.file = name_;
    d.line = line_;
    d.message = message;
    d.expected = expected;
    d.found = found;
    d.hint = "the format is described in bench/workloads/README.md";
    throw InputError(d);
  }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }
  void skip_blanks() {
    for (; next_ < text_.size() && is_blank(text_[next_]); ++next_) line_ += text_[next_] == '\n';
  }

  std::string_view text_;
  const std::string& name_;
  std::size_t next_ = 0;
  int line_ = 1;
};

Vec3 read_vector(WordReader& reader, const char* expected) {
  const double x = reader.real(expected);
  const double y = reader.real(expected);
  return {x, y, reader.real(expected)};
}

PieceType read_shape(WordReader& reader) {
  PieceType type;
  reader.keyword("shape");
  type.name = reader.word("the name of a shape");
  type.density = kWorkloadDensity;
  type.friction = kWorkloadFriction;
  const int corners = reader.integer("a number of corners from 4 to 100000", 4, kMostCorners);
  ConvexPart part;
  for (int i = 0; i < corners; ++i) {
    part.points.push_back(read_vector(reader, "a coordinate of a corner"));
  }
  type.parts.push_back(std::move(part));
  return type;
}

// Heights over a grid whose middle is the origin, in rows along X from the lowest Y; each cell is two triangles.
PieceType read_terrain(WordReader& reader) {
  const int columns = reader.integer("a number of columns from 2 to 2000", 2, kMostRows);
  const int rows = reader.integer("a number of rows from 2 to 2000", 2, kMostRows);
  const double cell = reader.real("the side of a cell");
  if (cell <= 0) reader.fail("out of range", "a side above 0", std::to_string(cell));
  auto mesh = std::make_shared<TriangleMesh>();
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x)
      mesh->positions.push_back(Vec3f(Vec3{cell * (x - 0.5 * (columns - 1)), cell * (y - 0.5 * (rows - 1)), reader.real("a height")}));
  const auto corner = [&](int x, int y) { return std::uint32_t(y * columns + x); };
  for (int y = 0; y + 1 < rows; ++y)
    for (int x = 0; x + 1 < columns; ++x) {
      mesh->triangles.push_back({corner(x, y), corner(x + 1, y), corner(x, y + 1)});
      mesh->triangles.push_back({corner(x + 1, y), corner(x + 1, y + 1), corner(x, y + 1)});
    }
  PieceType type;
  type.name = "terrain";
  type.density = kWorkloadDensity;
  type.friction = kWorkloadFriction;
  type.surface = std::move(mesh);
  return type;
}

Placement read_piece(WordReader& reader, int shapes) {
  Placement piece;
  const std::string which = "the index of a shape, 0 to " + std::to_string(shapes - 1);
  piece.kind = reader.integer(which.c_str(), 0, shapes - 1);
  piece.scale = reader.real("a scale");
  if (piece.scale <= 0) {
    reader.fail("out of range", "a scale above 0", plain_text(piece.scale));
  }
  piece.world_from_body.translation = read_vector(reader, "a position");
  Quat& q = piece.world_from_body.rotation;
  for (double* part : {&q.w, &q.x, &q.y, &q.z}) *part = reader.real("a part of a quaternion");
  const double square = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
  if (std::abs(square - 1) > 1e-6) {
    reader.fail("not a rotation", "a quaternion of length 1",
                "the length " + brief_text(std::sqrt(square)));
  }
  q = normalized(q);
  return piece;
}

}  // namespace

Pile parse_workload(const std::string& text, const std::string& name) {
  WordReader reader(text, name);
  Pile pile;
  reader.keyword("shapes");
  const int shapes = reader.integer("a number of shapes from 1 to 100000", 1, kMostShapes);
  for (int i = 0; i < shapes; ++i) pile.types.push_back(read_shape(reader));
  while (!reader.at_end()) {
    const std::string_view record = reader.word("layer");
    if (record == "terrain" && pile.layers.empty() && pile.placed.empty()) {
      pile.types.push_back(read_terrain(reader));
      pile.placed.push_back({PieceKind(shapes), 1, {}, true});
      continue;
    }
    if (record != "layer") reader.fail("wrong record", "layer", reader.quoted(record));
    const int count = reader.integer("a number of pieces from 0 to 1000000", 0, kMostPieces);
    Layer layer;
    for (int i = 0; i < count; ++i) layer.pieces.push_back(read_piece(reader, shapes));
    pile.layers.push_back(std::move(layer));
  }
  return pile;
}

Pile load_workload(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    Diagnostic d;
    d.file = path;
    d.message = "cannot be opened";
    d.hint = "`cmake --build FOLDER --target workloads` writes w0.txt, w1.txt and w2.txt";
    throw InputError(d);
  }
  std::ostringstream text;
  text << file.rdbuf();
  if (file.bad() || text.bad()) throw RunError(path + ": cannot be read");
  return parse_workload(text.str(), path);
}

void turn_pieces(Pile& pile, std::uint64_t seed) {
  RandomStream random(seed, "workload orientations");
  for (Layer& layer : pile.layers) {
    for (Placement& piece : layer.pieces) piece.world_from_body.rotation = random.rotation();
  }
}

}  // namespace rubble
