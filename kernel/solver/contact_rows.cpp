#include "kernel/solver/contact_rows.h"

#include "kernel/solver/contact_prepare.h"
#include "kernel/solver/contact_sweeps.h"

// AVX2 without fused operations: multiply and add round one after the other, as on any machine.
#if defined(__x86_64__)
#define RUBBLE_FOR_AVX2 __attribute__((target("avx2")))
#else
#define RUBBLE_FOR_AVX2
#endif

namespace rubble {
namespace {

#define RUBBLE_ROW_KERNELS(name, Packet, target)                                              \
  struct name {                                                                               \
    target static void prepare(const BatchRange& range, const Contact* contacts,              \
                               const BodyTerms* terms, float rest_gap) {                      \
      contact_prepare::prepare<Packet>(range, contacts, terms, rest_gap);                     \
    }                                                                                         \
    target static void warm_start(const BatchRange& range, PaddedMotion* v) {                 \
      contact_sweeps::warm_start<Packet>(range, v);                                           \
    }                                                                                         \
    target static void solve_velocities(const BatchRange& range, bool backwards,              \
                                        float per_substep, float weight,                      \
                                        const PaddedMotion* moved, PaddedMotion* v) {         \
      contact_sweeps::solve_velocities<Packet>(range, backwards, per_substep, weight, moved,  \
                                               v);                                            \
    }                                                                                         \
    target static bool begin_pushes(const ContactBatch& batch, const NormalRow* rows,         \
                                    PushRow* pushes, const PushTerms& terms,                  \
                                    const PaddedMotion* moved) {                              \
      return contact_sweeps::begin_pushes<Packet>(batch, rows, pushes, terms, moved);         \
    }                                                                                         \
    target static bool solve_pushes(const ContactBatch& batch, const NormalRow* rows,         \
                                    PushRow* pushes, PaddedMotion* moved) {                   \
      return contact_sweeps::solve_pushes<Packet>(batch, rows, pushes, moved);                \
    }                                                                                         \
    static constexpr RowKernels table{prepare, warm_start, solve_velocities, begin_pushes,    \
                                      solve_pushes};                                          \
  };

RUBBLE_ROW_KERNELS(Portable, TwoHalves, )
#if defined(__x86_64__)
RUBBLE_ROW_KERNELS(Avx2, EightLanes, RUBBLE_FOR_AVX2)
#endif
#undef RUBBLE_ROW_KERNELS

}  // namespace

const RowKernels& portable_row_kernels() { return Portable::table; }

const RowKernels& best_row_kernels() {
#if defined(__x86_64__)
  static const bool avx2 = __builtin_cpu_supports("avx2");
  if (avx2) return Avx2::table;
#endif
  return Portable::table;
}

}  // namespace rubble
