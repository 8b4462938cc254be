#include "tests/determinism/trace.h"

#include <cstdio>
#include <cstring>

#include "kernel/base/error.h"
#include "kernel/base/hash.h"

namespace rubble::determinism {
namespace {

constexpr char kFormat[] = "rubble trace 1\n";
constexpr std::size_t kFormatSize = sizeof kFormat - 1;
constexpr const char* kFields[13] = {
    "rotation.w",        "rotation.x",        "rotation.y",         "rotation.z",
    "position.x",        "position.y",        "position.z",         "linear velocity.x",
    "linear velocity.y", "linear velocity.z", "angular velocity.x", "angular velocity.y",
    "angular velocity.z"};

template <typename T>
void put(std::ofstream& file, const T& value) {
  file.write(reinterpret_cast<const char*>(&value), sizeof value);
}

// Reads a trace step by step.
class TraceReader {
 public:
  explicit TraceReader(const std::string& path) : path_(path), file_(path, std::ios::binary) {
    char format[kFormatSize] = {};
    if (!file_.read(format, kFormatSize) || std::memcmp(format, kFormat, kFormatSize) != 0) {
      throw RunError(path + ": not a trace of hash_probe");
    }
  }

  // False at the end of the file.
  bool next() {
    if (file_.peek() == std::ifstream::traits_type::eof()) return false;
    std::string name(get<std::uint32_t>() & 0xff, ' ');
    if (!file_.read(name.data(), std::streamsize(name.size()))) fail();
    if (name != scene) bodies.clear();
    scene = name;
    step = get<std::int64_t>();
    bodies.resize(get<std::uint32_t>());
    for (std::uint32_t left = get<std::uint32_t>(); left > 0; --left) {
      const auto body = get<std::uint32_t>();
      if (body >= bodies.size()) fail();
      bodies[body] = get<BodyBits>();
    }
    return true;
  }

  std::string scene;
  std::int64_t step = 0;
  std::vector<BodyBits> bodies;

 private:
  template <typename T>
  T get() {
    T value{};
    if (!file_.read(reinterpret_cast<char*>(&value), sizeof value)) fail();
    return value;
  }
  [[noreturn]] void fail() const { throw RunError(path_ + ": the trace is damaged or cut short"); }

  std::string path_;
  std::ifstream file_;
};

std::string show(std::uint64_t bits) {
  double value;
  std::memcpy(&value, &bits, sizeof value);
  char text[80];
  std::snprintf(text, sizeof text, "%.17g (%a)", value, value);
  return text;
}

std::string describe_step(const TraceReader& a, const TraceReader& b) {
  const std::string where = "scene " + a.scene + ", step " + std::to_string(a.step) + ", ";
  if (a.bodies.size() != b.bodies.size()) {
    return where + std::to_string(a.bodies.size()) + " bodies against " +
           std::to_string(b.bodies.size());
  }
  std::string first;
  int count = 0;
  for (std::size_t i = 0; i < a.bodies.size(); ++i) {
    if (a.bodies[i] == b.bodies[i]) continue;
    if (count++ > 0) continue;
    std::size_t field = 0;
    while (a.bodies[i][field] == b.bodies[i][field]) ++field;
    first = where + "body " + std::to_string(i) + ", " + kFields[field] + ": " +
            show(a.bodies[i][field]) + " against " + show(b.bodies[i][field]);
  }
  if (count == 0) return {};
  return first + "; bodies that differ in this step: " + std::to_string(count);
}

}  // namespace

BodyBits bits_of(const PieceState& piece) {
  const Quat& q = piece.world_from_body.rotation;
  const Vec3 &p = piece.world_from_body.translation, &v = piece.linear_velocity,
             &w = piece.angular_velocity;
  const double values[13] = {q.w, q.x, q.y, q.z, p.x, p.y, p.z, v.x, v.y, v.z, w.x, w.y, w.z};
  BodyBits bits;
  std::memcpy(bits.data(), values, sizeof values);
  return bits;
}

TraceWriter::TraceWriter(const std::string& path) : path_(path), file_(path, std::ios::binary) {
  if (!file_) throw RunError(path + ": cannot be written");
  file_.write(kFormat, kFormatSize);
}

void TraceWriter::begin_scene(const std::string& name) {
  scene_ = name;
  last_.clear();
}

void TraceWriter::add(const World& world) {
  std::vector<std::uint32_t> changed;
  const std::size_t known = last_.size();
  last_.resize(std::size_t(world.size()));
  for (std::size_t i = 0; i < last_.size(); ++i) {
    const BodyBits bits = bits_of(world.piece(int(i)));
    if (i < known && bits == last_[i]) continue;
    last_[i] = bits;
    changed.push_back(std::uint32_t(i));
  }
  put(file_, std::uint32_t(scene_.size()));
  file_.write(scene_.data(), std::streamsize(scene_.size()));
  put(file_, world.steps());
  put(file_, std::uint32_t(last_.size()));
  put(file_, std::uint32_t(changed.size()));
  for (std::uint32_t body : changed) put(file_, body), put(file_, last_[body]);
}

void TraceWriter::finish() {
  file_.close();
  if (!file_) throw RunError(path_ + ": writing failed");
}

std::string compare_traces(const std::string& path_a, const std::string& path_b) {
  TraceReader a(path_a), b(path_b);
  for (;;) {
    const bool more_a = a.next(), more_b = b.next();
    if (!more_a && !more_b) return {};
    if (more_a != more_b || a.scene != b.scene || a.step != b.step) {
      const auto place = [](bool more, const TraceReader& r) {
        return more ? "scene " + r.scene + ", step " + std::to_string(r.step) : "the end";
      };
      return "the runs part: " + place(more_a, a) + " against " + place(more_b, b);
    }
    const std::string difference = describe_step(a, b);
    if (!difference.empty()) return difference;
  }
}

}  // namespace rubble::determinism
