// The loops of contact_rows.h for processors with AVX-512, without fused operations: multiply and add round one
// after the other, as on any machine. A unit of its own, so that nothing else is compiled for these.
#if defined(__x86_64__)
#include <immintrin.h>

#include <cmath>
#include <cstddef>
#include <cstring>

#include "kernel/solver/contact_rows.h"
#include "kernel/solver/rows/target_region.h"

RUBBLE_BEGIN_TARGET("avx512f,avx512vl,avx512dq")
#include "kernel/solver/rows/sixteen_lanes.h"
#include "kernel/solver/rows/row_kernels.h"
RUBBLE_END_TARGET

namespace rubble {

const RowKernels& avx512_row_kernels() { return RowKernelsOf<SixteenLanes>::table; }

}  // namespace rubble
#endif
