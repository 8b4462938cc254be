// A kind of sensor that gives a few numbers or a scan at a fixed rate: its keys, what it measures, how a reading is written.
//
// One class in one file is a kind; RUBBLE_SENSORS of scripting/CMakeLists.txt lists the bundled ones, and
// register_sensor() adds one from outside. Missions, --set, documents, the JSON Schema, recordings, hashes, live topics,
// controllers and Python know a kind by this interface alone (docs/development/contributing.md).
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/recording/reading_format.h"
#include "kernel/base/error.h"
#include "kernel/base/math.h"
#include "kernel/base/number_text.h"
#include "scripting/schema/schema.h"

namespace rubble {

class Medium;
class RayWorld;

// What a sensor may ask of the world around it. t: since the start; unit: s
struct SensorSite {
  struct Hit {
    double distance = -1;  // unit: m; negative: nothing within the range
    double cosine = 0;     // of the angle at which the surface is met
    double reflectance = 0;  // share of near-infrared light that it throws back
  };

  // Of the sensor's frame (X forward, Y left, Z up); unit: m
  std::function<Pose(double t)> world_from_sensor;
  // What rays from the sensor's origin meet first at t, within `range` (unit: m). directions: in the world, unit length.
  std::function<std::vector<Hit>(double t, const std::vector<Vec3>& directions, double range)> cast;
  // The largest sum of the normal forces on these links of its robot (empty: on the link that carries it) in the steps
  // after `from` up to `to`; contacts with the robot itself do not count. unit: N
  std::function<double(const std::vector<std::string>& links, double from, double to)> contact_force;
  // Mechanical work that the motors of its robot gave in the steps after `from` up to `to`; what they brake is not taken
  // off. unit: J
  std::function<double(double from, double to)> motor_work;

  // For one that scans: what its rays meet, and what hangs in the air; of chance that it has without noise; threads to use.
  std::shared_ptr<RayWorld> rays;
  std::shared_ptr<const Medium> air;
  std::uint64_t seed = 0;
  int threads = 1;

  std::int64_t start_ns = 0;          // stamp of t = 0
  std::int64_t utc_s = 0;             // at t = 0; by the mission's `light.time`, else by its first stamp
  double latitude_deg = 0, longitude_deg = 0;  // of the world's origin; north and east are positive
  double north_deg = 90;              // direction of north, from X towards Y; unit: degree
};

// Measures; readings are asked for in their order, once each. A kind gives one of both: numbers, or scans.
class SensorMeter {
 public:
  virtual ~SensorMeter() = default;
  // t: since the start; unit: s. Values as ReadingFormat::columns() says.
  virtual std::vector<double> read(double) { return {}; }
  // number: from 0.
  virtual std::shared_ptr<const RangeScan> scan(int) { return nullptr; }
};

// What must be known before a reading is taken.
struct SensorTiming {
  bool lasts_a_period = false;   // it goes on from its stamp to that of the next; else it is of a moment
  std::int64_t way_ns = 1000;    // of the carrier's way, before it begins and after it ends; unit: ns
  std::int64_t scene_ns = 1000;  // of the scene, after it ends; for those that cast rays; unit: ns
};

class SensorKind : public ReadingFormat {
 public:
  // A table of the mission, whose tables are sensors of the kind by their names: "range_finders".
  virtual std::string key() const = 0;
  virtual std::string title() const = 0;    // for messages and cards: "range finder"
  virtual std::string example() const = 0;  // of a name, for documents
  virtual std::string doc() const = 0;      // what it is: whole sentences
  virtual double usual_rate_hz() const = 0;
  // Of a kind with a key `rate_hz` of its own; nothing: it has the usual one.
  virtual std::optional<double> own_rate_hz() const { return std::nullopt; }
  virtual SensorTiming timing(double /*rate_hz*/) const { return {}; }
  virtual std::string summary(double rate_hz) const { return exact_text(rate_hz) + " Hz"; }  // for cards
  // Topic of the only sensor that has it, "/points"; several: "/NAME/points". Empty: "/NAME" of each.
  virtual std::string usual_topic() const { return ""; }
  virtual bool on_robots_only() const { return false; }  // whether it needs a `ride`
  virtual bool casts_rays() const { return false; }      // whether it sees the scene
  virtual bool feels_contacts() const { return false; }  // whether it calls SensorSite::contact_force
  virtual bool feels_motors() const { return false; }    // whether it calls SensorSite::motor_work
  virtual std::vector<std::string> links() const { return {}; }  // that contact_force() is asked for

  virtual std::unique_ptr<SensorKind> clone() const = 0;
  // Keys of its figures, bound to this object. Those of mount, rate and names are added for all kinds.
  virtual void add_keys(Schema& keys) = 0;
  virtual void add_model_key(Schema&) {}  // that comes before all others
  // Mistakes that no single key shows; keys as in add_keys().
  virtual std::vector<Diagnostic> find_mistakes() const { return {}; }

  // seed: of its noise; nothing: it has none. The site must outlive the meter.
  virtual std::unique_ptr<SensorMeter> start(const SensorSite& site, std::optional<std::uint64_t> seed,
                                             double rate_hz) const = 0;
};

// In the order in which a recording has them: the bundled ones, then those that were registered.
const std::vector<const SensorKind*>& sensor_kinds();
// Throws InputError: its key is taken. Not while missions are read.
void register_sensor(std::unique_ptr<SensorKind> kind);

}  // namespace rubble
