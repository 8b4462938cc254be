// Times a step of one articulated tree: chains of hinges with crossed axes and chains of balls,
// falling through the air and lying on the ground. One thread, nothing sleeps; the median of the
// rounds is printed, so that two programs can take turns on a machine that others use too.
//
//   tree_bench [--links N ...] [--rounds N]
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <exception>
#include <vector>

#include "kernel/world/world.h"

namespace rubble {
namespace {

constexpr double kLength = 0.3, kThickness = 0.1;  // of a link; unit: m
constexpr int kWarmUp = 60, kSteps = 60;

PieceType make_box() {
  PieceType box;
  box.name = "link";
  box.parts.resize(1);
  for (int i = 0; i < 8; ++i) {
    box.parts[0].points.push_back({(i & 1 ? 0.5 : -0.5) * kLength * 0.96,
                                   (i & 2 ? 0.5 : -0.5) * kThickness,
                                   (i & 4 ? 0.5 : -0.5) * kThickness});
  }
  return box;
}

AssemblyType make_chain(JointKind kind, int links) {
  AssemblyType chain;
  chain.name = "chain";
  const double s = std::sqrt(0.5);
  for (int i = 0; i < links; ++i) {
    chain.links.push_back({0, {{}, {kLength * i, 0, 0}}, 1});
    if (i == 0) continue;
    JointType joint;
    joint.kind = kind;
    joint.parent = i - 1;
    joint.child = i;
    const Quat upright{}, across{s, -s, 0, 0};
    joint.assembly_from_joint = {i % 2 == 0 ? upright : across, {kLength * (i - 0.5), 0, 0}};
    chain.joints.push_back(joint);
  }
  return chain;
}

double time_steps(World& world) {
  const std::clock_t start = std::clock();
  for (int i = 0; i < kSteps; ++i) world.step();
  return 1e6 * double(std::clock() - start) / (double(CLOCKS_PER_SEC) * kSteps);
}

double measure(JointKind kind, int links, bool ground, int rounds) {
  std::vector<double> times;
  for (int round = 0; round < rounds; ++round) {
    WorldOptions options;
    options.threads = 1;
    options.sleeping = false;
    World world({make_box()}, options, {make_chain(kind, links)});
    NewPiece chain;
    chain.placement.kind = PieceKind::assembly(0);
    chain.placement.world_from_body.translation = {-0.5 * kLength * links, 0, ground ? 0.2 : 500};
    if (!ground) chain.angular_velocity = {0.5, 0.3, 0.1};
    world.add({chain});
    for (int i = 0; i < kWarmUp; ++i) world.step();
    times.push_back(time_steps(world));
  }
  std::sort(times.begin(), times.end());
  return times[times.size() / 2];
}

void print_row(int links, int rounds) {
  std::printf("%5d", links);
  for (JointKind kind : {JointKind::hinge, JointKind::ball}) {
    for (bool ground : {false, true}) {
      std::printf(" %13.1f", measure(kind, links, ground, rounds));
      std::fflush(stdout);
    }
  }
  std::printf("\n");
}

int run(int argc, char** argv) {
  CLI::App app("Times a step of one articulated tree.");
  std::vector<int> links{2, 17, 32};
  int rounds = 5;
  app.add_option("--links", links, "how many links the chains have");
  app.add_option("--rounds", rounds, "of which the median is taken")->check(CLI::Range(1, 1000));
  CLI11_PARSE(app, argc, argv);
  std::printf("microseconds of processor time a step, one thread\n");
  std::printf("%5s %13s %13s %13s %13s\n", "links", "hinges, air", "hinges, lying", "balls, air",
              "balls, lying");
  for (int count : links) print_row(count, rounds);
  return 0;
}

}  // namespace
}  // namespace rubble

int main(int argc, char** argv) {
  try {
    return rubble::run(argc, argv);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "tree_bench: %s\n", e.what());
    return 1;
  }
}
