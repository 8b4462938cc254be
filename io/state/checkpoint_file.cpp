#include "io/state/checkpoint_file.h"

#include "io/base/little_endian.h"
#include "io/base/sealed_file.h"

namespace rubble {
namespace {

constexpr SealedKind kCheckpointKind{"RUBCHKP\n", kCheckpointVersion, "checkpoint of settling",
                           "it is written while a pile settles",
                           "settle the pile again, or use the program that wrote it"};

}  // namespace

void save_checkpoint(const SettleCheckpoint& checkpoint, const std::string& path) {
  std::string content;
  put(content, checkpoint.work);
  put(content, checkpoint.layers);
  put(content, checkpoint.layers_at_limit);
  put(content, checkpoint.layer_steps);
  put(content, static_cast<std::uint64_t>(checkpoint.world.size()));
  content.append(checkpoint.world.begin(), checkpoint.world.end());
  save_sealed(kCheckpointKind, content, path);
}

SettleCheckpoint load_checkpoint(const std::string& path) {
  const std::string content = load_sealed(kCheckpointKind, path);
  SealedReader reader(kCheckpointKind, content, path);
  SettleCheckpoint checkpoint;
  checkpoint.work = reader.number<std::uint64_t>();
  checkpoint.layers = reader.number<std::int32_t>();
  checkpoint.layers_at_limit = reader.number<std::int32_t>();
  checkpoint.layer_steps = reader.number<std::int64_t>();
  const std::string_view world = reader.bytes(reader.number<std::uint64_t>());
  checkpoint.world.assign(world.begin(), world.end());
  if (reader.left() != 0) reader.fail("the checkpoint of settling is longer than it says");
  return checkpoint;
}

}  // namespace rubble
