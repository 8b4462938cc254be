#include "render/devices/gl/contact_pass.h"

#include <algorithm>

#include "render/gl/gl_traffic.h"
#include "render/gl/shader.h"

namespace rubble {

ContactPass::ContactPass(const Gl& gl)
    : gl_(gl),
      program_(make_program(gl, "fullscreen.vert.glsl", "contact.frag.glsl", {{"LAMP_STEPS", "8"}})),
      blur_(make_program(gl, "fullscreen.vert.glsl", "contact_blur.frag.glsl")),
      block_(gl),
      empty_array_(gl) {
  bind_samplers(gl, program_, {{"depth_values", 0}});
  gl.UniformBlockBinding(program_.name(), gl.GetUniformBlockIndex(program_.name(), "Contact"), 0);
  bind_samplers(gl, blur_, {{"contact", 0}});
}

void ContactPass::resize(int width, int height) {
  if (width == width_ && height == height_) return;
  width_ = width, height_ = height;
  const auto make = [&](GlTexture& texture, GlFramebuffer& target) {
    texture = make_target(gl_, GL_R8, width, height);
    gl_.TextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    gl_.TextureParameteri(texture.name(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    target = GlFramebuffer(gl_);
    gl_.NamedFramebufferTexture(target.name(), GL_COLOR_ATTACHMENT0, texture.name(), 0);
  };
  make(raw_, raw_target_);
  make(openness_, target_);
  check_gl(gl_, "making the contact buffer");
}

void ContactPass::draw(const ViewProjection& view, const GlTexture& depth, const ContactLamp& lamp) {
  const Intrinsics& k = view.intrinsics;
  resize(std::max(1, (k.width + 1) / 2), std::max(1, (k.height + 1) / 2));
  const float block[12] = {float(k.fx),  float(k.fy),  float(k.cx),  float(k.cy), lamp.place.x, lamp.place.y,
                           lamp.place.z, lamp.radius, kNearPlane, 0, 0, 0};
  give_buffer(gl_, block_.name(), sizeof block, block, GL_STREAM_DRAW);
  gl_.BindBufferBase(GL_UNIFORM_BUFFER, 0, block_.name());
  gl_.Viewport(0, 0, width_, height_);
  gl_.Disable(GL_DEPTH_TEST);
  gl_.Disable(GL_CULL_FACE);
  gl_.BindVertexArray(empty_array_.name());
  const auto run = [&](const GlProgram& program, const GlTexture& source, const GlFramebuffer& target) {
    gl_.BindTextureUnit(0, source.name());
    gl_.BindFramebuffer(GL_FRAMEBUFFER, target.name());
    gl_.UseProgram(program.name());
    gl_.DrawArrays(GL_TRIANGLES, 0, 3);
  };
  run(program_, depth, raw_target_);
  run(blur_, raw_, target_);
}

}  // namespace rubble
