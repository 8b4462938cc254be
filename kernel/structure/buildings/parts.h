// Parts of a building that were drawn over each other, as members that share faces at most.
#pragma once

#include <string>
#include <vector>

#include "kernel/base/random.h"
#include "kernel/model/building.h"
#include "kernel/structure/structure.h"

namespace rubble {

struct BuildingPart {
  Member member;            // its box is what was drawn
  int rank = 0;             // parts of a lower rank take their place first, then those drawn first
  std::vector<Aabb> holes;  // taken out of it: windows, openings for stairs
  bool whole = false;       // it is one piece
  double above = 0;         // what it takes of others above its box: the pocket of a joist; unit: m
};

// Their order of places, where several are in one.
enum PartRank : int { kBeamRank, kSlabRank, kJoistRank, kColumnRank, kLintelRank, kWallRank, kDeckRank };

Aabb box_of(const Member& member);
void set_box(Member& member, const Aabb& box);
bool overlap(const Aabb& a, const Aabb& b);  // not where they only touch
const StructuralMaterial& material_of(Infill infill);

// The largest boxes of `from` outside of `taken`; a wall is split along its length first.
std::vector<Aabb> subtract(const Aabb& from, const Aabb& taken, const int (&axes)[3]);

// What is left of each part, as members cut into pieces. Slivers below 2 cm are left out.
std::vector<Member> resolve_parts(std::vector<BuildingPart> parts, const BuildingSpec& building,
                                  RandomStream& random);

// Bars of a member: a share of its section, 0.4 of them near one side.
Reinforcement make_bars(double ratio, double stirrups, double cover);

// Equal members share one of this many cuts: few enough types, and no visible repetition. unit: 1
inline constexpr int kVariants = 3;
// Shear strength by the stirrups of columns and beams; two legs of 8 mm every 0.2 m in 0.4 m give 0.7 MPa.
// unit: Pa
inline constexpr double kStirrups = 0.8e6;
// Bars of slabs act as dowels where loads are carried by few of the coarse pieces; our choice. unit: Pa
inline constexpr double kDowels = 0.5e6;
// Infill stands in its frame with gaps at the top and sides, and cracks away long before the frame bends:
// it loads the frame and hardly stiffens it.
inline constexpr double kInfillStiffness = 0.01;  // unit: 1
// Pressed concrete fails along planes of 45 degrees and half its angle of friction, 33 degrees (Mohr and
// Coulomb): what is left of a column slides off instead of standing as a stack. unit: 1
inline constexpr double kColumnSlope = 1.85;
inline constexpr double kWindowSill = 0.35;  // height of a window's lower edge, as a share of the wall's height; unit: 1
inline constexpr double kWindowHead = 0.8;   // height of a window's upper edge, as a share of the wall's height; unit: 1
inline constexpr double kDoorWidth = 0.9;   // clear; unit: m
inline constexpr double kDoorHeight = 2.0;  // clear; unit: m

// "wall (1, 0) of storey 2"
std::string place_name(const std::string& what, int storey, int i, int j);

// Cuts what sinks into the ground off the lower ends of columns whose footings will: see CollapseCause::sinking.
void add_footings(const BuildingSpec& building, std::vector<Member>& members);

// The members of each kind of building, as it stands before its cause.
std::vector<Member> make_frame(const BuildingSpec& building);
std::vector<Member> make_masonry(const BuildingSpec& building);
std::vector<Member> make_precast(const BuildingSpec& building);
std::vector<Member> make_bridge(const BuildingSpec& building);
std::vector<Member> make_planned(const BuildingSpec& building);
// What a frame may have beside its columns, beams, slabs and outer walls. Changes its slabs where stairs and
// shafts go through them.
void add_partitions(const BuildingSpec& building, std::vector<BuildingPart>& parts);
void add_parapet(const BuildingSpec& building, double width, std::vector<BuildingPart>& parts);
void add_stairs(const BuildingSpec& building, const BayPlace& bay, std::vector<BuildingPart>& parts,
                std::vector<Aabb>& openings);
void add_core(const BuildingSpec& building, const BayPlace& bay, std::vector<BuildingPart>& parts,
              std::vector<Aabb>& openings);
// The length of a flight of stairs. unit: m
double calc_flight(const BuildingSpec& building);

// Grid lines; unit: m.
inline double x_of(const BuildingSpec& b, double i) { return (i - b.bays_x / 2.0) * b.span_x; }
inline double y_of(const BuildingSpec& b, double j) { return (j - b.bays_y / 2.0) * b.span_y; }

// Calls for each place of a storey's grid: corner(i, j), side(i, j, along_x) and bay(i, j), in this order.
template <typename Corner, typename Side, typename Bay>
void visit_grid(const BuildingSpec& b, const Corner& corner, const Side& side, const Bay& bay) {
  const auto visit = [](int columns, int rows, const auto& place) {
    for (int j = 0; j < rows; ++j)
      for (int i = 0; i < columns; ++i) place(i, j);
  };
  visit(b.bays_x + 1, b.bays_y + 1, corner);
  visit(b.bays_x, b.bays_y + 1, [&](int i, int j) { side(i, j, true); });
  visit(b.bays_x + 1, b.bays_y, [&](int i, int j) { side(i, j, false); });
  visit(b.bays_x, b.bays_y, bay);
}

// Floors and lintels that several kinds of building have.

inline constexpr double kLintel = 0.2;       // depth of a lintel of reinforced concrete; unit: m
inline constexpr double kBoards = 0.04;      // thickness of the boards of timber floors; unit: m
inline constexpr double kLintelBears = 0.2;  // on either side of its opening; unit: m

BuildingPart make_lintel(const std::string& name, int storey, const Aabb& box);

// Joists across the shorter side of a room, which enter the walls by `bearing`, and boards on them whose upper
// side is the room's top.
void add_timber_floor(const BuildingSpec& building, const Aabb& room, double bearing, const std::string& name,
                      int storey, const std::string& plan_part, std::vector<BuildingPart>& parts);

}  // namespace rubble
