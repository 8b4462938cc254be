#include "kernel/settling/collapse.h"

#include <utility>

#include "kernel/settling/collapse_impl.h"
#include "kernel/world/world_structures.h"

namespace rubble {

Collapse::Collapse(World& world, const Structure& structure, int first_type,
                   const CollapseOptions& options, std::vector<SectionForces> settled)
    : impl_(std::make_unique<Impl>(world, structure, first_type, options, std::move(settled))) {
  world.structures().set_on_solved([this] { return impl_->on_solved(); });
}

Collapse::~Collapse() { impl_->world.structures().set_on_solved({}); }

void Collapse::begin_step(const Vec3& ground_acceleration) {
  impl_->ground_acceleration = ground_acceleration;
  impl_->accelerate();
}

void Collapse::end_step() {
  impl_->drain();
  impl_->strike();
  impl_->sinks = false;
  impl_->throw_blasted();
  impl_->settle_forces();
}

bool Collapse::is_breaking() const { return impl_->breaking || impl_->struck >= 0; }
int Collapse::arrests() const { return impl_->arrests; }
int Collapse::first_piece() const { return impl_->first; }
int Collapse::piece_count() const { return int(impl_->structure.pieces.size()); }

CollapseReport Collapse::report() const {
  CollapseReport report = impl_->report;
  report.torn = report.ties - impl_->world.structures().tie_count();
  report.tie_energy = impl_->world.structures().tie_energy();
  return report;
}

}  // namespace rubble
