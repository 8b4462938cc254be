#include "app/drive/overlay/void_survey.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <utility>

#include "app/measures/metrics.h"

namespace rubble {
namespace {

constexpr double kSpaceShare = 0.6;        // of the work, as `rubble voids` has it; unit: 1
constexpr double kMargin = 0.2;            // of the outside that is kept; unit: m
constexpr std::size_t kMostPlaces = 4000;  // that are shown
constexpr double kArrow = 0.25;            // of an entrance; unit: m
constexpr double kWide = 3;                // clearance of the last colour; unit: radius of the robot
constexpr std::array<std::uint8_t, 3> kEntranceColour{255, 255, 255};

// From red at 0 by yellow and green to blue at 1.
std::array<std::uint8_t, 3> colour_of(double share) {
  static constexpr double kKnots[4][3] = {{255, 60, 40}, {250, 220, 40}, {70, 220, 90}, {70, 130, 255}};
  const double at = 3 * std::clamp(share, 0.0, 1.0);
  const int i = std::min(2, int(at));
  std::array<std::uint8_t, 3> colour{};
  for (std::size_t k = 0; k < 3; ++k)
    colour[k] = std::uint8_t(kKnots[i][k] + (at - i) * (kKnots[i + 1][k] - kKnots[i][k]));
  return colour;
}

}  // namespace

VoidSurvey::VoidSurvey(const VoidScenario& voids, const AssetLibrary& assets) : voids_(voids), assets_(assets) {}
VoidSurvey::~VoidSurvey() { forget(); }

void VoidSurvey::forget() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
  thread_ = {};
  map_ = nullptr, failure_ = nullptr;
  done_ = false;
}

void VoidSurvey::start(const PileState& pile, std::int64_t step, int threads) {
  forget();
  stop_ = told_ = false, progress_ = 0, step_ = step;
  VoidSpaceOptions options = make_void_options(voids_);
  options.threads = threads;
  options.scenery = assets_.terrain();
  options.margin = kMargin;
  thread_ = std::thread([this, pile, options] {
    const auto report = [this](double from, double share) {
      return [this, from, share](double done) {
        progress_ = from + share * done;
        return !stop_;
      };
    };
    try {
      VoidSpace space = calc_void_space(pile, assets_.finest_meshes(), options, report(0, kSpaceShare));
      map_ = std::make_unique<VoidMap>(find_voids(std::move(space), {voids_.radius}, report(kSpaceShare, 1 - kSpaceShare)));
    } catch (...) {
      failure_ = std::current_exception();
    }
    done_ = true;
  });
}

bool VoidSurvey::take_news() { return done_ && map() && !std::exchange(told_, true); }

const VoidMap* VoidSurvey::map() {
  if (!done_) return nullptr;
  if (thread_.joinable()) thread_.join();
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
  return map_.get();
}

PictureLabel VoidSurvey::label() const {
  char text[120];
  if (working())
    std::snprintf(text, sizeof text, "voids: %.0f %%", 100 * progress());
  else
    std::snprintf(text, sizeof text, "voids at step %lld for a ball of %.2f m: red just fits, blue 3 times", static_cast<long long>(step_),
                  voids_.radius);
  return {text, {255, 255, 255}};
}

void add_voids(const VoidMap& map, std::vector<OverlayLine>& lines) {
  if (map.robots.empty()) return;
  const RobotVoids& robot = map.robots.front();
  std::size_t places = 0;
  for (const Void& v : robot.voids) places += v.places.size();
  const std::size_t every = places / kMostPlaces + 1;
  const double half = map.space.grid.voxel / 4;
  std::size_t number = 0;
  for (const Void& v : robot.voids) {
    for (const std::uint32_t cell : v.places) {
      if (number++ % every != 0) continue;
      const Vec3 at = map.space.grid.centre(std::size_t(cell));
      const double share = (double(map.space.clearance[cell]) / robot.radius - 1) / (kWide - 1);
      for (const Vec3& arm : {Vec3{half, 0, 0}, Vec3{0, half, 0}, Vec3{0, 0, half}})
        lines.push_back({at - arm, at + arm, colour_of(share), true});
    }
    for (const Entrance& entrance : v.entrances)
      lines.push_back({entrance.position - entrance.inward * kArrow, entrance.position, kEntranceColour, true});
  }
}

}  // namespace rubble
