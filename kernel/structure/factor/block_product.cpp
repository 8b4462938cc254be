#include "kernel/structure/factor/block_product.h"

namespace rubble {
namespace {

// No alias declarations: in those, clang forgets that these need no alignment.
typedef double Two __attribute__((vector_size(16), aligned(8), may_alias));
typedef double Four __attribute__((vector_size(32), aligned(8), may_alias));

// Each row of the target stays in registers.
void subtract_by_twos(Block6& target, const Block6& a, const Block6& b) {
  const Two* rows = reinterpret_cast<const Two*>(b.data());
  for (int i = 0; i < 6; ++i) {
    Two* row = reinterpret_cast<Two*>(target.data() + 6 * i);
    Two r0 = row[0], r1 = row[1], r2 = row[2];
    for (int k = 0; k < 6; ++k) {
      const double x = a[6 * i + k];
      r0 -= x * rows[3 * k], r1 -= x * rows[3 * k + 1], r2 -= x * rows[3 * k + 2];
    }
    row[0] = r0, row[1] = r1, row[2] = r2;
  }
}

#if defined(__x86_64__)
// The same operations on the same numbers, two rows of the target at a time: they fill three registers.
__attribute__((target("avx2"))) void subtract_by_fours(Block6& target, const Block6& a, const Block6& b) {
  Four first[6], second[6], third[6];  // a row of b twice, one after the other
  for (int k = 0; k < 6; ++k) {
    const double* row = b.data() + 6 * k;
    first[k] = *reinterpret_cast<const Four*>(row);
    third[k] = *reinterpret_cast<const Four*>(row + 2);
    second[k] = Four{row[4], row[5], row[0], row[1]};
  }
  for (int i = 0; i < 6; i += 2) {
    Four* rows = reinterpret_cast<Four*>(target.data() + 6 * i);
    Four r0 = rows[0], r1 = rows[1], r2 = rows[2];
    for (int k = 0; k < 6; ++k) {
      const double x = a[6 * i + k], y = a[6 * i + 6 + k];
      r0 -= x * first[k], r1 -= Four{x, x, y, y} * second[k], r2 -= y * third[k];
    }
    rows[0] = r0, rows[1] = r1, rows[2] = r2;
  }
}
#endif

}  // namespace

SubtractProduct portable_subtract_product() { return subtract_by_twos; }

SubtractProduct best_subtract_product() {
#if defined(__x86_64__)
  static const bool avx2 = __builtin_cpu_supports("avx2");
  if (avx2) return subtract_by_fours;
#endif
  return subtract_by_twos;
}

}  // namespace rubble
