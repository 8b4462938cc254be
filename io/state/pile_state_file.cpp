#include "io/state/pile_state_file.h"

#include <cmath>
#include <initializer_list>

#include "io/base/little_endian.h"
#include "io/base/sealed_file.h"

namespace rubble {
namespace {

constexpr SealedKind kPileStateKind{"RUBPILE\n", kPileStateVersion, "pile state",
                           "a pile state is the pile.bin of a run",
                           "settle the pile again, or use the program that wrote it",
                           2};
constexpr std::uint32_t kWithoutBuilding = 2;  // the version of such a pile
constexpr double kFarthest = 1e6;  // of a piece from the origin; unit: m
constexpr std::size_t kPieceSize = 2 * 4 + 14 * 8 + 1;   // unit: byte
constexpr std::size_t kJointSize = 2 * 4 + 1 + 19 * 8;  // unit: byte
constexpr std::size_t kTieSize = 2 * 4 + 10 * 8;         // unit: byte
constexpr std::size_t kLoadSize = 2 * 4 + 6 * 4;         // unit: byte

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

void put_rotation(std::string& bytes, const Quat& q) {
  for (const double c : {q.w, q.x, q.y, q.z}) put(bytes, c);
}

void put_joint(std::string& bytes, const JointState& joint) {
  put(bytes, joint.parent);
  put(bytes, joint.child);
  put(bytes, static_cast<std::uint8_t>(joint.kind));
  for (const Pose* pose : {&joint.parent_from_joint, &joint.child_from_joint}) {
    put_rotation(bytes, pose->rotation);
    put_vector(bytes, pose->translation);
  }
  put(bytes, joint.rest);
  put_rotation(bytes, joint.rest_rotation);
}

void put_building(std::string& bytes, const BuildingState& building) {
  put(bytes, building.first);
  put(bytes, building.count);
  put(bytes, static_cast<std::uint32_t>(building.bodies.size()));
  for (const std::vector<std::int32_t>& body : building.bodies) {
    put(bytes, static_cast<std::uint32_t>(body.size()));
    for (const std::int32_t piece : body) put(bytes, piece);
  }
  put(bytes, static_cast<std::uint32_t>(building.ties.size()));
  for (const TieState& tie : building.ties) {
    put(bytes, tie.piece_a);
    put(bytes, tie.piece_b);
    put_vector(bytes, tie.anchor_a);
    put_vector(bytes, tie.anchor_b);
    for (const double number : {tie.length, tie.strength, tie.stretch, tie.bending}) put(bytes, number);
  }
  for (std::size_t i = 0; i < building.ties.size(); ++i) put(bytes, i < building.tie_forces.size() ? building.tie_forces[i] : 0.0F);
  put(bytes, static_cast<std::uint32_t>(building.loads.size()));
  for (const ContactLoad& load : building.loads) {
    put(bytes, load.piece);
    put(bytes, load.other);
    for (const Vec3f* v : {&load.point, &load.force})
      for (const float number : {v->x, v->y, v->z}) put(bytes, number);
  }
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
  put(bytes, static_cast<std::uint32_t>(state.joints.size()));
  for (const JointState& joint : state.joints) put_joint(bytes, joint);
  if (state.building.count > 0) put_building(bytes, state.building);
  return bytes;
}

// A number that is none would end the program in a stage that has no words for it.
void check_finite(const SealedReader& reader, std::initializer_list<double> numbers,
                  const char* what) {
  for (const double number : numbers)
    if (!std::isfinite(number)) reader.fail(std::string(what) + " has a number that is not finite");
}

void check_pose(const SealedReader& reader, const Pose& pose, const char* what) {
  const Quat& q = pose.rotation;
  const Vec3& t = pose.translation;
  check_finite(reader, {q.w, q.x, q.y, q.z, t.x, t.y, t.z}, what);
  const double length = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
  if (std::abs(length - 1) > 0.01) reader.fail(std::string(what) + " has no rotation of length 1");
}

PieceState read_piece(SealedReader& reader, std::size_t type_count) {
  PieceState p;
  p.type = reader.number<std::int32_t>();
  p.layer = reader.number<std::int32_t>();
  p.scale = reader.number<double>();
  Quat& q = p.world_from_body.rotation;
  for (double* c : {&q.w, &q.x, &q.y, &q.z}) *c = reader.number<double>();
  p.world_from_body.translation = reader.vector();
  p.linear_velocity = reader.vector();
  p.angular_velocity = reader.vector();
  const auto status = reader.number<std::uint8_t>();
  if (status > static_cast<std::uint8_t>(PieceStatus::lost)) {
    reader.fail("a piece has no known status");
  }
  p.status = static_cast<PieceStatus>(status);
  check_pose(reader, p.world_from_body, "a piece");
  for (int i = 0; i < 3; ++i)
    if (std::abs(p.world_from_body.translation[i]) > kFarthest) reader.fail("a piece is too far away");
  const Vec3 &v = p.linear_velocity, &w = p.angular_velocity;
  check_finite(reader, {p.scale, v.x, v.y, v.z, w.x, w.y, w.z}, "a piece");
  if (!(p.scale > 0 && p.scale < kFarthest)) reader.fail("a piece has no sensible scale");
  if (p.type < 0 || static_cast<std::size_t>(p.type) >= type_count) {
    reader.fail("a piece is of a type that the pile does not have");
  }
  return p;
}

Quat read_rotation(SealedReader& reader) {
  Quat q;
  for (double* c : {&q.w, &q.x, &q.y, &q.z}) *c = reader.number<double>();
  return q;
}

JointState read_joint(SealedReader& reader, std::uint64_t piece_count) {
  JointState joint;
  joint.parent = reader.number<std::int32_t>();
  joint.child = reader.number<std::int32_t>();
  const auto kind = reader.number<std::uint8_t>();
  for (Pose* pose : {&joint.parent_from_joint, &joint.child_from_joint}) {
    pose->rotation = read_rotation(reader);
    pose->translation = reader.vector();
  }
  joint.rest = reader.number<double>();
  joint.rest_rotation = read_rotation(reader);
  check_pose(reader, joint.parent_from_joint, "a joint");
  check_pose(reader, joint.child_from_joint, "a joint");
  check_pose(reader, {joint.rest_rotation, {}}, "a joint");
  check_finite(reader, {joint.rest}, "a joint");
  if (kind >= kJointKinds) reader.fail("a joint has no known kind");
  joint.kind = static_cast<JointKind>(kind);
  for (const std::int32_t piece : {joint.parent, joint.child}) {
    if (piece < 0 || std::uint64_t(piece) >= piece_count) {
      reader.fail("a joint holds a piece that the pile does not have");
    }
  }
  return joint;
}

std::vector<std::int32_t> read_body(SealedReader& reader, const BuildingState& building) {
  const auto size = reader.number<std::uint32_t>();
  if (size < 2 || size > std::uint32_t(building.count)) {
    reader.fail("what holds together of the building has " + std::to_string(size) + " pieces");
  }
  std::vector<std::int32_t> body;
  for (std::uint32_t i = 0; i < size; ++i) {
    const auto piece = reader.number<std::int32_t>();
    if (piece < building.first || piece >= building.first + building.count || (i > 0 && piece <= body.back())) {
      reader.fail("what holds together of the building has a piece that is not the building's, or in no order");
    }
    body.push_back(piece);
  }
  return body;
}

TieState read_tie(SealedReader& reader, std::uint64_t piece_count) {
  TieState tie;
  tie.piece_a = reader.number<std::int32_t>();
  tie.piece_b = reader.number<std::int32_t>();
  tie.anchor_a = reader.vector();
  tie.anchor_b = reader.vector();
  for (double* number : {&tie.length, &tie.strength, &tie.stretch, &tie.bending}) *number = reader.number<double>();
  const Vec3 &a = tie.anchor_a, &b = tie.anchor_b;
  check_finite(reader, {a.x, a.y, a.z, b.x, b.y, b.z, tie.length, tie.strength, tie.stretch, tie.bending}, "a tie");
  const bool pieces = tie.piece_a >= 0 && std::uint64_t(tie.piece_a) < piece_count && tie.piece_b >= -1 &&
                      (tie.piece_b < 0 || std::uint64_t(tie.piece_b) < piece_count) && tie.piece_a != tie.piece_b;
  if (!pieces) reader.fail("a tie holds a piece that the pile does not have");
  if (!(tie.length > 0 && tie.strength > 0 && tie.stretch >= 0 && tie.bending >= 0)) {
    reader.fail("a tie has a length, strength, stretch or moment out of range");
  }
  return tie;
}

ContactLoad read_load(SealedReader& reader, std::uint64_t piece_count) {
  ContactLoad load;
  load.piece = reader.number<std::int32_t>();
  load.other = reader.number<std::int32_t>();
  for (Vec3f* v : {&load.point, &load.force})
    for (float* number : {&v->x, &v->y, &v->z}) *number = reader.number<float>();
  const Vec3f &p = load.point, &f = load.force;
  check_finite(reader, {p.x, p.y, p.z, f.x, f.y, f.z}, "a load");
  const bool pieces = load.piece >= 0 && std::uint64_t(load.piece) < piece_count && load.other >= -1 &&
                      (load.other < 0 || std::uint64_t(load.other) < piece_count) && load.piece != load.other;
  if (!pieces) reader.fail("a load is on a piece that the pile does not have");
  return load;
}

// What contacts and ties carry: since version 4.
void read_loads(SealedReader& reader, std::uint64_t piece_count, BuildingState& building) {
  for (std::size_t i = 0; i < building.ties.size(); ++i) {
    building.tie_forces.push_back(reader.number<float>());
    check_finite(reader, {building.tie_forces.back()}, "a tie");
  }
  const auto loads = reader.number<std::uint32_t>();
  if (loads != reader.left() / kLoadSize || reader.left() % kLoadSize != 0) {
    reader.fail("the pile state does not hold as many loads as it says");
  }
  for (std::uint32_t i = 0; i < loads; ++i) building.loads.push_back(read_load(reader, piece_count));
}

BuildingState read_building(SealedReader& reader, std::uint64_t piece_count) {
  BuildingState building;
  building.first = reader.number<std::int32_t>();
  building.count = reader.number<std::int32_t>();
  if (building.first < 0 || building.count < 1 || std::uint64_t(building.first) + std::uint64_t(building.count) > piece_count) {
    reader.fail("the building has pieces that the pile does not have");
  }
  const auto bodies = reader.number<std::uint32_t>();
  std::vector<bool> seen(std::size_t(piece_count), false);
  for (std::uint32_t i = 0; i < bodies; ++i) {
    building.bodies.push_back(read_body(reader, building));
    for (const std::int32_t piece : building.bodies.back()) {
      if (seen[std::size_t(piece)]) reader.fail("a piece of the building is in two bodies");
      seen[std::size_t(piece)] = true;
    }
  }
  const auto ties = reader.number<std::uint32_t>();
  if (ties > reader.left() / kTieSize) reader.fail("the pile state does not hold as many ties as it says");
  for (std::uint32_t i = 0; i < ties; ++i) building.ties.push_back(read_tie(reader, piece_count));
  if (reader.left() > 0) read_loads(reader, piece_count, building);
  return building;
}

PileState parse_content(std::string_view content, const std::string& path) {
  SealedReader reader(kPileStateKind, content, path);
  PileState state;
  const auto types = reader.number<std::uint32_t>();
  for (std::uint32_t i = 0; i < types; ++i) state.types.push_back(reader.text());
  state.steps = reader.number<std::int64_t>();
  state.simulated = reader.number<double>();
  check_finite(reader, {state.simulated}, "the pile");
  state.settled = reader.number<std::uint8_t>() != 0;
  state.layers_at_limit = reader.number<std::int32_t>();
  state.lost = reader.number<std::int32_t>();
  const auto pieces = reader.number<std::uint64_t>();
  if (pieces > reader.left() / kPieceSize) {
    reader.fail("the pile state does not hold as many pieces as it says");
  }
  state.pieces.reserve(pieces);
  for (std::uint64_t i = 0; i < pieces; ++i) state.pieces.push_back(read_piece(reader, types));
  const auto joints = reader.number<std::uint32_t>();
  if (joints > reader.left() / kJointSize) {
    reader.fail("the pile state does not hold as many joints as it says");
  }
  for (std::uint32_t i = 0; i < joints; ++i) state.joints.push_back(read_joint(reader, pieces));
  if (reader.left() > 0) state.building = read_building(reader, pieces);
  return state;
}

}  // namespace

void save_pile_state(const PileState& state, const std::string& path) {
  SealedKind kind = kPileStateKind;
  if (state.building.count == 0) kind.version = kWithoutBuilding;
  save_sealed(kind, make_content(state), path);
}

PileState load_pile_state(const std::string& path) {
  return parse_content(load_sealed(kPileStateKind, path), path);
}

}  // namespace rubble
