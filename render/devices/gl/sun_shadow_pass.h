// How much of the sun's disc the pixels near edges of shadows see, see
// shaders/sun_shadow.frag.glsl.
#pragma once

#include <utility>
#include <vector>

#include "render/camera/edge_blocks.h"
#include "render/gl/shader.h"

namespace rubble {

class SunShadowPass {
 public:
  static constexpr int kColumns =
      256;  // of blocks in the image that is drawn; as in resolve.frag.glsl

  using Samplers = std::vector<std::pair<const char*, int>>;  // names, and their texture units

  // views: layers of the shadow map that are of the sun, 1 or 2. blocks: the unit of sun_blocks
  // there.
  SunShadowPass(const Gl& gl, int views, Samplers samplers, int blocks);

  // With the block of the frame and the textures bound as for the resolve pass. width, height: of the image. pyramids: as
  // ShadowEdgePass. rays: as the variant of the shaders.
  void draw(int width, int height, const GlBuffer& pyramids, bool rays);

  const GlTexture& numbers() const { return numbers_; }  // of each block of the image; 0: not drawn
  const GlTexture& shares() const {
    return shares_;
  }  // of the blocks by number, in rows of kColumns; of 0 nothing

 private:
  struct Programs {
    GlProgram find, draw;
  };
  const Programs& programs(bool rays);  // made when they are first needed
  void resize(int width, int height);

  const Gl& gl_;
  int views_;
  Samplers samplers_;
  int blocks_unit_;
  Programs programs_[2];
  GlBuffer list_;  // of the blocks, for an indirect drawing
  GlVertexArray empty_array_;
  GlTexture places_, numbers_, shares_;
  GlFramebuffer target_;
  int width_ = 0, height_ = 0;  // of the image
  int rows_ = 0;                // of blocks, where all are drawn
};

}  // namespace rubble
