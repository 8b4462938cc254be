// Where light comes from the lamp, or from what it lights, and ring by ring the first cells about that: farther away little is
// scattered to. RING: 0: the former.
#include "fog_words.glsl"

layout(local_size_x = 64) in;
uniform usamplerBuffer nearest, hidden;

void main() {
  int i = int(gl_GlobalInvocationID.x);
  if (i >= grid.size.w || texelFetch(nearest, i).x != uint(i)) return;
#if RING == 0
  const float kDark = 1e-6;  // of the brightest
  if (dot(air_points[i].usual, vec3(1.0 / 3.0)) > kDark * uintBitsToFloat(state.brightest)) air_points[i].lit = 1u;
#else
  if (air_points[i].lit != 0u) return;
  const int sides[6] = int[6](4, 10, 12, 14, 16, 22);
  uint unseen = texelFetch(hidden, i).x;
  for (int k = 0; k < 6; ++k) {
    if ((unseen >> sides[k] & 1u) != 0u) continue;
    uint beside = air_points[find_neighbour(i, sides[k])].lit;
    if (beside != 0u && beside <= uint(RING)) air_points[i].lit = uint(RING) + 1u;
  }
#endif
}
