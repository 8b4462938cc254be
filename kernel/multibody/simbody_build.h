// Whether the Simbody that is linked computes the bits that the determinism contract is made for.
#pragma once

namespace rubble {

// True where Simbody's poses, forces and M^-1 of a tree with every kind of joint have the bits of
// Simbody 3.7 compiled without fused multiply-adds, as on every x86-64 of Debian. False on Debian's
// arm64, where g++ fuses by default: piles with joints then get other last bits than on x86-64
// (free pieces do not). Computed at the first call (under a millisecond), then kept.
// tools/build_simbody.sh builds a Simbody that gives these bits.
bool simbody_has_reference_bits();

}  // namespace rubble
