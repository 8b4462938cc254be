// The light of the camera's lamp by way of surfaces, found anew for each place of the lamp.
//
// The map of LampReach says which points of the bake the lamp lights. Their light goes on over the points' links, which the
// bake has kept (direct-to-indirect transfer: Hasan et al. 2006), to the pieces that the lamp may see: once, and a second time together with
// the first, whose share stands for all further times. The second time is done for the triangles alone that
// the picture shows. So its cost goes with what is about the lamp and with what shows, and its noise lies
// still on the surfaces.
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/base/parallel.h"
#include "render/lighting/bake.h"
#include "render/transport/fog_light.h"
#include "render/transport/lamp_reach.h"

namespace rubble {

class LampBounce {
 public:
  // The scene, the bake of the links and the pool must outlive it. links: of what rests there; what moves gets nothing.
  // first_point: of each placed mesh in turn, in the links; kNoPoints: it is not among them.
  static constexpr std::uint32_t kNoPoints = 0xffffffffu;
  LampBounce(const PreparedScene& scene, const BakeLinks& links, const std::vector<std::uint32_t>& first_point,
             ThreadPool& pool);

  struct Shown {
    std::uint32_t placed;    // which placed mesh
    std::uint32_t triangle;  // of its prepared mesh
  };
  // Finds which points the lamp lights. reach: stays as it is until the next call.
  void set_lamp(const LampReach& reach);
  // No flat white surface sends more of this lamp's indirect light: radiance, in the colour that there is most of.
  float most_radiance() const;
  // `base`, and that light at the nodes of the triangles that show, in any order, some perhaps more than
  // once. fog: gets the lamp's light, and gives back what the air scatters of it; null: the air is clear.
  // version: another number whenever `base` has changed.
  const LightTable& add_to(const LightTable& base, std::uint64_t version,
                                        const std::vector<Shown>& shown, FogLight* fog);
  // `base` of that version has got light in those ranges, where it had none.
  void change_base(const LightTable& base, std::uint64_t version, const std::vector<LightRange>& ranges);
  // Where that differs from `base`, of the last add_to() or, if it was of the same base, the last two. Of each
  // placed mesh at most one range of each, in order.
  const std::vector<LightRange>& changed() const { return changed_; }

 private:
  struct Arrived {
    Vec3f colour, vector;  // illuminance; dot(n, vector) is its strength on a normal n
  };
  using Light = AirTransfer::Colour;  // the last is 0, so that all are added at once
  struct ShownNode {
    std::uint32_t placed, node;  // of its mesh
  };

  void light_points();
  void restore(const LightTable& base, std::uint64_t version);
  void find_shown(const std::vector<Shown>& shown);
  void add_shown_to_changed();
  void show_node(std::uint32_t placed, std::uint32_t node);
  float passes(std::size_t from, std::size_t to) const;
  void mark_lit();
  Vec3f gather_colour(std::size_t point) const;
  Arrived gather(std::size_t point) const;
  template <typename Work>
  void for_seen(const Work& work);
  std::size_t count_points(std::uint32_t piece) const;
  float share_again() const;
  void pass_on();
  void add_to_node(const ShownNode& shown, const LightTable& base, const FogLight* fog);

  const PreparedScene& scene_;
  BakeLinks links_;
  std::vector<std::uint32_t> first_point_;
  ThreadPool& pool_;
  const LampReach* reach_ = nullptr;
  float extinction_ = 0;                  // of the air about the lamp; unit: 1/m
  std::uint64_t version_ = 0;             // of the base that out_ is made of; 0: none
  std::vector<std::uint64_t> lit_;        // a bit for each point that is, for gather_colour()
  std::vector<std::uint32_t> seen_;       // placed meshes that the lamp may see
  std::vector<std::uint8_t> is_seen_;     // of each placed mesh
  std::vector<ShownNode> shown_nodes_;    // of the seen, each once
  std::vector<std::uint32_t> shown_points_;            // about them, each once
  UntouchedTable<std::uint8_t> node_shows_, point_shows_;  // of each node and point, of which few are about the lamp
  std::vector<Light> radiance_;           // of each point, matt: of its direct light, then of all
  UntouchedTable<Vec3f> once_;            // illuminance at each point of the seen by one bounce
  UntouchedTable<Arrived> arrived_;       // at each point that shows, by all bounces
  LightTable out_;
  std::vector<LightRange> changed_;
};

}  // namespace rubble
