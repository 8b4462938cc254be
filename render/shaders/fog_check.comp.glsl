// Whether all light has changed so little that the iteration ends.
#include "fog_words.glsl"

layout(local_size_x = 256) in;

shared float parts[256];

void main() {
  if (state.done != 0u) return;
  uint local = gl_LocalInvocationID.x;
  float part = 0.0;
  for (uint i = local; i < uint(grid.size.w); i += 256u) part += air_points[i].light;
  parts[local] = part;
  for (uint step = 128u; step > 0u; step /= 2u) {
    barrier();
    if (local < step) parts[local] += parts[local + step];
  }
  if (local != 0u) return;
  float now = parts[0];
  if (now <= 0.0 || (state.iterations > 0u && abs(now - state.before) <= grid.tolerance * now)) state.done = 1u;
  state.before = now;
  state.iterations += 1u;
}
