// A pile cut open by a vertical plane across Y: what is left behind it, and the faces of the cut.
#pragma once

#include <vector>

#include "render/scene/scene.h"

namespace rubble {

// Where the plane cuts a piece: segments in X and Z, each with the piece on one side; unit: m
struct CutSegment {
  double x0 = 0, z0 = 0, x1 = 0, z1 = 0;  // its ends; unit: m
};
struct CutFace {
  std::uint32_t instance = 0;        // SceneInstance::id
  std::vector<CutSegment> segments;  // in no order
};

struct PileSection {
  Scene scene;                     // the pieces, and parts of pieces, with y > the plane's
  std::vector<CutFace> faces;      // one for every piece that is cut
  double x0 = 0, x1 = 0, top = 0;  // of what is behind the plane; unit: m
};

// Cut pieces are open where the plane went through: the faces say where they were solid. Meshes that
// are cut keep their finest level only.
PileSection cut_pile(const Scene& scene, double y);

// The insides of a face along the line at height z: from x[0] to x[1], from x[2] to x[3] ...
std::vector<double> find_insides(const CutFace& face, double z);

}  // namespace rubble
