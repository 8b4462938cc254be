#include "tests/determinism/trace.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <string>

#include "kernel/base/error.h"
#include "tests/determinism/standard_scenes.h"
#include "tests/kernel/scenes.h"

namespace rubble::determinism {
namespace trace_test {

// A path in the build folder; the file is removed at the end.
class TraceFile {
 public:
  explicit TraceFile(const std::string& name)
      : path_(::testing::TempDir() +
              ::testing::UnitTest::GetInstance()->current_test_info()->name() + name) {}
  ~TraceFile() { std::remove(path_.c_str()); }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

void trace_scene(const TraceFile& file, const std::string& scene, const SceneOptions& base) {
  TraceWriter trace(file.path());
  trace.begin_scene(scene);
  SceneOptions options = base;
  options.after_step = [&trace](const World& world) { trace.add(world); };
  find_scene(scene).run(options);
  trace.finish();
}

// Three boxes side by side; before the fourth step the speed of one may be changed.
void trace_boxes(const TraceFile& file, int changed_body, double change) {
  World world({testing::box_type("box", 0.2, 0.2, 0.2)});
  world.add({testing::at(0, {0, 0, 1}), testing::at(0, {1, 0, 1}), testing::at(0, {2, 0, 1})});
  TraceWriter trace(file.path());
  trace.begin_scene("boxes");
  for (int step = 1; step <= 8; ++step) {
    if (step == 4 && change != 0) {
      const PieceState piece = world.piece(changed_body);
      world.set_velocity(changed_body, piece.linear_velocity + Vec3{change, 0, 0}, {});
    }
    world.step();
    trace.add(world);
  }
  trace.finish();
}

TEST(Trace, ThreadCountsGiveTheSameTrace) {
  const TraceFile a("_a"), b("_b");
  SceneOptions options;
  trace_scene(a, "pile_midair", options);
  options.threads = 8;
  trace_scene(b, "pile_midair", options);
  EXPECT_EQ(compare_traces(a.path(), b.path()), "");
}

TEST(Trace, NamesThePushedBodyInTheFirstStep) {
  const TraceFile a("_a"), b("_b");
  SceneOptions options;
  trace_scene(a, "pile_midair", options);
  options.push = 1e-9;
  trace_scene(b, "pile_midair", options);
  const std::string difference = compare_traces(a.path(), b.path());
  EXPECT_EQ(difference.rfind("scene pile_midair, step 1, body 149, position.x: ", 0), 0u)
      << difference;
}

TEST(Trace, NamesTheFirstStepBodyAndFieldWithBothValues) {
  const TraceFile a("_a"), b("_b");
  trace_boxes(a, 1, 0);
  trace_boxes(b, 1, 1e-300);  // too slow to move the box by even the last bit
  EXPECT_EQ(compare_traces(a.path(), b.path()),
            "scene boxes, step 4, body 1, linear velocity.x: 0 (0x0p+0) against "
            "1e-300 (0x1.56e1fc2f8f359p-997); bodies that differ in this step: 1");
}

TEST(Trace, SaysWhichRunEndsFirst) {
  const TraceFile a("_a"), b("_b");
  trace_boxes(a, 0, 0);
  { TraceWriter(b.path()).finish(); }
  EXPECT_EQ(compare_traces(a.path(), b.path()),
            "the runs part: scene boxes, step 1 against the end");
}

TEST(Trace, RefusesAForeignAndACutFile) {
  const TraceFile a("_a"), b("_b");
  trace_boxes(a, 0, 0);
  std::ifstream whole(a.path(), std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(whole), {}};
  std::ofstream(b.path(), std::ios::binary) << bytes.substr(0, bytes.size() - 5);
  EXPECT_THROW(compare_traces(a.path(), b.path()), RunError);
  std::ofstream(b.path(), std::ios::binary) << "something else entirely";
  EXPECT_THROW(compare_traces(a.path(), b.path()), RunError);
}

}  // namespace trace_test
}  // namespace rubble::determinism
