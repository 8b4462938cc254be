#include "io/state/fines_file.h"

#include <cmath>

#include "io/base/little_endian.h"
#include "io/base/sealed_file.h"

namespace rubble {
namespace {

constexpr SealedKind kFinesSealed{"RUBFINE\n", kFinesVersion, "list of fines",
                                  "one is the fines.bin of a run whose mission has fines",
                                  "run the mission again, or use the program that wrote it"};
constexpr std::size_t kFineSize = 2 + 2 + 4 + 10 * 4;  // unit: byte
constexpr std::size_t kLeastSheet = 2 + 4 + 4 + 4;      // likewise
constexpr std::size_t kVertexSize = 6 * 4, kTriangleSize = 3 * 4;  // likewise
constexpr float kFarthestFine = 1e6f;  // unit: m

void put_single(std::string& bytes, const Vec3f& v) {
  for (int i = 0; i < 3; ++i) put(bytes, v[i]);
}

void put_piece(std::string& bytes, const FinePiece& piece) {
  put(bytes, std::uint8_t(piece.kind)), put(bytes, piece.surface), put(bytes, piece.shape), put(bytes, piece.host);
  put_single(bytes, piece.position);
  const Quatf& q = piece.rotation;
  for (const float c : {q.w, q.x, q.y, q.z}) put(bytes, c);
  put_single(bytes, piece.half);
}

void put_sheet(std::string& bytes, const FineSheet& sheet) {
  put(bytes, std::uint8_t(sheet.kind)), put(bytes, sheet.surface), put(bytes, sheet.host);
  put(bytes, std::uint32_t(sheet.mesh.positions.size()));
  for (std::size_t i = 0; i < sheet.mesh.positions.size(); ++i)
    put_single(bytes, sheet.mesh.positions[i]), put_single(bytes, sheet.mesh.normals[i]);
  put(bytes, std::uint32_t(sheet.mesh.triangles.size()));
  for (const auto& t : sheet.mesh.triangles)
    for (const std::uint32_t corner : t) put(bytes, corner);
}

std::string make_content(const Fines& fines) {
  std::string bytes;
  put(bytes, std::uint32_t(fines.surfaces.size()));
  for (const std::string& name : fines.surfaces) put(bytes, std::uint32_t(name.size())), bytes += name;
  put(bytes, std::uint64_t(fines.pieces.size()));
  for (const FinePiece& piece : fines.pieces) put_piece(bytes, piece);
  put(bytes, std::uint64_t(fines.sheets.size()));
  for (const FineSheet& sheet : fines.sheets) put_sheet(bytes, sheet);
  return bytes;
}

class FinesReader {
 public:
  FinesReader(std::string_view content, const std::string& path, std::size_t pieces)
      : reader_(kFinesSealed, content, path), pieces_(pieces) {}

  Fines read() {
    Fines fines;
    const auto surfaces = reader_.number<std::uint32_t>();
    for (std::uint32_t i = 0; i < surfaces; ++i) fines.surfaces.push_back(reader_.text());
    surfaces_ = surfaces;
    const auto pieces = count<std::uint64_t>(kFineSize);
    fines.pieces.reserve(pieces);
    for (std::uint64_t i = 0; i < pieces; ++i) fines.pieces.push_back(read_piece());
    const auto sheets = count<std::uint64_t>(kLeastSheet);
    for (std::uint64_t i = 0; i < sheets; ++i) fines.sheets.push_back(read_sheet());
    if (reader_.left() > 0) reader_.fail("there is more in it than it says");
    return fines;
  }

 private:
  // No list is larger than what is left of the file.
  template <typename T>
  T count(std::size_t size_of_each) {
    const T n = reader_.number<T>();
    if (n > reader_.left() / size_of_each) reader_.fail("it does not hold as much as it says");
    return n;
  }

  float number() {
    const auto x = reader_.number<float>();
    if (!(std::fabs(x) < kFarthestFine)) reader_.fail("a number in it is not finite or too large");
    return x;
  }

  Vec3f vector() {
    const float x = number(), y = number(), z = number();
    return {x, y, z};
  }

  FineKind kind() {
    const auto k = reader_.number<std::uint8_t>();
    if (k >= kFineKinds) reader_.fail("something in it has no known kind");
    return FineKind(k);
  }

  std::uint8_t surface() {
    const auto s = reader_.number<std::uint8_t>();
    if (s >= surfaces_) reader_.fail("something in it has no known surface");
    return s;
  }

  std::int32_t host() {
    const auto h = reader_.number<std::int32_t>();
    if (h < -1 || (h >= 0 && std::size_t(h) >= pieces_)) reader_.fail("it lies on a piece that the pile does not have");
    return h;
  }

  FinePiece read_piece() {
    FinePiece piece;
    piece.kind = kind(), piece.surface = surface();
    piece.shape = reader_.number<std::uint16_t>();
    if (piece.shape >= kFineShapes) reader_.fail("a piece has no known shape");
    piece.host = host(), piece.position = vector();
    Quatf& q = piece.rotation;
    for (float* c : {&q.w, &q.x, &q.y, &q.z}) *c = number();
    if (std::fabs(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z - 1) > 0.01f)
      reader_.fail("a piece has no rotation of length 1");
    piece.half = vector();
    if (!(piece.half.x > 0 && piece.half.y > 0 && piece.half.z > 0)) reader_.fail("a piece has no size");
    return piece;
  }

  FineSheet read_sheet() {
    FineSheet sheet;
    sheet.kind = kind(), sheet.surface = surface(), sheet.host = host();
    const auto vertices = count<std::uint32_t>(kVertexSize);
    for (std::uint32_t i = 0; i < vertices; ++i)
      sheet.mesh.positions.push_back(vector()), sheet.mesh.normals.push_back(vector());
    const auto triangles = count<std::uint32_t>(kTriangleSize);
    if (triangles == 0) reader_.fail("a sheet has no triangles");
    for (std::uint32_t i = 0; i < triangles; ++i) {
      auto& corners = sheet.mesh.triangles.emplace_back();
      for (std::uint32_t& corner : corners) {
        corner = reader_.number<std::uint32_t>();
        if (corner >= vertices) reader_.fail("a sheet has a triangle without its corners");
      }
    }
    return sheet;
  }

  SealedReader reader_;
  std::size_t pieces_ = 0, surfaces_ = 0;
};

}  // namespace

void save_fines(const Fines& fines, const std::string& path) { save_sealed(kFinesSealed, make_content(fines), path); }

Fines load_fines(const std::string& path, std::size_t pieces) {
  const std::string content = load_sealed(kFinesSealed, path);
  return FinesReader(content, path, pieces).read();
}

}  // namespace rubble
