#include "kernel/settling/settle_checkpoint.h"

#include "kernel/base/hash.h"
#include "kernel/model/pile_hash.h"
#include "kernel/settling/settle.h"

namespace rubble {

std::uint64_t hash_work(const Pile& pile, const SettleOptions& options) {
  StateHash hash;
  hash.add(hash_pile(pile));
  hash.add(std::int32_t(options.schedule));
  for (double value : {options.gravity, options.step, options.rest_speed,
                       options.rest_angular_speed, options.rest_overlap,
                       options.layer_time_limit,
                       options.final_time_limit, options.lost_below, options.lost_beyond}) {
    hash.add(value);
  }
  return hash.digest();
}

}  // namespace rubble
