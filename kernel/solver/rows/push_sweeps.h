// The loops of contact_rows.h over displacements, for any kind of packet: position correction. Not for use
// outside kernel/.
#pragma once

#include "kernel/solver/rows/contact_sweeps.h"

namespace rubble::contact_sweeps {

template <typename P>
RUBBLE_INLINE bool begin_packet_pushes(const ContactBatch& batch, const NormalRow* rows, int first,
                                       PushRow* pushes, const PushTerms& terms,
                                       const PaddedMotion* moved) {
  const Motions<P> a = load<P>(moved, batch.a + first), b = load<P>(moved, batch.b + first);
  const Packet3<P> normal(batch.normal, first);
  P most{};
  // A tie that yields is left as long as it has become.
  const auto holds = P(batch.most, first) > P(batch.highest, first);
  for (int i = 0; i < batch.rows; ++i) {
    const P done = relative(normal, rows[i].row, first, a, b);
    const P gap = P(rows[i].gap, first) + done + P(terms.slop);
    const P most_now = select(P(-terms.deep) > gap, P(terms.most_deep), P(terms.most));
    const P step = contact_law::smaller(-gap * P(terms.fraction), most_now);
    const P wanted = select(holds, select(P{} > gap, step, -gap), P(-kNoPush));
    (done + wanted).store(pushes[i].target, first);
    P{}.store(pushes[i].push, first);
    most = max(most, wanted);
  }
  return any(most > P{});
}

template <typename P>
RUBBLE_INLINE bool begin_pushes(const ContactBatch& batch, const NormalRow* rows, PushRow* pushes,
                                const PushTerms& terms, const PaddedMotion* moved) {
  bool wanted = false;
  for (int first = 0; first < batch.used; first += P::width()) {
    wanted |= begin_packet_pushes<P>(batch, rows, first, pushes, terms, moved);
  }
  return wanted;
}

template <typename P>
RUBBLE_INLINE bool solve_packet_pushes(const ContactBatch& batch, const NormalRow* rows, int first,
                                       PushRow* pushes, PaddedMotion* moved) {
  Motions<P> a = load<P>(moved, batch.a + first), b = load<P>(moved, batch.b + first);
  const P share_a(batch.push_share_a, first), share_b(batch.push_share_b, first);
  const P mass_a(batch.push_mass_a, first), mass_b(batch.push_mass_b, first);
  const Packet3<P> normal(batch.normal, first);
  P most{};
  for (int i = 0; i < batch.rows; ++i) {
    const ContactRow& row = rows[i].row;
    PushRow& p = pushes[i];
    const P push(p.push, first), done = relative(normal, row, first, a, b);
    const P next = max(P{}, push + P(p.mass, first) * (P(p.target, first) - done));
    const P change = next - push;
    next.store(p.push, first);
    most = max(most, next);
    a.linear -= normal * (change * share_a);
    a.angular -= Packet3<P>(row.turn_a, first) * (change * mass_a);
    b.linear += normal * (change * share_b);
    b.angular += Packet3<P>(row.turn_b, first) * (change * mass_b);
  }
  save(a, moved, batch.a + first);
  save(b, moved, batch.b + first);
  return any(most > P{});
}

template <typename P>
RUBBLE_INLINE bool solve_pushes(const ContactBatch& batch, const NormalRow* rows, PushRow* pushes,
                                PaddedMotion* moved) {
  bool pushed = false;
  for (int first = 0; first < batch.used; first += P::width()) {
    pushed |= solve_packet_pushes<P>(batch, rows, first, pushes, moved);
  }
  return pushed;
}

}  // namespace rubble::contact_sweeps
