#include "bench/images/compared_view.h"

#include <chrono>
#include <ctime>

#include "bench/images/image_measures.h"
#include "render/passes/antialias.h"
#include "render/reference/display.h"

namespace rubble {

namespace {

std::vector<float> luminance_of(const LinearFrame& frame) {
  std::vector<float> out;
  for (std::size_t i = 0; i < frame.rgb.size(); i += 3)
    out.push_back(0.2126f * frame.rgb[i] + 0.7152f * frame.rgb[i + 1] + 0.0722f * frame.rgb[i + 2]);
  return out;
}

float exposure_of(const LinearFrame& reference, const Vec3f& gains) {
  return find_exposure({0.21, 0}, meter_image(reference.rgb, reference.width, reference.height, gains));
}

Picture develop(const LinearFrame& frame, const Vec3f& gains, float exposure) {
  const std::vector<std::uint8_t> rgba = develop_image(frame.rgb, frame.width, frame.height, gains, exposure);
  Picture out{frame.width, frame.height, {}};
  for (std::size_t i = 0; i < rgba.size(); i += 4)
    out.rgb.insert(out.rgb.end(), {rgba[i], rgba[i + 1], rgba[i + 2]});
  return out;
}

// As a camera gets it: with the stairs along silhouettes smoothed, as paths at random places of a pixel do.
Picture develop_fast(const LinearFrame& frame, const Vec3f& gains, float exposure, int threads) {
  std::vector<float> depth_values;
  for (const float depth : frame.depth) depth_values.push_back(depth > 0 ? kNearPlane / depth : 0);
  Picture out{frame.width, frame.height, {}};
  ThreadPool pool(threads);
  smooth_edges(develop_image(frame.rgb, frame.width, frame.height, gains, exposure), depth_values, frame.width,
               frame.height, pool, out.rgb);
  return out;
}

Luma luma_of(const Picture& picture) { return rubble::luma_of(picture.rgb.data(), picture.width, picture.height); }

}  // namespace

DrawnPicture draw_view(Renderer& renderer, const ViewRays& view) {
  const auto start = std::chrono::steady_clock::now();
  const std::clock_t processor = std::clock();
  DrawnPicture out{renderer.render_linear(view), 0, 0};
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  out.processor = double(std::clock() - processor) / CLOCKS_PER_SEC;
  return out;
}

Picture develop_reference(const LinearFrame& reference, const Vec3f& gains) {
  return develop(reference, gains, exposure_of(reference, gains));
}

ViewComparison compare_views(const LinearFrame& reference, const LinearFrame& fast, const Vec3f& gains, int regions,
                             int threads) {
  const RegionDifference d = compare_regions(luminance_of(reference), luminance_of(fast), reference.width,
                                             reference.height, regions, regions);
  const float exposure = exposure_of(reference, gains);
  ViewComparison out{develop(reference, gains, exposure), develop_fast(fast, gains, exposure, threads), d.mean_error,
                     d.bias, 0};
  out.similarity = structural_similarity(luma_of(out.expected), luma_of(out.found));
  return out;
}

}  // namespace rubble
