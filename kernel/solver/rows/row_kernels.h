// The loops of contact_rows.h for one kind of packet. For contact_rows*.cpp alone.
#pragma once

#include "kernel/solver/rows/contact_prepare.h"
#include "kernel/solver/rows/contact_sweeps.h"
#include "kernel/solver/rows/push_sweeps.h"

namespace rubble {

template <typename P>
struct RowKernelsOf {
  static void prepare(const BatchRange& range, const Contact* contacts, const BodyTerms* terms,
                      float rest_gap) {
    contact_prepare::prepare<P>(range, contacts, terms, rest_gap);
  }
  static void warm_start(const BatchRange& range, PaddedMotion* v) {
    contact_sweeps::warm_start<P>(range, v);
  }
  static void solve_velocities(const BatchRange& range, bool backwards, float per_substep,
                               float weight, const PaddedMotion* moved, PaddedMotion* v) {
    contact_sweeps::solve_velocities<P>(range, backwards, per_substep, weight, moved, v);
  }
  static bool begin_pushes(const ContactBatch& batch, const NormalRow* rows, PushRow* pushes,
                           const PushTerms& terms, const PaddedMotion* moved) {
    return contact_sweeps::begin_pushes<P>(batch, rows, pushes, terms, moved);
  }
  static bool solve_pushes(const ContactBatch& batch, const NormalRow* rows, PushRow* pushes,
                           PaddedMotion* moved) {
    return contact_sweeps::solve_pushes<P>(batch, rows, pushes, moved);
  }
  static constexpr RowKernels table{prepare, warm_start, solve_velocities, begin_pushes,
                                    solve_pushes};
};

}  // namespace rubble
