#include "render/devices/gl/sun_shadow_pass.h"

#include <algorithm>
#include <cstdio>
#include <cstring>

#include "render/gl/gl_traffic.h"
#include "render/lighting/lighting.h"
#include "render/passes/shadow_views.h"

namespace rubble {

namespace {

int blocks_in(int pixels) { return (pixels + kEdgeBlock - 1) / kEdgeBlock; }

}  // namespace

SunShadowPass::SunShadowPass(const Gl& gl, int views, Samplers samplers, int blocks)
    : gl_(gl),
      views_(views),
      samplers_(std::move(samplers)),
      blocks_unit_(blocks),
      empty_array_(gl) {
  samplers_.push_back({"sun_blocks", blocks});
}

const GlProgram& SunShadowPass::program(bool rays) {
  GlProgram& wanted = programs_[rays];
  if (wanted) return wanted;
  char radius[32];
  std::snprintf(radius, sizeof radius, "%.9e", double(kSunRadius));
  ShaderDefines defines{{"VIEWS", std::to_string(views_)},
                        {"SUN_RADIUS", radius},
                        {"EDGE_TILE", std::to_string(EdgeView::kTile)}};
  if (rays) defines.push_back({"RAYS", ""});
  wanted = make_program(gl_, "fullscreen.vert.glsl", "sun_shadow.frag.glsl", defines);
  bind_samplers(gl_, wanted, samplers_);
  gl_.UniformBlockBinding(wanted.name(), gl_.GetUniformBlockIndex(wanted.name(), "Frame"), 0);
  return wanted;
}

void SunShadowPass::resize(int width, int height) {
  if (width == width_ && height == height_) return;
  width_ = width, height_ = height;
  const int across = blocks_in(width), down = blocks_in(height);
  const int rows = across * down / kColumns + 1;
  numbers_ = make_target(gl_, GL_R32UI, across, down);
  places_ = make_target(gl_, GL_RG32UI, kColumns, rows);
  shares_ = make_target(gl_, GL_R8, kColumns * kEdgeBlock, rows * kEdgeBlock);
  target_ = GlFramebuffer(gl_);
  gl_.NamedFramebufferTexture(target_.name(), GL_COLOR_ATTACHMENT0, shares_.name(), 0);
  check_gl(gl_, "making the image of the sun's shadows");
}

void SunShadowPass::set_blocks(const std::vector<EdgeBlock>& blocks, int width, int height) {
  resize(width, height);
  const int across = blocks_in(width), down = blocks_in(height);
  rows_ = int(blocks.size()) / kColumns + 1;
  std::vector<std::uint32_t> numbers(std::size_t(across) * std::size_t(down));
  // The first is none: of what it shows nothing is known.
  std::vector<std::uint32_t> places(std::size_t(rows_) * kColumns * 2, 0xffffffffu);
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const EdgeBlock& block = blocks[i];
    numbers[(block.place >> 16) * std::size_t(across) + (block.place & 65535)] =
        std::uint32_t(i + 1);
    places[2 * i + 2] = block.place;
    std::memcpy(&places[2 * i + 3], &block.nearest, sizeof block.nearest);
  }
  give_image(gl_, numbers_.name(), 0, {0, 0, 0, across, down}, GL_RED_INTEGER, GL_UNSIGNED_INT, numbers.data());
  give_image(gl_, places_.name(), 0, {0, 0, 0, kColumns, rows_}, GL_RG_INTEGER, GL_UNSIGNED_INT, places.data());
}

void SunShadowPass::draw(bool rays) {
  gl_.BindTextureUnit(GLuint(blocks_unit_), places_.name());
  gl_.BindFramebuffer(GL_FRAMEBUFFER, target_.name());
  gl_.UseProgram(program(rays).name());
  gl_.Viewport(0, 0, kColumns * kEdgeBlock, rows_ * kEdgeBlock);
  gl_.Disable(GL_DEPTH_TEST);
  gl_.Disable(GL_CULL_FACE);
  gl_.BindVertexArray(empty_array_.name());
  gl_.DrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace rubble
