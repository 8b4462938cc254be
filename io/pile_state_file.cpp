#include "io/pile_state_file.h"

#include "io/little_endian.h"
#include "io/sealed_file.h"

namespace rubble {
namespace {

constexpr SealedKind kKind{"RUBPILE\n", kPileStateVersion, "pile state",
                           "a pile state is the pile.bin of a run",
                           "settle the pile again, or use the program that wrote it"};
constexpr std::size_t kPieceSize = 2 * 4 + 14 * 8 + 1;   // unit: byte
constexpr std::size_t kJointSize = 2 * 4 + 1 + 19 * 8;  // unit: byte

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
  return bytes;
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
  if (kind >= kJointKinds) reader.fail("a joint has no known kind");
  joint.kind = static_cast<JointKind>(kind);
  for (const std::int32_t piece : {joint.parent, joint.child}) {
    if (piece < 0 || std::uint64_t(piece) >= piece_count) {
      reader.fail("a joint holds a piece that the pile does not have");
    }
  }
  return joint;
}

PileState parse_content(std::string_view content, const std::string& path) {
  SealedReader reader(kKind, content, path);
  PileState state;
  const auto types = reader.number<std::uint32_t>();
  for (std::uint32_t i = 0; i < types; ++i) state.types.push_back(reader.text());
  state.steps = reader.number<std::int64_t>();
  state.simulated = reader.number<double>();
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
  if (joints != reader.left() / kJointSize || reader.left() % kJointSize != 0) {
    reader.fail("the pile state does not hold as many joints as it says");
  }
  for (std::uint32_t i = 0; i < joints; ++i) state.joints.push_back(read_joint(reader, pieces));
  return state;
}

}  // namespace

void save_pile_state(const PileState& state, const std::string& path) {
  save_sealed(kKind, make_content(state), path);
}

PileState load_pile_state(const std::string& path) {
  return parse_content(load_sealed(kKind, path), path);
}

}  // namespace rubble
