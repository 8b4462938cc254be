// A bumper: whether links of a robot press against anything that is not the robot.
//
// The force is the largest sum of normal forces in any step since the reading before, so that no blow between two readings
// is missed.
#include "io/ros/ros_messages.h"
#include "scripting/sensors/sensor_kind.h"

namespace rubble {
namespace {

struct BumperFigures {
  std::vector<std::string> links;
  double threshold = 1;
};

class BumperMeter : public SensorMeter {
 public:
  BumperMeter(const SensorSite& site, const BumperFigures& figures) : site_(site), figures_(figures) {}
  std::vector<double> read(double t) override {
    const double force = site_.contact_force(figures_.links, last_, t);
    last_ = t;
    return {force >= figures_.threshold ? 1.0 : 0.0, force};
  }

 private:
  const SensorSite& site_;
  BumperFigures figures_;
  double last_ = -1;  // before the first step
};

class Bumper : public SensorKind {
 public:
  std::string key() const override { return "bumpers"; }
  std::string title() const override { return "bumper"; }
  std::string example() const override { return "bow"; }
  std::string doc() const override {
    return "Bumpers of robots: whether links press against pieces, ground or other robots, and the largest force since the "
           "reading before.";
  }
  double usual_rate_hz() const override { return 50; }
  bool on_robots_only() const override { return true; }
  bool feels_contacts() const override { return true; }
  std::vector<std::string> links() const override { return f_.links; }
  std::unique_ptr<SensorKind> clone() const override { return std::make_unique<Bumper>(*this); }

  void add_keys(Schema& k) override {
    k.value("links", f_.links, "Links that it feels; not given: the link of `ride`.");
    k.value("threshold", f_.threshold, "Normal force at which it is pressed.").above(0, 1e5).unit("N");
  }
  std::unique_ptr<SensorMeter> start(const SensorSite& site, std::optional<std::uint64_t>, double) const override {
    return std::make_unique<BumperMeter>(site, f_);
  }

  std::vector<ReadingColumn> columns() const override { return {{"pressed", ""}, {"force", "N"}}; }
  std::vector<Topic> topics() const override { return {{"", &ros::kBool}, {"/wrench", &ros::kWrenchStamped}}; }
  // The wrench has the size of the force along X, which is all that is known.
  std::string message(std::size_t topic, ros::Version version, const ros::Header& header, const Reading& reading) const override {
    if (topic == 0) return ros::boolean(version, reading.values[0] != 0);
    return ros::wrench_stamped(version, header, {-reading.values[1], 0, 0}, {});
  }

 private:
  BumperFigures f_;
};

}  // namespace

std::unique_ptr<SensorKind> make_bumper() { return std::make_unique<Bumper>(); }

}  // namespace rubble
