#include "render/devices/software/shadow_map.h"

#include <algorithm>

namespace rubble {

SoftwareShadowMap::SoftwareShadowMap(const PreparedScene& scene, const LightSet& lights,
                                     const std::vector<ClusterShapes>& shapes, int most_side, ThreadPool& pool)
    : scene_(scene), lights_(lights), views_(scene, lights, most_side), raster_(scene, shapes, pool) {
  for (const PlacedMesh& piece : scene.placed) moves_ = moves_ || piece.moves;
  texels_.resize(views_.rows.size() * texels_a_view());
  for (std::size_t view = 0; view < views_.rows.size(); ++view) clear(view), draw(view, ShadowPart::resting);
  std::vector<EdgeView> sun = views_.sun_edges();
  if (!sun.empty()) {
    edges_ = std::make_unique<ShadowEdges>(views_.side, std::move(sun), pool);
    edges_->find(texels_);
  }
  if (!moves_) return;
  const std::size_t first_carried = lights.first_carried();
  const std::size_t resting = first_carried < views_.lights.size() ? std::size_t(views_.lights[first_carried].first_view)
                                                                   : views_.rows.size();
  resting_.assign(texels_.begin(), texels_.begin() + std::ptrdiff_t(resting * texels_a_view()));
  if (edges_) edges_->keep();
  moved_.resize(views_.rows.size());
}

void SoftwareShadowMap::clear(std::size_t view) {
  const auto first = texels_.begin() + std::ptrdiff_t(view * texels_a_view());
  std::fill(first, first + std::ptrdiff_t(texels_a_view()), 1.0f);
}

void SoftwareShadowMap::draw(std::size_t view, ShadowPart part) {
  raster_.draw(views_.rows[view], part, views_.side, texels_.data() + view * texels_a_view());
}

void SoftwareShadowMap::restore(std::size_t view, const TexelRect& rect) {
  const int side = views_.side;
  const int x0 = std::max(rect.x0, 0), x1 = std::min(rect.x1, side);
  if (x0 >= x1) return;
  for (int y = std::max(rect.y0, 0); y < std::min(rect.y1, side); ++y) {
    const auto at = std::ptrdiff_t(view * texels_a_view() + std::size_t(y) * std::size_t(side));
    std::copy(resting_.begin() + at + x0, resting_.begin() + at + x1, texels_.begin() + at + x0);
  }
}

void SoftwareShadowMap::move() {
  if (!moves_) return;
  if (lights_.carried > 0) views_.place(scene_, lights_);
  for (std::size_t i = 0; i < views_.lights.size(); ++i) {
    const ShadowViews::Light& light = views_.lights[i];
    for (auto view = std::size_t(light.first_view); view < std::size_t(light.first_view + light.views); ++view) {
      if (i >= lights_.first_carried()) {
        clear(view), draw(view, ShadowPart::all);
        continue;
      }
      if (light.directional) {
        for (const TexelRect& rect : merge_rects(std::move(moved_[view]))) restore(view, rect);
        moved_[view] = views_.moving_rects(scene_, view);
      } else {
        restore(view, {0, 0, views_.side, views_.side});
      }
      draw(view, ShadowPart::moving);
    }
  }
  if (!edges_) return;
  const auto layers = std::ptrdiff_t(views_.lights.front().views);
  edges_->find_again(texels_, {moved_.begin(), moved_.begin() + layers});
}

}  // namespace rubble
