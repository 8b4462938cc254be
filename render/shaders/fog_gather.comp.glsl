// What arrives at each point from anywhere, to the second order, and how surfaces near it answer.
#include "fog_words.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 0) writeonly buffer TotalTable { vec4 total[]; };  // nine a point
layout(std430, binding = 6) readonly buffer EndsTable { vec4 ends_in[]; };
layout(std430, binding = 7) readonly buffer AirTable { vec4 air_in[]; };

#include "surface_words.glsl"
#define Real4 vec4
#include "harmonics.glsl"

const float kMostResponse = 4.0;

void main() {
  int i = int(gl_GlobalInvocationID.x), count = grid.size.w;
  if (i >= count || state.done != 0u) return;
  vec3 direct = air_points[i].direct, to_lamp = air_points[i].to_lamp;
  vec3 sum[9];
  for (int four = 0; four < 3; ++four) {
    vec4 row = harmonics_row(four, to_lamp);
    for (int t = 4 * four; t < min(4 * four + 4, 9); ++t) sum[t] = direct * row[t & 3];
  }
  if (air_points[i].lit != 0u) {
    for (int k = 0; k < kDirections; ++k) {
      vec3 light = (ends_in[k * count + i].rgb + air_in[k * count + i].rgb) * kAngle;
      if (light == vec3(0.0)) continue;
      for (int t = 0; t < 9; ++t) sum[t] += light * grid.harmonics[4 * k + (t >> 2)][t & 3];
    }
  }
  for (int t = 0; t < 9; ++t) total[9 * i + t] = vec4(sum[t], 0.0);
  vec3 usual = air_points[i].usual, now = sum[0] * kMean;
  for (int c = 0; c < 3; ++c)
    air_points[i].response[c] = usual[c] > 0.0 ? clamp(now[c] / usual[c], 0.0, kMostResponse) : 1.0;
  air_points[i].light = dot(sum[0], vec3(1.0 / 3.0));
}
