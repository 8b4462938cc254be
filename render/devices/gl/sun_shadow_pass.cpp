#include "render/devices/gl/sun_shadow_pass.h"

#include <cstdio>
#include <string>

#include "render/gl/gl_traffic.h"
#include "render/lighting/lighting.h"
#include "render/passes/shadow_views.h"

namespace rubble {

namespace {

int blocks_in(int pixels) { return (pixels + kEdgeBlock - 1) / kEdgeBlock; }

}  // namespace

SunShadowPass::SunShadowPass(const Gl& gl, int views, Samplers samplers, int blocks)
    : gl_(gl), views_(views), samplers_(std::move(samplers)), blocks_unit_(blocks), list_(gl), empty_array_(gl) {
  samplers_.push_back({"sun_blocks", blocks});
}

const SunShadowPass::Programs& SunShadowPass::programs(bool rays) {
  Programs& wanted = programs_[rays];
  if (wanted.find) return wanted;
  char radius[32];
  std::snprintf(radius, sizeof radius, "%.9e", double(kSunRadius));
  ShaderDefines defines{{"VIEWS", std::to_string(views_)},
                        {"SUN_RADIUS", radius},
                        {"EDGE_TILE", std::to_string(EdgeView::kTile)}};
  if (rays) defines.push_back({"RAYS", ""});
  wanted.find = make_compute_program(gl_, "edge_blocks.comp.glsl", defines);
  wanted.draw = make_program(gl_, "edge_blocks.vert.glsl", "sun_shadow.frag.glsl", defines);
  for (const GlProgram* program : {&wanted.find, &wanted.draw}) {
    bind_samplers(gl_, *program, samplers_);
    gl_.UniformBlockBinding(program->name(), gl_.GetUniformBlockIndex(program->name(), "Frame"), 0);
  }
  return wanted;
}

void SunShadowPass::resize(int width, int height) {
  if (width == width_ && height == height_) return;
  width_ = width, height_ = height;
  const int across = blocks_in(width), down = blocks_in(height);
  rows_ = across * down / kColumns + 1;
  numbers_ = make_target(gl_, GL_R32UI, across, down);
  places_ = make_target(gl_, GL_RG32UI, kColumns, rows_);
  shares_ = make_target(gl_, GL_R8, kColumns * kEdgeBlock, rows_ * kEdgeBlock);
  target_ = GlFramebuffer(gl_);
  gl_.NamedFramebufferTexture(target_.name(), GL_COLOR_ATTACHMENT0, shares_.name(), 0);
  const float none[4] = {0, 0, 0, 0};  // the first block is none
  gl_.ClearNamedFramebufferfv(target_.name(), GL_COLOR, 0, none);
  check_gl(gl_, "making the image of the sun's shadows");
}

void SunShadowPass::draw(int width, int height, const GlBuffer& pyramids, bool rays) {
  constexpr int kGroup = 8;  // local_size of the shader, along either axis
  resize(width, height);
  const Programs& use = programs(rays);
  const std::uint32_t none[4] = {6, 0, 0, 0};
  give_buffer(gl_, list_.name(), sizeof none, none, GL_STREAM_DRAW);
  gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, list_.name());
  gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, pyramids.name());
  gl_.BindImageTexture(0, numbers_.name(), 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_R32UI);
  gl_.BindImageTexture(1, places_.name(), 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RG32UI);
  gl_.UseProgram(use.find.name());
  const auto groups = [](int blocks) { return GLuint((blocks + kGroup - 1) / kGroup); };
  gl_.DispatchCompute(groups(blocks_in(width)), groups(blocks_in(height)), 1);
  gl_.MemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
  gl_.BindTextureUnit(GLuint(blocks_unit_), places_.name());
  gl_.BindFramebuffer(GL_FRAMEBUFFER, target_.name());
  gl_.UseProgram(use.draw.name());
  gl_.ProgramUniform2i(use.draw.name(), gl_.GetUniformLocation(use.draw.name(), "size"), kColumns * kEdgeBlock,
                       rows_ * kEdgeBlock);
  gl_.Viewport(0, 0, kColumns * kEdgeBlock, rows_ * kEdgeBlock);
  gl_.Disable(GL_DEPTH_TEST);
  gl_.Disable(GL_CULL_FACE);
  gl_.BindVertexArray(empty_array_.name());
  gl_.BindBuffer(GL_DRAW_INDIRECT_BUFFER, list_.name());
  gl_.DrawArraysIndirect(GL_TRIANGLES, nullptr);
}

}  // namespace rubble
