#include "app/planning/flight_cache.h"

namespace rubble {
namespace {

constexpr int kVersion = 2;  // raise it whenever planning or the layout below changes
constexpr std::string_view kKind = "flight";

void add(CacheKey& key, const Vec3& v) { key.add(v.x).add(v.y).add(v.z); }

void add(CacheKey& key, const Pose& pose) {
  add(key, pose.translation);
  const Quat& q = pose.rotation;
  key.add(q.w).add(q.x).add(q.y).add(q.z);
}

void add(CacheKey& key, const std::optional<double>& value) { key.add(value.has_value()).add(value.value_or(0)); }

void add(CacheKey& key, const std::optional<VoidPlace>& place) {
  key.add(place.has_value());
  if (place) key.add(place->radius).add(place->rank).add(place->order).add(place->point).add(place->distance).add(place->outside_radius);
}

void add(CacheKey& key, const TriangleMesh& mesh) {
  key.add(std::uint64_t(mesh.positions.size())).add(std::uint64_t(mesh.triangles.size()));
  for (const Vec3f& p : mesh.positions) key.add(p.x).add(p.y).add(p.z);
  key.add_bytes(mesh.triangles.data(), mesh.triangles.size() * sizeof mesh.triangles[0]);
}

void add(CacheKey& key, const TrajectorySpec& spec) {
  key.add(spec.interpolation).add(spec.plan).add(spec.radius);
  key.add(std::uint64_t(spec.waypoints.size()));
  for (const Waypoint& w : spec.waypoints) {
    add(key, w.t), add(key, w.speed), add(key, w.position), add(key, w.rpy_deg);
    key.add(w.look_at.has_value()), add(key, w.look_at.value_or(Vec3{}));
    add(key, w.position_in_void), add(key, w.look_at_in_void);
  }
}

// All that queries and free space are made of.
void add(CacheKey& key, const AssetLibrary& assets, const PileState& pile) {
  key.add(pile.state_hash());
  for (const TriangleMesh* mesh : assets.finest_meshes()) add(key, *mesh);
  for (const int type : assets.terrain()) key.add(type);
  key.add(std::uint64_t(pile.fines.heaps().size()));
  for (const FineHeap& heap : pile.fines.heaps()) key.add(heap.host), add(key, heap.mesh);
  key.add(pile.surroundings != nullptr);
  if (!pile.surroundings) return;
  for (const auto& mesh : pile.surroundings->meshes) {
    key.add(mesh->leafy);
    for (const TriangleMesh& level : mesh->levels) add(key, level);
  }
  for (const SurroundingThing& thing : pile.surroundings->things) key.add(thing.mesh).add(thing.scale), add(key, thing.world_from_mesh);
}

// A waypoint of a planned way: no place in a void is left.
struct StoredWaypoint {
  double t, speed;  // below 0: none
  Vec3 position, rpy_deg, look_at;
  std::uint64_t looks_at;  // 0 or 1
};

void put_text(CacheWriter& writer, const std::string& text) { writer.put(std::vector<char>(text.begin(), text.end())); }

std::string get_text(CacheReader& reader) {
  std::vector<char> characters;
  reader.get(characters);
  return {characters.begin(), characters.end()};
}

std::string pack(const PlannedWay& way) {
  std::vector<StoredWaypoint> stored;
  for (const Waypoint& w : way.trajectory.waypoints)
    stored.push_back({w.t.value_or(-1), w.speed.value_or(-1), w.position, w.rpy_deg, w.look_at.value_or(Vec3{}), w.look_at.has_value()});
  CacheWriter writer;
  writer.put(stored);
  writer.put(way.trajectory.interpolation);
  put_text(writer, way.report), put_text(writer, way.summary);
  return writer.bytes();
}

std::optional<PlannedWay> unpack(const std::string& bytes, const TrajectorySpec& asked) {
  CacheReader reader(bytes);
  std::vector<StoredWaypoint> stored;
  PlannedWay way{asked, {}, {}};
  reader.get(stored), reader.get(way.trajectory.interpolation);
  way.report = get_text(reader), way.summary = get_text(reader);
  if (!reader.whole() || stored.empty()) return {};
  way.trajectory.waypoints.clear();
  for (const StoredWaypoint& s : stored) {
    Waypoint w;
    if (s.t >= 0) w.t = s.t;
    if (s.speed >= 0) w.speed = s.speed;
    w.position = s.position, w.rpy_deg = s.rpy_deg;
    if (s.looks_at) w.look_at = s.look_at;
    way.trajectory.waypoints.push_back(w);
  }
  return way;
}

}  // namespace

FlightCache::FlightCache(const DiskCache& cache, const TrajectorySpec& asked, const PileSurvey& survey)
    : cache_(cache), asked_(asked) {
  if (cache.folder().empty()) return;
  CacheKey key("flight", kVersion);
  add(key, asked);
  add(key, survey.assets(), survey.pile());
  key_ = key.hex();
}

std::optional<PlannedWay> FlightCache::find() const {
  if (key_.empty()) return {};
  const std::optional<std::string> kept = cache_.find(kKind, key_);
  return kept ? unpack(*kept, asked_) : std::nullopt;
}

void FlightCache::store(const PlannedWay& way) const {
  if (!key_.empty()) cache_.store(kKind, key_, pack(way));
}

}  // namespace rubble
