// Drops that cross an image while it is exposed, each a straight streak.
//
// Over the exposure a drop hides the area of its disc from where it passes: the shares that it takes of pixels
// add up to pi/4 w^2 pixels, w the width of its image. They lie evenly on a streak as wide as the drop, as its
// disc of defocus or as a pixel, whichever is most, with edges as soft as the lesser of the first two, and as long as its way. Of that share the light is its own.
#pragma once

#include <vector>

#include "kernel/base/math.h"
#include "render/camera/lens.h"
#include "render/media/falling_drops.h"

namespace rubble {

struct Streak {
  double u0 = 0, v0 = 0, u1 = 0, v1 = 0;  // where it begins and ends; unit: pixel
  double width = 0;                       // of the drop's image; unit: pixel
  double blur = 0;                        // of its disc of defocus; unit: pixel
  double distance = 0;                    // from the eye; unit: m
  Vec3f radiance;                         // its own light; unit: kcd/m2
};

// Where a drop begins and ends in the image; false: nowhere. open, close: world_from_camera when the exposure begins
// and ends; drop: in its middle.
bool place_streak(const Lens& lens, const Pose& open, const Pose& close, double seconds, const Drop& drop,
                  Streak& streak);

// distances: along each pixel's ray, NaN: nothing; what is nearer hides a streak. image: 3 floats a pixel. Streaks are
// added in their order in each pixel, whatever the threads.
void draw_streaks(const std::vector<Streak>& streaks, const std::vector<float>& distances, int width, int height,
                  int threads, std::vector<float>& image);

}  // namespace rubble
