#include "io/state/track_file.h"

#include "io/base/little_endian.h"
#include "io/base/sealed_file.h"

namespace rubble {
namespace {

constexpr SealedKind kTrackKind{"RUBTRCK\n", kTrackVersion, "track",
                           "a track is the track.bin of a run that records what moves",
                           "run the mission again, or use the program that wrote it"};
constexpr std::size_t kBodySize = 4 + 3 * 8 + 4 + 8;         // without its keys; unit: byte
constexpr std::size_t kKeySize = 4 + 7 * 8 + 6 * 4;          // unit: byte

template <typename T>
void put_vector(std::string& bytes, const Vec3T<T>& v) {
  for (int i = 0; i < 3; ++i) put(bytes, v[i]);
}

void put_key(std::string& bytes, const TrackKey& key) {
  put(bytes, key.sample);
  const Quat& q = key.world_from_body.rotation;
  for (const double c : {q.w, q.x, q.y, q.z}) put(bytes, c);
  put_vector(bytes, key.world_from_body.translation);
  put_vector(bytes, key.linear_velocity);
  put_vector(bytes, key.angular_velocity);
}

std::string make_content(const Track& track) {
  std::string bytes;
  put(bytes, std::uint64_t(track.times.size()));
  for (const double time : track.times) put(bytes, time);
  put(bytes, std::uint64_t(track.bodies.size()));
  for (const TrackBody& body : track.bodies) {
    put(bytes, body.id);
    put_vector(bytes, body.centre);
    put(bytes, body.gone);
    put(bytes, std::uint64_t(body.keys.size()));
    for (const TrackKey& key : body.keys) put_key(bytes, key);
  }
  return bytes;
}

// A count that the rest of the file can hold, so that no list is larger than the file.
std::uint64_t read_count(SealedReader& reader, std::size_t size_of_each, const char* what) {
  const auto count = reader.number<std::uint64_t>();
  if (count > reader.left() / size_of_each)
    reader.fail(std::string("the track does not hold as many ") + what + " as it says");
  return count;
}

Vec3f read_single(SealedReader& reader) {
  Vec3f v;
  for (int i = 0; i < 3; ++i) v[i] = reader.number<float>();
  return v;
}

TrackKey read_key(SealedReader& reader) {
  TrackKey key;
  key.sample = reader.number<std::uint32_t>();
  Quat& q = key.world_from_body.rotation;
  for (double* c : {&q.w, &q.x, &q.y, &q.z}) *c = reader.number<double>();
  key.world_from_body.translation = reader.vector();
  key.linear_velocity = read_single(reader);
  key.angular_velocity = read_single(reader);
  return key;
}

TrackBody read_body(SealedReader& reader) {
  TrackBody body;
  body.id = reader.number<std::int32_t>();
  body.centre = reader.vector();
  body.gone = reader.number<std::uint32_t>();
  const std::uint64_t keys = read_count(reader, kKeySize, "keys");
  body.keys.reserve(keys);
  for (std::uint64_t i = 0; i < keys; ++i) body.keys.push_back(read_key(reader));
  return body;
}

}  // namespace

void save_track(const Track& track, const std::string& path) {
  save_sealed(kTrackKind, make_content(track), path);
}

Track load_track(const std::string& path) {
  const std::string content = load_sealed(kTrackKind, path);
  SealedReader reader(kTrackKind, content, path);
  Track track;
  const std::uint64_t samples = read_count(reader, sizeof(double), "samples");
  track.times.reserve(samples);
  for (std::uint64_t i = 0; i < samples; ++i) track.times.push_back(reader.number<double>());
  const std::uint64_t bodies = read_count(reader, kBodySize, "bodies");
  track.bodies.reserve(bodies);
  for (std::uint64_t i = 0; i < bodies; ++i) track.bodies.push_back(read_body(reader));
  if (reader.left() != 0) reader.fail("the track is longer than it says");
  if (const std::string fault = track.find_fault(); !fault.empty()) reader.fail(fault);
  return track;
}

}  // namespace rubble
