// What the air at each point sends on against each direction, of all that it takes; the last number: its extinction.
#include "fog_words.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer TotalTable { vec4 total[]; };
layout(std430, binding = 1) readonly buffer MatterTable { vec4 matter[]; };
layout(std430, binding = 2) writeonly buffer EmittedTable { vec4 emitted[]; };  // by direction, then by point

void main() {
  int i = int(gl_GlobalInvocationID.x), k = int(gl_GlobalInvocationID.y);
  if (i >= grid.size.w || state.done != 0u) return;
  vec3 sum = vec3(0.0);
  vec4 scattered = matter[2 * i];
  for (int t = 0; t < 9; ++t)
    sum += total[9 * i + t].rgb * (grid.harmonics[4 * k + (t >> 2)][t & 3] * scattered[t < 1 ? 0 : t < 4 ? 1 : 2]);
  emitted[k * grid.size.w + i] = vec4(sum, matter[2 * i + 1].x);
}
