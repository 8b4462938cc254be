#include "io/ompl/plane_planner.h"

#include <ompl/base/objectives/PathLengthOptimizationObjective.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/base/terminationconditions/IterationTerminationCondition.h>
#include <ompl/datastructures/NearestNeighborsLinear.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>
#include <ompl/util/Console.h>

#include <algorithm>
#include <cmath>

#include "kernel/base/error.h"
#include "kernel/base/number_text.h"

namespace rubble {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;
using Space = ob::RealVectorStateSpace;

constexpr double kNarrow = 0.2;  // places with less than so much room to spare are narrow; unit: m

Vec3 place_of(const ob::State* state) {
  const auto& values = *state->as<Space::StateType>();
  return {values[0], values[1], 0};
}

void set_state(const Vec3& place, ob::State* state) {
  auto& values = *state->as<Space::StateType>();
  values[0] = place.x, values[1] = place.y;
}

// Seeds of generators that draw apart from each other.
std::uint_fast32_t seed_of(std::uint64_t seed, std::uint64_t use) {
  return std::uint_fast32_t((seed * 2654435761u + use * 40503u + 1) & 0x7fffffffu);
}

// What a plan is asked for, as OMPL's callbacks see it.
struct Problem {
  const PlaneClearance& map;
  Vec3 from, to;
  const PlanePlannerOptions& options;
  std::vector<std::uint32_t> narrow;  // cells where the disc has just room

  bool is_valid(const Vec3& place) const {
    const double clearance = map.at(place);
    if (clearance >= options.radius) return true;
    return clearance > 0 && (distance(place, from) < options.ends || distance(place, to) < options.ends);
  }
};

// Every other sample is of a narrow place: the ways between blocks are a small share of the plane.
class Sampler : public ob::StateSampler {
 public:
  Sampler(const ob::StateSpace* space, const Problem& problem)
      : StateSampler(space), problem_(problem), bounds_(space->as<Space>()->getBounds()) {
    rng_.setLocalSeed(seed_of(problem.options.seed, 1));
  }

  void sampleUniform(ob::State* state) override {
    Vec3 place{rng_.uniformReal(bounds_.low[0], bounds_.high[0]), rng_.uniformReal(bounds_.low[1], bounds_.high[1]), 0};
    if (!problem_.narrow.empty() && rng_.uniformBool()) {
      const auto& cells = problem_.narrow;
      const double half = 0.5 * problem_.map.grid.voxel;
      place = problem_.map.grid.centre(cells[std::size_t(rng_.uniformInt(0, int(cells.size()) - 1))]);
      place.x += rng_.uniformReal(-half, half), place.y += rng_.uniformReal(-half, half);
    }
    set_state(place, state);
  }
  void sampleUniformNear(ob::State* state, const ob::State* near, double reach) override {
    const Vec3 p = place_of(near);
    set_state({p.x + rng_.uniformReal(-reach, reach), p.y + rng_.uniformReal(-reach, reach), 0}, state);
    space_->enforceBounds(state);
  }
  void sampleGaussian(ob::State* state, const ob::State* mean, double deviation) override {
    const Vec3 p = place_of(mean);
    set_state({rng_.gaussian(p.x, deviation), rng_.gaussian(p.y, deviation), 0}, state);
    space_->enforceBounds(state);
  }

 private:
  const Problem& problem_;
  ob::RealVectorBounds bounds_;
};

class SeededPlanner : public og::RRTstar {
 public:
  SeededPlanner(const ob::SpaceInformationPtr& information, std::uint_fast32_t seed) : RRTstar(information) {
    rng_.setLocalSeed(seed);
  }
};

std::vector<std::uint32_t> find_narrow(const PlaneClearance& map, double radius) {
  std::vector<std::uint32_t> cells;
  for (std::size_t i = 0; i < map.clearance.size(); ++i)
    if (map.clearance[i] >= radius && map.clearance[i] < radius + kNarrow) cells.push_back(std::uint32_t(i));
  return cells;
}

std::shared_ptr<Space> make_space(const Problem& problem) {
  const VoxelGrid& grid = problem.map.grid;
  const auto space = std::make_shared<Space>(2);
  ob::RealVectorBounds bounds(2);
  for (unsigned k = 0; k < 2; ++k) {
    bounds.setLow(k, grid.corner[int(k)]);
    bounds.setHigh(k, grid.corner[int(k)] + grid.size[k] * grid.voxel);
  }
  space->setBounds(bounds);
  space->setStateSamplerAllocator([&problem](const ob::StateSpace* s) { return std::make_shared<Sampler>(s, problem); });
  return space;
}

// Legs from a corner straight to the farthest one that can be driven to.
std::vector<Vec3> pull_tight(const std::vector<Vec3>& corners, const ob::SpaceInformationPtr& information) {
  ob::ScopedState<Space> a(information), b(information);
  const auto is_free = [&](const Vec3& from, const Vec3& to) {
    set_state(from, a.get()), set_state(to, b.get());
    return information->checkMotion(a.get(), b.get());
  };
  std::vector<Vec3> tight{corners.front()};
  for (std::size_t i = 0; i + 1 < corners.size();) {
    std::size_t next = corners.size() - 1;
    while (next > i + 1 && !is_free(corners[i], corners[next])) --next;
    tight.push_back(corners[next]);
    i = next;
  }
  return tight;
}

std::vector<Vec3> solve(const Problem& problem) {
  const auto space = make_space(problem);
  const auto information = std::make_shared<ob::SpaceInformation>(space);
  information->setStateValidityChecker([&](const ob::State* state) { return problem.is_valid(place_of(state)); });
  information->setStateValidityCheckingResolution(0.5 * problem.map.grid.voxel / space->getMaximumExtent());
  information->setup();
  const auto definition = std::make_shared<ob::ProblemDefinition>(information);
  ob::ScopedState<Space> start(space), goal(space);
  set_state(problem.from, start.get()), set_state(problem.to, goal.get());
  definition->setStartAndGoalStates(start, goal, 1e-6);
  definition->setOptimizationObjective(std::make_shared<ob::PathLengthOptimizationObjective>(information));
  SeededPlanner planner(information, seed_of(problem.options.seed, 2));
  planner.setNearestNeighbors<ompl::NearestNeighborsLinear>();  // others draw random numbers that no seed of ours reaches
  planner.setProblemDefinition(definition);
  planner.setup();
  ob::IterationTerminationCondition enough(unsigned(problem.options.samples));
  planner.solve(static_cast<ob::PlannerTerminationCondition>(enough));
  if (!definition->hasExactSolution()) return {};
  std::vector<Vec3> corners;
  for (const ob::State* state : definition->getSolutionPath()->as<og::PathGeometric>()->getStates())
    corners.push_back(place_of(state));
  return pull_tight(corners, information);
}

void expect_positive(const char* key, double value) {
  if (!(value > 0)) throw InputError({"", 0, key, "out of range", "more than 0", plain_text(value), ""});
}

}  // namespace

double PlaneClearance::at(const Vec3& place) const {
  const Cell cell = grid.find_cell({place.x, place.y, grid.corner.z});
  return grid.contains(cell) ? double(clearance[grid.index(cell)]) : 0;
}

bool is_leg_free(const PlaneClearance& map, const Vec3& from, const Vec3& to, double radius) {
  const int parts = std::max(1, int(std::ceil(distance(from, to) / (0.5 * map.grid.voxel))));
  for (int i = 0; i <= parts; ++i)
    if (map.at(from + (to - from) * (double(i) / parts)) < radius) return false;
  return true;
}

std::vector<Vec3> plan_in_plane(const PlaneClearance& map, const Vec3& from, const Vec3& to,
                                const PlanePlannerOptions& options) {
  expect_positive("radius", options.radius);
  expect_positive("samples", options.samples);
  Problem problem{map, {from.x, from.y, 0}, {to.x, to.y, 0}, options, find_narrow(map, options.radius)};
  if (!problem.is_valid(problem.from) || !problem.is_valid(problem.to)) return {};
  try {
    ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
    return solve(problem);
  } catch (const std::exception& error) {
    throw RunError(std::string("OMPL failed: ") + error.what());
  }
}

}  // namespace rubble
