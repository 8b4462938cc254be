#include "io/state/checkpoint_file.h"

#include <gtest/gtest.h>

#include <fstream>

#include "io/base/atomic_file.h"
#include "io/state/pile_state_file.h"
#include "kernel/base/error.h"
#include "kernel/settling/generator.h"
#include "kernel/settling/settle.h"
#include "tests/io/support.h"

namespace rubble {
namespace checkpoint_file_test {

using test::read_text;
using test::ScratchFolder;

Pile make_pile() {
  PieceType box;
  box.name = "box";
  box.parts.resize(1);
  for (double x : {-0.2, 0.2}) {
    for (double y : {-0.1, 0.1}) {
      for (double z : {-0.15, 0.15}) box.parts[0].points.push_back({x, y, z});
    }
  }
  PileSpec spec;
  spec.seed = 3;
  spec.types = {box};
  spec.mix = {{0, 1, 0.5, 1.5}};
  spec.spawn_bounds = {1.5, 1.5, 6};
  spec.layers = 2;
  spec.pieces_per_layer = 12;
  return generate_pile(spec);
}

SettleOptions one_thread() {
  SettleOptions options;
  options.threads = 1;
  return options;
}

// Settles with a checkpoint file written after `step` steps.
PileState settle_with_checkpoint(const Pile& pile, std::int64_t step, const std::string& path) {
  std::int64_t calls = 0;
  return settle_pile(pile, one_thread(), [&](const SettleProgress& progress) {
    if (++calls == step) save_checkpoint(progress.make_checkpoint(), path);
    return true;
  });
}

std::string error_of(const std::string& path) {
  try {
    load_checkpoint(path);
  } catch (const InputError& error) {
    return error.diagnostics().front().text();
  }
  return "no error";
}

void expect_in(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "\"" << part << "\" is not in: " << text;
}

TEST(CheckpointFile, ContinuesFromTheFileAsIfItHadNeverStopped) {
  ScratchFolder folder;
  const Pile pile = make_pile();
  for (const std::int64_t step : {1, 60, 150, 200}) {
    const std::string path = folder / "checkpoint.bin";
    const PileState whole = settle_with_checkpoint(pile, step, path);
    ASSERT_GT(whole.steps, step);
    const PileState resumed = resume_settling(load_checkpoint(path), pile, one_thread());
    EXPECT_EQ(resumed.state_hash(), whole.state_hash()) << "stopped after step " << step;
    EXPECT_EQ(resumed.steps, whole.steps) << "stopped after step " << step;
    save_pile_state(whole, folder / "whole");
    save_pile_state(resumed, folder / "resumed");
    EXPECT_EQ(read_text(folder / "whole"), read_text(folder / "resumed"));
  }
}

TEST(CheckpointFile, IsTheSameFileAgain) {
  ScratchFolder folder;
  settle_with_checkpoint(make_pile(), 80, folder / "a");
  settle_with_checkpoint(make_pile(), 80, folder / "b");
  save_checkpoint(load_checkpoint(folder / "a"), folder / "c");
  EXPECT_EQ(read_text(folder / "a"), read_text(folder / "b"));
  EXPECT_EQ(read_text(folder / "a"), read_text(folder / "c"));
  settle_with_checkpoint(make_pile(), 81, folder / "d");  // the negative control
  EXPECT_NE(read_text(folder / "a"), read_text(folder / "d"));
}

// A small one, so that every byte can be tried.
std::string make_small(const ScratchFolder& folder) {
  SettleCheckpoint checkpoint;
  checkpoint.work = 0x0123456789abcdef;
  checkpoint.layers = 2;
  checkpoint.layers_at_limit = 1;
  checkpoint.layer_steps = 77;
  checkpoint.world = {0, 1, 2, 255};
  save_checkpoint(checkpoint, folder / "whole");
  return read_text(folder / "whole");
}

// Without the flush to the disk that write_text_file makes.
void write_quickly(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

TEST(CheckpointFile, RefusesEveryTruncationAndEveryAlteredByte) {
  ScratchFolder folder;
  const std::string whole = make_small(folder);
  EXPECT_EQ(error_of(folder / "whole"), "no error");  // the negative control
  for (std::size_t i = 0; i < whole.size(); ++i) {
    write_quickly(folder / "cut", whole.substr(0, i));
    EXPECT_NE(error_of(folder / "cut"), "no error") << "the first " << i << " bytes were accepted";
    std::string altered = whole;
    altered[i] = static_cast<char>(altered[i] ^ 0x04);
    write_quickly(folder / "altered", altered);
    EXPECT_NE(error_of(folder / "altered"), "no error") << "byte " << i << " could be changed";
  }
}

TEST(CheckpointFile, SaysWhatIsWrong) {
  ScratchFolder folder;
  const std::string whole = make_small(folder);
  save_pile_state(PileState{}, folder / "state");
  expect_in(error_of(folder / "state"), "is not a checkpoint of settling");
  expect_in(error_of(folder / "missing"), "cannot be opened: No such file");
  write_text_file(folder / "longer", whole + "x");
  expect_in(error_of(folder / "longer"), "longer than it says");
  std::string altered = whole;
  altered[40] = static_cast<char>(altered[40] ^ 1);
  write_text_file(folder / "altered", altered);
  expect_in(error_of(folder / "altered"), folder / "altered");
  expect_in(error_of(folder / "altered"), "does not match its checksum");
  altered = whole;
  altered[8] = 9;
  write_text_file(folder / "newer", altered);
  expect_in(error_of(folder / "newer"), "format version 9; this program reads version 1");
}

}  // namespace checkpoint_file_test
}  // namespace rubble
