// The lamp's light by way of surfaces, by the card: what transport/lamp_bounce.h finds on the processor, in the shaders lamp_*.
// Internal to render/devices/gl.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <vector>

#include "render/device/device_lamp.h"
#include "render/devices/gl/gl_geometry.h"
#include "render/devices/gl/lamp_fog_pass.h"
#include "render/lighting/bake.h"

namespace rubble {

class LampPass : public DeviceLamp {
 public:
  // As DeviceScene::lamp(). The scene and the geometry must outlive it.
  LampPass(const Gl& gl, const PreparedScene& scene, const GlGeometry& geometry, const BakeLinks& links,
           const std::vector<std::uint32_t>& first_point);

  void light(const LampAim& aim, const LampAir* air) override;
  void put_out() override;

  // Finds what is asked for and not yet found. frame: the buffer of the FrameBlock of the picture.
  void find(const GlBuffer& frame);
  // Of a picture by its numbers of triangles, as GlRaster::id_texture(): light at all nodes that it shows.
  const GlTexture& light_of(const GlTexture& ids, int width, int height);
  bool is_lit() const { return lit_by_.has_value(); }
  // What the air scatters of it; null: nobody looks for that.
  const LampFogPass* fog() const { return is_lit() ? fog_shown_ : nullptr; }

 private:
  struct Programs {
    GlProgram send, once, share, again, shown, arrive, nodes, nodes_in_fog, restore;
  };
  void give_scene(const PreparedScene& scene, const BakeLinks& links, const std::vector<std::uint32_t>& first_point);
  void give_aim();
  void pass_on();
  void run(const GlProgram& program, std::initializer_list<GLuint> buffers, std::uint32_t count);
  void run(const GlProgram& program, std::initializer_list<GLuint> buffers, const GlBuffer& list);  // of work
  void restore();
  void mark_shown(int width, int height);

  const Gl& gl_;
  const PreparedScene& scene_;
  const GlGeometry& geometry_;
  std::uint32_t links_a_point_;
  std::size_t point_count_ = 0;
  std::vector<std::uint32_t> first_point_;  // of each placed mesh
  Programs programs_;
  // Of the scene.
  GlBuffer points_, links_, pieces_, nodes_, node_points_, piece_rows_;
  GlTexture piece_rows_view_;
  // Of the lamp.
  GlBuffer aim_, seen_, seen_pieces_, map_, radiance_, lit_, once_, sums_, share_;
  // Of a picture. node_list_: whose light in shown_ is the lamp's, too, until restore().
  GlBuffer node_shows_, point_shows_, node_list_, point_list_, arrived_, shown_;
  GlTexture shown_view_;
  std::uint32_t seen_points_ = 0;
  std::uint64_t base_version_ = 0;  // of the light that shown_ is made of; 0: none
  bool shows_ = false;              // some nodes of shown_ have the lamp's light
  std::optional<LampAim> lit_by_;  // none: the lamp is out
  std::optional<LampAir> air_;     // none: its light is not looked for there
  bool pending_ = false;
  std::unique_ptr<LampFogPass> fog_;  // made when it is first needed
  const LampFogPass* fog_shown_ = nullptr;
};

}  // namespace rubble
