// What arrives at each point, as spherical harmonics: sixteen colours by the air, and behind those of all points sixteen by
// surfaces.
#include "fog_words.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 0) writeonly buffer TermTable { float terms[]; };
layout(std430, binding = 6) readonly buffer EndsTable { vec4 ends_in[]; };
layout(std430, binding = 7) readonly buffer AirTable { vec4 air_in[]; };

void main() {
  int i = int(gl_GlobalInvocationID.x), of_ends = int(gl_GlobalInvocationID.y), count = grid.size.w;
  if (i >= count) return;
  vec3 sum[16];
  for (int t = 0; t < 16; ++t) sum[t] = vec3(0.0);
  if (air_points[i].lit != 0u) {
    for (int k = 0; k < kDirections; ++k) {
      vec3 light = (of_ends != 0 ? ends_in[k * count + i].rgb : air_in[k * count + i].rgb) * kAngle;
      if (light == vec3(0.0)) continue;
      for (int t = 0; t < 16; ++t) sum[t] += light * grid.harmonics[4 * k + (t >> 2)][t & 3];
    }
  }
  int first = (of_ends * count + i) * 48;
  for (int t = 0; t < 16; ++t)
    for (int c = 0; c < 3; ++c) terms[first + 3 * t + c] = sum[t][c];
}
