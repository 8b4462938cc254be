#include "kernel/world/world_snapshot.h"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <string>
#include <utility>

#include "kernel/base/error.h"
#include "kernel/model/pile_hash.h"
#include "kernel/world/world_impl.h"
#include "kernel/world/world_serialization.h"

namespace rubble {
namespace {

#if !defined(__BYTE_ORDER__) || __BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__
#error "numbers are copied as they lie in memory: this needs a little-endian machine"
#endif

[[noreturn]] void refuse_snapshot(const std::string& message, const std::string& hint = "") {
  Diagnostic diagnostic;
  diagnostic.message = "the state of the world " + message;
  diagnostic.hint = hint;
  throw InputError(diagnostic);
}

// Structs of numbers of one kind, without padding.
template <typename T>
constexpr bool kIsPlain =
    std::is_arithmetic_v<T> || std::is_same_v<T, Mobility> || std::is_same_v<T, Quat> ||
    std::is_same_v<T, Vec3> || std::is_same_v<T, Vec3f> ||
    std::is_same_v<T, Mat3> || std::is_same_v<T, Mat3f> || std::is_same_v<T, Pose> ||
    std::is_same_v<T, Aabb>;
static_assert(sizeof(Pose) == 7 * sizeof(double) && sizeof(Aabb) == 6 * sizeof(double) &&
              sizeof(Mat3f) == 9 * sizeof(float));

using PairMap = decltype(WorldData::contact_of_pair);

class Encoder {
 public:
  template <typename T>
  void operator()(const T& value) {
    if constexpr (std::is_same_v<T, const Shape*>) {
      // Follows from the type; set when the snapshot is restored.
    } else if constexpr (kIsPlain<T>) {
      const auto* raw = reinterpret_cast<const std::uint8_t*>(&value);
      bytes.insert(bytes.end(), raw, raw + sizeof value);
    } else {
      each_field(value, *this);
    }
  }
  template <typename T, std::size_t count>
  void operator()(const T (&values)[count]) {
    for (const T& value : values) (*this)(value);
  }
  template <typename T>
  void operator()(const std::vector<T>& values) {
    (*this)(std::uint64_t(values.size()));
    for (const T& value : values) (*this)(value);
  }
  void operator()(const PairMap& map) {
    std::vector<std::pair<std::uint64_t, std::int32_t>> sorted(map.begin(), map.end());
    std::sort(sorted.begin(), sorted.end());
    (*this)(std::uint64_t(sorted.size()));
    for (const auto& [pair, contact] : sorted) (*this)(pair), (*this)(contact);
  }

  std::vector<std::uint8_t> bytes;
};

class Decoder {
 public:
  explicit Decoder(const std::vector<std::uint8_t>& bytes)
      : next_(bytes.data()), left_(bytes.size()) {}

  template <typename T>
  void operator()(T& value) {
    if constexpr (std::is_same_v<T, const Shape*>) {
      value = nullptr;
    } else if constexpr (std::is_same_v<T, bool>) {
      std::uint8_t byte = 0;
      (*this)(byte);
      if (byte > 1) refuse_snapshot("holds a truth value that is neither 0 nor 1");
      value = byte != 0;
    } else if constexpr (kIsPlain<T>) {
      if (left_ < sizeof value) refuse_snapshot("ends too early");
      std::memcpy(static_cast<void*>(&value), next_, sizeof value);
      next_ += sizeof value;
      left_ -= sizeof value;
    } else {
      each_field(value, *this);
    }
  }
  template <typename T, std::size_t count>
  void operator()(T (&values)[count]) {
    for (T& value : values) (*this)(value);
  }
  // Element by element: a wrong count meets the end of the bytes before it fills the memory.
  template <typename T>
  void operator()(std::vector<T>& values) {
    const std::uint64_t size = count();
    values.clear();
    for (std::uint64_t i = 0; i < size; ++i) {
      values.emplace_back();
      (*this)(values.back());
    }
  }
  void operator()(PairMap& map) {
    const std::uint64_t size = count();
    for (std::uint64_t i = 0; i < size; ++i) {
      std::uint64_t pair = 0;
      (*this)(pair);
      (*this)(map[pair]);
    }
  }

  std::size_t left() const { return left_; }

 private:
  std::uint64_t count() {
    std::uint64_t size = 0;
    (*this)(size);
    if (size > left_) refuse_snapshot("ends too early");
    return size;
  }

  const std::uint8_t* next_;
  std::size_t left_;
};

bool in_range(std::int64_t index, std::size_t size) {
  return index >= 0 && index < std::int64_t(size);
}

bool is_surface_pair(const Pair& pair, std::size_t bodies) {
  return is_surface_collider(pair.collider_b) && in_range(pair.body_b, bodies) &&
         surface_collider(pair.body_b, surface_slot(pair.collider_b)) == pair.collider_b;
}

bool is_consistent(const Tree& tree, const TreeState& state, std::size_t bodies) {
  bool fine = state.q.size() == std::size_t(tree.q_count) &&
              state.u.size() == std::size_t(tree.u_count) && tree.links.size() <= kMaxLinks;
  std::int32_t q = 0, u = 0;
  for (std::size_t i = 0; fine && i < tree.links.size(); ++i) {
    const TreeLink& link = tree.links[i];
    fine = in_range(link.body, bodies) && link.wrinkles_with < std::int32_t(tree.links.size()) && in_range(std::int32_t(link.mobility), kMobilities) &&
           link.first_q == q && link.first_u == u &&
           (i == 0 ? link.parent == -1 && link.mobility <= Mobility::fixed
                   : in_range(link.parent, i) && link.mobility > Mobility::fixed);
    q += coordinate_count(link.mobility);
    u += speed_count(link.mobility);
  }
  for (const TreeLoop& loop : tree.loops) {
    fine = fine && in_range(loop.link_a, tree.links.size()) &&
           in_range(loop.link_b, tree.links.size()) &&
           in_range(std::int32_t(loop.mobility), kMobilities);
  }
  return fine && q == tree.q_count && u == tree.u_count;
}

// That the indices between the lists fit. Bytes that were written on purpose to mislead can still
// do harm; those that a disk or a hand changed do not get past the checksum of their file.
bool is_consistent(const World::Snapshot& s) {
  const WorldData& d = s.data;
  bool fine = d.wake_next.size() == d.bodies.size() && d.pairs.size() == d.contacts.size() &&
              d.contact_of_pair.size() == d.contacts.size();
  for (const Body& b : d.bodies) {
    fine = fine && b.type >= 0 && (b.free_index == -1 || in_range(b.free_index, s.free.size())) &&
           b.collider_count >= 0 && b.first_collider >= 0 &&
           std::int64_t(b.first_collider) + b.collider_count <= std::int64_t(d.colliders.size());
  }
  for (const Collider& c : d.colliders) {
    fine = fine && in_range(c.body, d.bodies.size()) && in_range(c.piece, d.bodies.size()) && c.part >= 0 && c.first_corner >= 0;
  }
  for (const Pair& p : d.pairs) {
    const bool ground = p.collider_b == kGround && p.body_b == kGround;
    fine = fine && in_range(p.collider_a, d.colliders.size()) &&
           in_range(p.body_a, d.bodies.size()) &&
           (ground || is_surface_pair(p, d.bodies.size()) ||
            (in_range(p.collider_b, d.colliders.size()) && in_range(p.body_b, d.bodies.size())));
  }
  for (const Contact& c : d.contacts) {
    fine = fine && in_range(c.body_a, d.bodies.size()) &&
           (c.body_b == kGround || in_range(c.body_b, d.bodies.size())) && c.count >= 0 &&
           c.count <= Contact::kMaxPoints && (c.count == 0 || c.points.made()) &&
           c.cache.size <= 3;
  }
  for (const auto& entry : d.contact_of_pair) {
    fine = fine && in_range(entry.second, d.contacts.size());
  }
  fine = fine && d.trees.size() == s.tree_states.size();
  for (std::size_t i = 0; fine && i < d.trees.size(); ++i) {
    fine = is_consistent(d.trees[i], s.tree_states[i], d.bodies.size());
  }
  for (const Body& b : d.bodies) {
    fine = fine && (b.tree == -1 || (in_range(b.tree, d.trees.size()) &&
                                     in_range(b.link, d.trees[b.tree].links.size())));
  }
  for (const Body& b : d.bodies) {
    fine = fine && (b.lead == -1 || in_range(b.lead, d.bodies.size())) &&
           (b.group == -1 || (in_range(b.group, d.groups.size()) && !d.groups[b.group].members.empty()));
  }
  for (const RigidGroup& g : d.groups) {
    for (const std::int32_t member : g.members) fine = fine && in_range(member, d.bodies.size());
  }
  for (const Tie& tie : d.ties) {
    const auto is_body = [&](std::int32_t body) { return body == kGround || in_range(body, d.bodies.size()); };
    fine = fine && in_range(tie.state.piece_a, d.bodies.size()) && is_body(tie.state.piece_b) &&
           is_body(tie.contact.body_a) && is_body(tie.contact.body_b) && tie.contact.count <= 1 &&
           (tie.contact.count == 0 || tie.contact.points.made());
  }
  std::int32_t start = 0;
  for (const std::int32_t next : s.block_starts) {
    fine = fine && next >= start && next <= std::int32_t(s.free.size());
    start = next;
  }
  return fine;
}

// How many types the world of a snapshot had, of those that the world has now. Each robot and surface that was added later
// has pieces of types of its own, so those of the snapshot end with the last one that a piece of it has.
std::size_t count_types(const WorldData& data, const WorldTypes& types) {
  if (data.robots.size() >= types.robots.size()) return types.pieces.size();
  std::size_t count = std::size_t(types.placeable);
  for (const Body& body : data.bodies) count = std::max(count, std::size_t(body.type) + 1);
  return std::min(count, types.pieces.size());
}

}  // namespace

std::vector<std::uint8_t> encode_snapshot(const World::Snapshot& snapshot) {
  Encoder encoder;
  encoder(kWorldSnapshotVersion);
  encoder(snapshot);
  return std::move(encoder.bytes);
}

std::shared_ptr<const World::Snapshot> decode_snapshot(const std::vector<std::uint8_t>& bytes) {
  Decoder decoder(bytes);
  std::uint32_t version = 0;
  decoder(version);
  if (version != kWorldSnapshotVersion) {
    refuse_snapshot("has format version " + std::to_string(version) + "; this program reads version " +
               std::to_string(kWorldSnapshotVersion),
           "settle the pile again, or use the program that wrote it");
  }
  auto snapshot = std::make_shared<World::Snapshot>();
  decoder(*snapshot);
  if (decoder.left() != 0) refuse_snapshot("is longer than it says");
  if (!is_consistent(*snapshot)) refuse_snapshot("refers to pieces or contacts that it does not hold");
  return snapshot;
}

std::shared_ptr<const World::Snapshot> World::snapshot() const {
  const Impl& w = *impl_;
  auto snapshot = std::make_shared<Snapshot>();
  snapshot->types = hash_types(w.types.pieces, w.types.assemblies);
  snapshot->data = w.data;
  snapshot->free.resize(std::size_t(w.blocks.size()));
  for (const Body& body : w.data.bodies) {
    if (body.free_index < 0) continue;
    snapshot->free[body.free_index] = {body.mass, body.inertia, w.blocks.world_from_com(body.free_index),
                                      w.blocks.linear_velocity(body.free_index),
                                      w.blocks.angular_velocity(body.free_index)};
  }
  for (int block = 0; block < w.blocks.block_count(); ++block) {
    snapshot->block_starts.push_back(w.blocks.first_of(block));
  }
  for (int i = 0; i < w.simbody_trees.size(); ++i) {
    snapshot->tree_states.push_back(w.simbody_trees.state(i));
  }
  return snapshot;
}

void World::restore(const Snapshot& snapshot) {
  Impl& w = *impl_;
  std::vector<PieceType>& types = w.types.pieces;
  const auto end = types.begin() + std::ptrdiff_t(count_types(snapshot.data, w.types));
  std::vector<PieceType> later(std::make_move_iterator(end), std::make_move_iterator(types.end()));
  types.erase(end, types.end());
  if (snapshot.types != hash_types(types, w.types.assemblies)) {
    std::move(later.begin(), later.end(), std::back_inserter(types));
    throw RunError("a snapshot can only be restored into a world with the same types of pieces");
  }
  w.data = snapshot.data;
  if (!later.empty()) {
    w.types.shapes.resize(types.size());
    w.types.robots.resize(w.data.robots.size());
    w.types.grown_robots.resize(w.data.robots.size());
  }
  for (Body& body : w.data.bodies) body.shape = &w.types.shapes[body.type];
  w.pairs.list_surfaces();
  w.simbody_trees = SimbodyTrees();
  for (std::size_t i = 0; i < w.data.trees.size(); ++i) {
    w.simbody_trees.add(w.data.trees[i], w.data.bodies, snapshot.tree_states[i]);
  }
  w.blocks = FreeBodies();
  const std::vector<std::int32_t>& starts = snapshot.block_starts;
  for (std::size_t block = 0; block < starts.size(); ++block) {
    const auto first = snapshot.free.begin() + starts[block];
    const auto last = block + 1 < starts.size() ? snapshot.free.begin() + starts[block + 1]
                                                : snapshot.free.end();
    w.blocks.add({first, last});
  }
}

}  // namespace rubble
