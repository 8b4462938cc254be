// In the place of simbody_trees.cpp and simbody_build.cpp where the kernel is built without Simbody
// (RUBBLE_SIMBODY=OFF): free pieces settle to the same bits, what is jointed is refused.
#include "kernel/base/error.h"
#include "kernel/multibody/simbody_build.h"
#include "kernel/multibody/simbody_trees.h"

namespace rubble {
namespace {

[[noreturn]] void refuse() {
  throw InputError({"", 0, "", "the pile has joints, and this kernel was built without Simbody",
                    "free pieces", "", "build with RUBBLE_SIMBODY=ON where Simbody is"});
}

}  // namespace

struct SimbodyTree::System {};

SimbodyTree::SimbodyTree(const Tree&, const std::vector<Body>&) { refuse(); }
SimbodyTree::~SimbodyTree() = default;
TreeState SimbodyTree::state() const { refuse(); }
void SimbodyTree::set_state(const TreeState&) { refuse(); }
void SimbodyTree::set_speeds(const std::vector<double>&) { refuse(); }
const TreePose& SimbodyTree::pose() { refuse(); }
void SimbodyTree::calc_world_from_links(std::vector<Pose>&) { refuse(); }
void SimbodyTree::calc_forces(double, std::vector<double>&) { refuse(); }
void SimbodyTree::multiply_by_inverse_mass(const std::vector<double>&, std::vector<double>&) { refuse(); }

int SimbodyTrees::add(const Tree&, const std::vector<Body>&, const TreeState&) { refuse(); }
// A tree that came apart has no system, and needs none.
void SimbodyTrees::replace(int, const Tree&, const std::vector<Body>&, const TreeState&) { refuse(); }
TreeState SimbodyTrees::state(int) const { return {}; }

bool simbody_has_reference_bits() { return false; }

}  // namespace rubble
