// How much more light all further bounces bring than the first: the share that comes back is the mean over all light.
#include "lamp_words.glsl"

layout(local_size_x = 256) in;
layout(std430, binding = 6) writeonly buffer ShareBlock { float again; } share;
layout(std430, binding = 7) readonly buffer SumTable { vec2 sums[]; };

const float kMostAgain = 0.6;  // share of light that comes back from a bounce, at most

shared vec2 parts[256];

void main() {
  uint local = gl_LocalInvocationID.x, groups = (aim.point_count + 63u) / 64u;
  vec2 part = vec2(0.0);
  for (uint k = local; k < groups; k += 256u) part += sums[k];
  parts[local] = part;
  for (uint step = 128u; step > 0u; step /= 2u) {
    barrier();
    if (local < step) parts[local] += parts[local + step];
  }
  if (local != 0u) return;
  float comes_back = parts[0].x > 0.0 ? min(parts[0].y / kPi / parts[0].x, kMostAgain) : 0.0;
  share.again = 1.0 / (kPi * (1.0 - comes_back));
}
