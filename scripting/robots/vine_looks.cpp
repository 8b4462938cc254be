#include "scripting/robots/vine.h"

#include "scripting/robots/link_shapes.h"

namespace rubble {
namespace {

constexpr int kVineFacets = 28;

}  // namespace

// A case with a drum for the reel across its back, a fan on one side and a collar round the mouth.
TriangleMesh make_vine_base_looks(double r) {
  MeshBuilder out;
  out.look("car_paint");
  add_chamfered_box({6 * r, 4.4 * r, 4 * r}, {-3 * r, 0, r}, 0.12 * r, {}, out);
  out.look("rubber");
  add_chamfered_box({6.1 * r, 4.5 * r, 0.25 * r}, {-3 * r, 0, -0.87 * r}, 0.05 * r, {}, out);
  for (const double side : {-1.0, 1.0}) {
    const Pose hub = facing({-3.6 * r, side * 2.2 * r, r}, {0, side, 0});
    out.look("steel_galvanised");
    add_lathe({{-0.3 * r, 1.5 * r}, {0.25 * r, 1.5 * r}, {0.3 * r, 1.45 * r}}, kVineFacets, hub, out);
    out.look("rubber");
    add_lathe({{-0.1 * r, 0.5 * r}, {0.42 * r, 0.5 * r}, {0.45 * r, 0.46 * r}}, kVineFacets, hub, out);
    out.look("aluminium");
    add_bolt_circle(1.3 * r, 8, 0.07 * r, hub * Pose{{}, {0.3 * r, 0, 0}}, out);
  }
  out.look("steel_galvanised");
  add_lathe({{-0.2 * r, 1.35 * r}, {0.25 * r, 1.35 * r}, {0.35 * r, 1.25 * r}}, kVineFacets, {}, out);
  out.look("rubber");
  add_lathe({{0.2 * r, 1.2 * r}, {0.36 * r, 1.2 * r}}, kVineFacets, {}, out);
  return out.take_smooth(kLooksCrease);
}

// Coated cloth with a welded seam round each link. Its ends reach into its neighbours, so that bends are
// closed.
TriangleMesh make_vine_tube_looks(double r, double length) {
  MeshBuilder out;
  const double wall = 0.985 * r, seam = 0.06 * length, end = 0.35 * r;
  out.look("fabric");
  add_lathe({{-end, 0.86 * wall},
             {-0.5 * end, 0.95 * wall},
             {0, wall},
             {length, wall},
             {length + 0.5 * end, 0.95 * wall},
             {length + end, 0.86 * wall}},
            kVineFacets, {}, out);
  out.look("rubber");
  add_collar({{0.5 * length - seam, 0.97 * wall},
              {0.5 * length - 0.9 * seam, 0.995 * r},
              {0.5 * length + 0.9 * seam, 0.995 * r},
              {0.5 * length + seam, 0.97 * wall}},
             kVineFacets, {}, out);
  return out.take_smooth(kLooksCrease);
}

// A sleeve of a link's length, under which the next links are folded, the turning wall in front of it, and a
// lamp ring with a camera in its middle.
TriangleMesh make_vine_tip_looks(double r, double length) {
  MeshBuilder out;
  const double back = -1.02 * length;
  out.look("car_paint");
  add_lathe({{back, 1.06 * r}, {back + 0.12 * r, 1.1 * r}, {0.1 * r, 1.1 * r}, {0.2 * r, 1.02 * r}}, kVineFacets, {},
            out);
  out.look("fabric");
  add_lathe({{0.05 * r, r}, {0.3 * r, 0.96 * r}, {0.55 * r, 0.84 * r}, {0.78 * r, 0.63 * r}, {0.9 * r, 0.44 * r}},
            kVineFacets, {}, out);
  out.look("steel_galvanised");
  add_lathe({{0.6 * r, 0.46 * r}, {0.96 * r, 0.46 * r}}, kVineFacets, {}, out);
  out.look("rubber");
  add_lathe({{0.95 * r, 0.26 * r}, {1.01 * r, 0.26 * r}}, kVineFacets, {}, out);
  out.look("glass");
  add_lathe({{1.0 * r, 0.22 * r}, {1.02 * r, 0.22 * r}}, kVineFacets, {}, out);
  return out.take_smooth(kLooksCrease);
}

}  // namespace rubble
