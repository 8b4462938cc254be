#include "kernel/solver/contact_rows.h"

#include "kernel/solver/rows/row_kernels.h"

namespace rubble {

const RowKernels& portable_row_kernels() { return RowKernelsOf<TwoHalves>::table; }

std::vector<const RowKernels*> all_row_kernels() {
  std::vector<const RowKernels*> all{&portable_row_kernels()};
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2")) all.push_back(&avx2_row_kernels());
// MinGW does not align the stack for registers of this width (GCC bug 54412).
#if !defined(_WIN32)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
      __builtin_cpu_supports("avx512dq")) {
    all.push_back(&avx512_row_kernels());
  }
#endif
#endif
  return all;
}

const RowKernels& best_row_kernels() {
  static const RowKernels* best = all_row_kernels().back();
  return *best;
}

}  // namespace rubble
