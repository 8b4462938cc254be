// How many slices of the table of the air a picture reads along each of its rays, as AirVolume has them: up to what lies
// farthest about it. Variants: LEAST: the least depth value of the pixels of each entry, which the other one reads.
#include "frame.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = 0) buffer LeastTable { float least_values[]; };
layout(std430, binding = 1) buffer WantedTable { int wanted[]; };
uniform sampler2D depth_values;

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy), table = ivec2(COLUMNS, ROWS);
  if (any(greaterThanEqual(at, table))) return;
#ifdef LEAST
  ivec2 size = textureSize(depth_values, 0);
  ivec2 low = (at * size + table - 1) / table, high = ((at + 1) * size + table - 1) / table;
  float least = 1.0;
  for (int v = low.y; v < high.y; ++v)
    for (int u = low.x; u < high.x; ++u) least = min(least, texelFetch(depth_values, ivec2(u, v), 0).x);
  least_values[at.y * COLUMNS + at.x] = least;
#else
  float least = 1.0;
  for (int y = max(at.y - 1, 0); y < min(at.y + 2, ROWS); ++y)
    for (int x = max(at.x - 1, 0); x < min(at.x + 2, COLUMNS); ++x) least = min(least, least_values[y * COLUMNS + x]);
  // The longest ray that reaches unit depth.
  vec2 most = max(lens.zw + 0.5, view.zw - lens.zw) * lens.xy;
  float far = least > 0.0 ? view.x * sqrt(1.0 + dot(most, most)) / least : FARTHEST;
  wanted[at.y * COLUMNS + at.x] = min(SLICES, int(far / (far + 2.0) * float(SLICES - 1)) + 3);
#endif
}
