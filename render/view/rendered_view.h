// One view of a scene, which is asked for its channels: colour, depth, ground truth.
//
//   RenderedView view = renderer.view(rays);
//   view.depth(), view.rgb(), view.truth(*find_image_stream("normals")) ...
//
// A channel is made when it is first asked for, and once. In which order channels are asked for, and
// which other views are drawn meanwhile, does not change a bit of them. Images have rows from the top.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "render/camera/view_rays.h"
#include "render/colour/light_watch.h"
#include "render/media/medium.h"
#include "render/scene/camera_spec.h"
#include "render/scene/frame.h"
#include "render/view/render_options.h"

namespace rubble {

struct ViewSource;  // what a renderer draws with

// A view before exposure and tone mapping, for tests and sensors.
struct LinearFrame {
  int width = 0, height = 0;            // unit: pixel
  std::vector<float> rgb;               // radiance; unit: kcd/m2
  std::vector<float> depth;             // as in Frame
  std::vector<float> distance;          // the same along each pixel's ray
  std::vector<std::uint32_t> instance;  // SceneInstance::id; kNoInstance, kGroundInstance
};

class RenderedView {
 public:
  // As Renderer::view().
  RenderedView(ViewSource& source, const ViewRays& rays, const ViewRays* next);
  ~RenderedView();
  RenderedView(RenderedView&&) noexcept;
  RenderedView& operator=(RenderedView&&) noexcept;

  const ViewRays& rays() const;

  // Asks a device that runs ahead for rgb() or radiance(), and depth: others may be drawn before these are read, so that it
  // always has work. No effect where the processor draws.
  enum class Begun { rgb, radiance };
  void begin(Begun what = Begun::rgb);

  // Planar: along the optical axis; NaN: nothing there, or beside and behind the camera; unit: m.
  const std::vector<float>& depth();
  // Along each pixel's ray; NaN: nothing; unit: m.
  const std::vector<float>& distances();
  // SceneInstance::id; kNoInstance, kGroundInstance.
  std::vector<std::uint32_t> instances();

  // Colours at the exposure that this view asks for, 3 bytes a pixel.
  const std::vector<std::uint8_t>& rgb();
  // That exposure: what luminance in kcd/m2 is multiplied by.
  float exposure();
  // Colours at another exposure; not kept.
  std::vector<std::uint8_t> rgb_at(float exposure);
  // Before exposure and tone mapping, 3 floats a pixel; unit: kcd/m2.
  const std::vector<float>& radiance();
  // As ColourPass::draw_changes(). watch: of the renderer.
  std::vector<LightChange> light_changes(LightWatch& watch);

  // A stream of ground truth (ImageStream::is_truth).
  const ImageValues& truth(const ImageStream& stream);
  // The same for several in one pass over the image: those that were not made yet.
  void make_truth(const StreamSet& streams);
  // 1 where a place in the camera body frame has a free line to the surface, else 0.
  std::vector<std::uint8_t> line_of_sight_mask(const Vec3& place_in_camera);
  // Each surface's share of light just beyond red that it throws back; 0: nothing there.
  std::vector<float> albedos();
  // How far each pixel's surface moves until another stamp, in the world; empty where nothing in the
  // scene moves, zero where nothing is seen or it is not there then. unit: m
  std::vector<Vec3f> shifts(std::int64_t stamp_ns);
  // What hangs in the air at the view's stamp.
  Air air() const;

  // Of what was made so far.
  const RenderTimes& times() const;

  // What the view gives away: nothing can be asked of it afterwards.
  // Colour, depth and these streams of ground truth. index: Frame::index.
  Frame into_frame(int index, const StreamSet& streams = {}) &&;
  LinearFrame into_linear_frame() &&;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace rubble
