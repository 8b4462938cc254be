// Contact darkness and shadows of the lamp from the depth image, at half its size: see shaders/contact.frag.glsl.
#pragma once

#include "render/gl_objects.h"
#include "render/projection.h"

namespace rubble {

class ContactPass {
 public:
  ContactPass(const Gl& gl, bool lamp);

  // depth: near / Z, of the view's size. lamp: in the optical frame, with its radius; unit: m
  void draw(const ViewProjection& view, const GlTexture& depth, const Vec3f& lamp, float radius);
  // 1: open, 0: closed in; and the lamp: 1: in sight, 0: hidden.
  const GlTexture& openness() const { return openness_; }

 private:
  void resize(int width, int height);

  const Gl& gl_;
  GlProgram program_, blur_;
  GlBuffer block_;
  GlVertexArray empty_array_;
  GlTexture raw_, openness_;
  GlFramebuffer raw_target_, target_;
  int width_ = 0, height_ = 0;
};

}  // namespace rubble
