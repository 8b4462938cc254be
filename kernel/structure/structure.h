// A structure: members cut into convex pieces, and the bonds that hold them together.
//
// Every piece keeps the orientation of the structure's frame, so that a piece is a type and a place.
// Lengths in metres, world frame: Z up, ground z = 0.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kernel/base/math.h"
#include "kernel/model/pile.h"
#include "kernel/structure/fragments.h"
#include "kernel/structure/section.h"

namespace rubble {

enum class MemberKind : std::uint8_t { column, beam, slab, wall };
const char* member_name(MemberKind kind);

inline constexpr std::int32_t kFoundation = -1;  // stands for a piece: what does not move

// Bars as shares of the area of any section through a member; all 0: plain.
struct Reinforcement {
  double ratio = 0;       // of all bars; unit: 1; range: 0 to 0.08
  double side_ratio = 0;  // of those near one side, in tension when it bends; unit: 1; range: 0 to ratio
  double cover = 0.04;    // from the surface to the bars' axes; unit: m
  double stirrups = 0;    // what stirrups add to the shear strength; unit: Pa
  Steel steel;            // yield and rupture of the bars
};

// How a member is held by others.
enum class MemberJoint : std::uint8_t {
  cast,    // as one with them, by the weaker material and the bars that both have
  bedded,  // likewise, and what lies on it lies in soft mortar: a lintel
  seated,  // rests on what is below it, free to turn at its ends; units side by side are grouted
  laid,    // boards nailed onto what is below them
};

// Which part of its building a member is, as causes ask for it.
struct MemberPlace {
  int storey = -1;        // -1: none
  int i = -1, j = -1;     // of the column that it is a part of; -1: of none
  std::string part;       // of a plan: its name
  bool infill = false;    // a wall that only loads its frame
  bool bearing = false;   // a wall or column that carries floors
  bool footing = false;   // its lower end, which sinks into the ground with its footing
};

// A box with its material.
struct Member {
  std::string name;                    // as errors name it
  MemberKind kind = MemberKind::beam;  // decides how the member is cut and supported
  Vec3 centre, size;                   // unit: m
  StructuralMaterial material;         // of the whole member
  Reinforcement bars;                  // as shares of its sections
  CutOptions cut;                      // into pieces
  // Below 1: gaps and soft joints let it carry that share only of what it would as one with the frame.
  double stiffness = 1;  // unit: 1; range: above 0 to 1
  MemberJoint joint = MemberJoint::cast;
  int span_axis = 0;  // of a seated member: 0 along X, 1 along Y
  MemberPlace place;
  int variant = 0;  // members of one kind, size, material and cut with the same one share their pieces
};

struct StructurePiece {
  std::int32_t type = 0;    // index into the structure's types
  std::int32_t member = 0;  // index into Structure::members
  Vec3 position;            // of the type's frame; unit: m
  Vec3 centre;              // of mass; unit: m
  double mass = 0;          // unit: kg
  Mat3 inertia;             // about the centre; unit: kg m2
};

struct Bond {
  std::int32_t piece_a = 0, piece_b = 0;  // b may be kFoundation; the section's normal goes from a to b
  Section section;                        // that the bond goes through
  // Force per relative displacement, moment per relative rotation of the two pieces at the section.
  double axial_stiffness = 0, shear_stiffness = 0;                         // unit: N/m
  double torsion_stiffness = 0, bending_s_stiffness = 0, bending_t_stiffness = 0;  // unit: N m/rad
};

struct Structure {
  std::vector<PieceType> types;             // one convex part each, density and friction of their material
  std::vector<std::string> type_materials;  // by type: name of the material
  std::vector<Reinforcement> type_bars;     // by type: of its member
  std::vector<Member> members;              // as designed
  std::vector<StructurePiece> pieces;       // of all members
  std::vector<Bond> bonds;                  // by piece_a, then piece_b
  std::vector<std::int32_t> from_bond;      // by bond: which it was before damage; empty: never damaged
};

// Cuts the members and bonds whatever shares a face: within a member by its material and bars, between
// members by the weaker of the two and the bars that both have. `foundation`: what touches the ground
// z = 0 is bonded to it. Throws InputError naming a member that is flat or overlaps another.
Structure build_structure(const std::vector<Member>& members, std::uint64_t seed,
                          bool foundation = true);

// "beam B of storey 2 (1.2, 3.0, 2.8)": where in the structure a bond is.
std::string describe_bond(const Structure& structure, std::size_t bond);

}  // namespace rubble
