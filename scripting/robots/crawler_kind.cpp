// The crawler in missions: flippers that a driver raises and lowers.
#include "scripting/robots/crawler.h"
#include "scripting/robots/robot_kind.h"

namespace rubble {
namespace {

struct CrawlerFigures : FiguresOf<CrawlerFigures> {
  bool flippers = true;

  void add_keys(Schema& k) override { k.value("flippers", flippers, "Crawler: has flippers."); }
  bool operator==(const CrawlerFigures& other) const { return flippers == other.flippers; }
};

constexpr double kFlipperRate = 45;                  // unit: degree/s
constexpr double kMostFlipper = 180;                 // unit: degree
constexpr double kFlipperStart = 57.29577951308232;  // where they stand at the start; unit: degree

class Crawler : public RobotKind {
 public:
  std::string name() const override { return "crawler"; }
  std::unique_ptr<RobotFigures> figures() const override { return std::make_unique<CrawlerFigures>(); }
  bool has_sides(const RobotItem&) const override { return true; }

  RobotModel make(const RobotItem& robot) const override {
    CrawlerOptions options;
    options.flippers = robot.figures.of<CrawlerFigures>().flippers;
    options.friction = robot.friction.value_or(options.friction);
    return make_crawler(options);
  }

  void check(const RobotItem& robot, const std::string& key, std::vector<Diagnostic>& mistakes) const override {
    for (std::size_t k = 0; k < robot.drive.size(); ++k) {
      const std::size_t flippers = robot.drive[k].flippers_deg.size();
      if (flippers != 0 && flippers != 4)
        mistakes.push_back({"", 0, key + "drive[" + std::to_string(k + 1) + "].flippers_deg", "wrong number of angles",
                            "front left, front right, rear left, rear right", std::to_string(flippers), ""});
    }
  }

  // The stick that lowers the nose moves those in front, the one that rolls those behind; they go on from where they were
  // asked to be.
  void steer(const TeleopCommand& asked, const RobotItem& robot, const RobotLeg& last, double seconds, RobotLeg& leg) const override {
    RobotKind::steer(asked, robot, last, seconds, leg);
    if (!robot.figures.of<CrawlerFigures>().flippers) return;
    if (leg.flippers_deg.empty()) leg.flippers_deg.assign(4, kFlipperStart);
    for (std::size_t i = 0; i < 4; ++i) {
      const double by = (i < 2 ? -asked.pitch : asked.roll) * kFlipperRate * seconds;
      leg.flippers_deg[i] = within(leg.flippers_deg[i] + by, kMostFlipper);
    }
  }
};

}  // namespace

std::unique_ptr<RobotKind> make_crawler_kind() { return std::make_unique<Crawler>(); }

}  // namespace rubble
