// Shadows of the lamp from the depth image, at half its size: see shaders/contact.frag.glsl.
#pragma once

#include "render/camera/projection.h"
#include "render/colour/view_lamp.h"
#include "render/gl/gl_objects.h"

namespace rubble {

class ContactPass {
 public:
  explicit ContactPass(const Gl& gl);

  // depth: near / Z, of the view's size.
  void draw(const ViewProjection& view, const GlTexture& depth, const ContactLamp& lamp);
  // 1: the lamp is in sight, 0: hidden.
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
