// Drops bricks, looks at contacts and energies step by step, and goes back to a moment.
//   step_world
#include <cstdio>
#include <exception>
#include <memory>
#include <vector>

#include "bricks_and_slabs.h"
#include <rubble/kernel/world/world.h>
#include <rubble/kernel/world/world_diagnostics.h>
#include <rubble/kernel/world/world_rest.h>

namespace {

// What presses on the ground; unit: N
double weigh(const rubble::World& world, double step) {
  double sum = 0;
  for (const rubble::ContactImpulse& c : world.contacts())
    if (c.other < 0) sum += c.impulse.z / step;
  return sum;
}

// Of the last brick; unit: m
rubble::Vec3 top(const rubble::World& world) { return world.piece(world.size() - 1).world_from_body.translation; }

void run() {
  rubble::WorldOptions options;
  options.step = 1.0 / 120;
  rubble::World world({make_box("brick", 0.4, 0.2, 0.2)}, options);
  std::vector<rubble::NewPiece> tower(5);
  for (std::size_t i = 0; i < tower.size(); ++i) tower[i].placement.world_from_body.translation = {0, 0, 0.2 + 0.3 * double(i)};
  world.add(tower);

  std::shared_ptr<const rubble::World::Snapshot> falling;
  while (world.time() < 3) {
    world.step();
    if (world.steps() == 30) falling = world.snapshot();
    if (world.steps() % 60 == 0)
      std::printf("%.1f s: %.1f J, %.0f N on the ground\n", world.time(), world.diagnostics().kinetic_energy(),
                  weigh(world, options.step));
  }
  double mass = 0;
  for (int i = 0; i < world.size(); ++i) mass += world.mass(i);
  std::printf("it weighs %.0f N and %s\n", mass * options.gravity, world.rest().reached(0.01, 0.05) ? "rests" : "moves");

  const rubble::Vec3 first = top(world);
  const std::int64_t steps = world.steps();
  world.restore(*falling);
  while (world.steps() < steps) world.step();
  std::printf("from the snapshot on: %s\n", top(world) == first ? "the same bits" : "other bits");
}

}  // namespace

int main() {
  try {
    run();
    return 0;
  } catch (const std::exception& e) {
    return std::fprintf(stderr, "step_world: %s\n", e.what()), 2;
  }
}
