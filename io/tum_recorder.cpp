#include "io/tum_recorder.h"

#include <charconv>

#include "io/atomic_file.h"
#include "io/frame_order.h"

namespace rubble {
namespace {

// to_chars rather than printf: the user's locale must not turn the point into a comma.
void put_decimal(std::string& line, double value) {
  char text[64];
  const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, 9).ptr;
  line += ' ';
  line.append(text, end);
}

std::string stamp_text(std::int64_t stamp_ns) {
  constexpr std::int64_t kSecond = 1000000000;
  const std::string digits = std::to_string(kSecond + stamp_ns % kSecond);  // a 1 in front
  return std::to_string(stamp_ns / kSecond) + "." + digits.substr(1);
}

class TumTrajectoryRecorder : public Recorder {
 public:
  explicit TumTrajectoryRecorder(const std::string& path) : file_(path), order_(path) {
    file_.write("# ground truth trajectory of the optical frame\n");
    file_.write("# timestamp tx ty tz qx qy qz qw\n");
  }

  void write(const Frame& frame) override {
    order_.check(frame);
    const Pose pose = frame.world_from_camera * camera_from_optical;
    const Vec3& t = pose.translation;
    const Quat& q = pose.rotation;
    std::string line = stamp_text(frame.stamp_ns);
    for (const double value : {t.x, t.y, t.z, q.x, q.y, q.z, q.w}) put_decimal(line, value);
    file_.write(line + "\n");
  }

  void finish() override { file_.commit(); }

 private:
  AtomicFile file_;
  FrameOrder order_;
};

}  // namespace

std::unique_ptr<Recorder> make_tum_trajectory_recorder(const std::string& path) {
  return std::make_unique<TumTrajectoryRecorder>(path);
}

}  // namespace rubble
