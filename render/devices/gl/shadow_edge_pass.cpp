#include "render/devices/gl/shadow_edge_pass.h"

#include <algorithm>

#include "render/gl/gl_traffic.h"
#include "render/gl/shader.h"

namespace rubble {

namespace {

// Mirrors shaders/shadow_edges.frag.glsl.
struct SpreadBlock {
  float ground[4], scale[4];
  std::int32_t spread[4];
};

// Tiles of all levels.
std::size_t pyramid_size(int side) {
  std::size_t out = 1;
  for (; side > 1; side = (side + 1) / 2) out += std::size_t(side) * std::size_t(side);
  return out;
}

}  // namespace

ShadowEdgePass::ShadowEdgePass(const Gl& gl, int side, std::vector<EdgeView> views)
    : gl_(gl),
      views_(std::move(views)),
      map_side_(side),
      side_((side + EdgeView::kTile - 1) / EdgeView::kTile),
      block_(gl),
      pyramids_(gl),
      empty_array_(gl) {
  const ShaderDefines tile{{"TILE", std::to_string(EdgeView::kTile)}};
  ShaderDefines find = tile;
  find.push_back({"FIND", ""});
  find_ = make_program(gl, "fullscreen.vert.glsl", "shadow_edges.frag.glsl", find);
  spread_ = make_program(gl, "fullscreen.vert.glsl", "shadow_edges.frag.glsl", tile);
  pyramid_ = make_compute_program(gl, "edge_pyramid.comp.glsl");
  bind_samplers(gl, pyramid_, {{"shadow_edges", 0}});
  for (const GlProgram* program : {&find_, &spread_}) {
    bind_samplers(gl, *program, {{"shadow_values", 0}, {"tiles", 0}});
    gl.UniformBlockBinding(program->name(), gl.GetUniformBlockIndex(program->name(), "Edges"), 0);
  }
  found_ = make_tiles(int(views_.size()));
  edges_ = make_tiles(int(views_.size()));
  across_ = make_tiles(1);
  into_found_ = make_targets(found_, int(views_.size())), into_edges_ = make_targets(edges_, int(views_.size()));
  into_across_ = make_targets(across_, 1);
  give_buffer(gl, pyramids_.name(), views_.size() * pyramid_size(side_) * 4, nullptr, GL_DYNAMIC_COPY);
}

GlTexture ShadowEdgePass::make_tiles(int layers) const {
  GlTexture tiles(gl_, GLenum(GL_TEXTURE_2D_ARRAY));
  gl_.TextureStorage3D(tiles.name(), 1, GL_RG32UI, side_, side_, GLsizei(layers));
  gl_.TextureParameteri(tiles.name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  gl_.TextureParameteri(tiles.name(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  check_gl(gl_, "making the edges of the shadow map");
  return tiles;
}

std::vector<GlFramebuffer> ShadowEdgePass::make_targets(const GlTexture& tiles, int layers) const {
  std::vector<GlFramebuffer> out;
  for (int layer = 0; layer < layers; ++layer) {
    out.emplace_back(gl_);
    gl_.NamedFramebufferTextureLayer(out.back().name(), GL_COLOR_ATTACHMENT0, tiles.name(), 0, layer);
  }
  return out;
}

void ShadowEdgePass::copy(const GlTexture& from, const GlTexture& to) const {
  gl_.CopyImageSubData(from.name(), GL_TEXTURE_2D_ARRAY, 0, 0, 0, 0, to.name(), GL_TEXTURE_2D_ARRAY, 0, 0, 0, 0,
                       side_, side_, GLsizei(views_.size()));
}

void ShadowEdgePass::find(const GlTexture& values) {
  for (std::size_t layer = 0; layer < views_.size(); ++layer) find_in(values, layer, {{0, 0, side_, side_}});
  build_pyramids();
}

void ShadowEdgePass::keep() {
  kept_found_ = make_tiles(int(views_.size()));
  kept_edges_ = make_tiles(int(views_.size()));
  copy(found_, kept_found_);
  copy(edges_, kept_edges_);
}

void ShadowEdgePass::find_again(const GlTexture& values, const std::vector<std::vector<TexelRect>>& changed) {
  copy(kept_found_, found_);
  copy(kept_edges_, edges_);
  for (std::size_t layer = 0; layer < views_.size(); ++layer) {
    std::vector<TexelRect> tiles;
    // A tile also reads the texels beside it on the right and above.
    for (const TexelRect& r : changed[layer])
      tiles.push_back({(r.x0 - 1) / EdgeView::kTile, (r.y0 - 1) / EdgeView::kTile, r.x1 / EdgeView::kTile + 1, r.y1 / EdgeView::kTile + 1});
    find_in(values, layer, merge_rects(std::move(tiles)));
  }
  build_pyramids();
}

void ShadowEdgePass::build_pyramids() {
  constexpr int kGroup = 8;  // local_size of the shader, along either axis
  gl_.MemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
  gl_.BindTextureUnit(0, edges_.name());
  gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, pyramids_.name());
  gl_.UseProgram(pyramid_.name());
  const GLint level = gl_.GetUniformLocation(pyramid_.name(), "level");
  for (std::size_t layer = 0; layer < views_.size(); ++layer) {
    int first = int(layer * pyramid_size(side_)), before = first;
    for (int side = side_;; side = (side + 1) / 2) {
      gl_.ProgramUniform4i(pyramid_.name(), level, side, first, before, GLint(layer));
      const auto groups = GLuint((side + kGroup - 1) / kGroup);
      gl_.DispatchCompute(groups, groups, 1);
      gl_.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
      before = first, first += side * side;
      if (side == 1) break;
    }
  }
}

void ShadowEdgePass::find_in(const GlTexture& values, std::size_t layer, const std::vector<TexelRect>& tiles) {
  const EdgeView& view = views_[layer];
  const int reach = view.reach();
  const auto set_block = [&](int source_layer, int along_x, int along_y) {
    const SpreadBlock block{{view.ground[0], view.ground[1], view.ground[2], 0},
                          {view.reach_a_depth(),
                           EdgeView::kLeastReach, view.least_step(), 0},
                          {source_layer, along_x, along_y, reach}};
    give_buffer(gl_, block_.name(), sizeof block, &block, GL_STREAM_DRAW);
    gl_.BindBufferBase(GL_UNIFORM_BUFFER, 0, block_.name());
  };
  set_block(int(layer), 0, 0);
  draw(find_, values, into_found_[layer], tiles, 0, 0);
  set_block(int(layer), 1, 0);
  draw(spread_, found_, into_across_[0], tiles, reach, 2 * reach);
  set_block(0, 0, 1);
  draw(spread_, across_, into_edges_[layer], tiles, reach, reach);
}

void ShadowEdgePass::draw(const GlProgram& program, const GlTexture& source, const GlFramebuffer& target,
                          const std::vector<TexelRect>& tiles, int grow_x, int grow_y) {
  gl_.BindFramebuffer(GL_FRAMEBUFFER, target.name());
  gl_.UseProgram(program.name());
  gl_.BindTextureUnit(0, source.name());
  gl_.BindVertexArray(empty_array_.name());
  gl_.Viewport(0, 0, side_, side_);
  gl_.Disable(GL_DEPTH_TEST);
  gl_.Disable(GL_CULL_FACE);
  gl_.Enable(GL_SCISSOR_TEST);
  for (const TexelRect& r : tiles) {
    const int x = std::max(0, r.x0 - grow_x), y = std::max(0, r.y0 - grow_y);
    const int width = std::min(side_, r.x1 + grow_x) - x, height = std::min(side_, r.y1 + grow_y) - y;
    if (width <= 0 || height <= 0) continue;
    gl_.Scissor(x, y, width, height);
    gl_.DrawArrays(GL_TRIANGLES, 0, 3);
  }
  gl_.Disable(GL_SCISSOR_TEST);
  check_gl(gl_, "finding the edges of the shadow map");
}

}  // namespace rubble
