// The shadow maps of all lights. What rests is drawn once, what moves whenever it has moved, and all that a carried
// light sees whenever that is. Internal to render/devices/software.
#pragma once

#include <memory>
#include <vector>

#include "render/devices/software/shadow_edges.h"
#include "render/devices/software/shadow_raster.h"
#include "render/passes/shadow_views.h"

namespace rubble {

class SoftwareShadowMap {
 public:
  // What they refer to must outlive it. shapes: one a mesh. most_side: as ShadowViews.
  SoftwareShadowMap(const PreparedScene& scene, const LightSet& lights, const std::vector<ClusterShapes>& shapes,
                    int most_side, ThreadPool& pool);

  // Pieces and carried lights are where they are in the scene now.
  void move();

  const ShadowViews& views() const { return views_; }
  const std::vector<float>& texels() const { return texels_; }  // layer by layer
  // Of the layers of the main light; empty: that is no sun.
  const std::vector<EdgePyramid>& edges() const { return edges_ ? edges_->pyramids() : none_; }

 private:
  void draw(std::size_t view, ShadowPart part);
  void clear(std::size_t view);
  void restore(std::size_t view, const TexelRect& rect);  // what rests there
  std::size_t texels_a_view() const { return std::size_t(views_.side) * std::size_t(views_.side); }

  const PreparedScene& scene_;
  const LightSet& lights_;
  ShadowViews views_;
  ShadowRaster raster_;
  bool moves_ = false;
  std::unique_ptr<ShadowEdges> edges_;
  std::vector<EdgePyramid> none_;
  std::vector<float> texels_, resting_;  // resting_: of lights that are not carried; only where something moves
  std::vector<std::vector<TexelRect>> moved_;  // by view: where something moved is now
};

}  // namespace rubble
