// Which clusters of a candidate are drawn. A candidate an invocation. Variants: SECOND: those that depth does not hide.
#include "cull_words.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 5) readonly buffer PyramidTable { float farthest[]; };
uniform vec4 image;         // width, height, near plane, 1: there was a picture before
uniform ivec2 first_tiles;  // columns and rows of the finest level

const int kRecord = 18, kEye = 14;  // words; where the eye in the mesh begins

vec4 row_of(int record, int row) {
  int at = record * kRecord + row * 4;
  return vec4(records[at], records[at + 1], records[at + 2], records[at + 3]);
}

bool faces_away(vec3 eye, Cluster c) {
  float cosine = c.half_sides.w;
  if (cosine <= 0.0) return false;
  vec3 to = c.centre.xyz - eye;
  return dot(to, c.axis.xyz) > sqrt(max(1.0 - cosine * cosine, 0.0)) * length(to) + c.centre.w * 1.0001 + 1e-5;
}

// As DepthPyramid::may_show().
bool passes_depth(ivec2 low, ivec2 high, float nearest_value) {
  ivec2 a = low / 4, b = high / 4, size = first_tiles;
  int first = 0;
  while ((size.x > 1 || size.y > 1) && max(b.x - a.x, b.y - a.y) > 3) {
    first += size.x * size.y;
    size = (size + 1) / 2, a /= 2, b /= 2;
  }
  b = min(b, size - 1);
  for (int y = a.y; y <= b.y; ++y)
    for (int x = a.x; x <= b.x; ++x)
      if (nearest_value >= farthest[first + y * size.x + x]) return true;
  return false;
}

// Every test errs towards "visible".
bool may_show(vec4 rows[3], Cluster c) {
  vec4 centre = vec4(c.centre.xyz, 1.0);
  vec3 at = vec3(dot(rows[0], centre), dot(rows[1], centre), dot(rows[2], centre));
  mat3 sides;  // of the box, by its axes, in clip space
  for (int k = 0; k < 3; ++k) sides[k] = vec3(rows[0][k], rows[1][k], rows[2][k]) * c.half_sides[k];
  float deep = (abs(sides[0].z) + abs(sides[1].z) + abs(sides[2].z)) * 1.0001 + 1e-5;
  if (at.z + deep < image.z) return false;
  float near_z = at.z - deep;
  if (near_z <= image.z) return true;
  vec2 low = vec2(1e30), high = vec2(-1e30);
  for (int k = 0; k < 8; ++k) {
    vec3 p = at + sides * (vec3(k & 1, k >> 1 & 1, k >> 2) * 2.0 - 1.0);
    vec2 pixel = (p.xy / p.z * 0.5 + 0.5) * image.xy - 0.5;
    low = min(low, pixel), high = max(high, pixel);
  }
  // Rounding outwards takes in every pixel whose centre the box can cover.
  low = floor(low - 0.01), high = ceil(high + 0.01);
  if (high.x < 0.0 || high.y < 0.0 || low.x >= image.x || low.y >= image.y) return false;
#ifdef SECOND
  return passes_depth(ivec2(clamp(low, vec2(0.0), image.xy - 1.0)), ivec2(clamp(high, vec2(0.0), image.xy - 1.0)),
                      image.z / near_z * 1.00001);
#else
  return true;
#endif
}

void main() {
  int i = int(gl_GlobalInvocationID.x);
  if (i >= candidate_count) return;
  Candidate here = candidates[i];
  vec4 rows[3] = vec4[3](row_of(i, 0), row_of(i, 1), row_of(i, 2));
  int at_eye = i * kRecord + kEye;
  vec3 eye = vec3(records[at_eye], records[at_eye + 1], records[at_eye + 2]);
  uint count = 0u;
  bool running = false;
  for (uint k = 0u; k < here.cluster_count; ++k) {
    Cluster c = clusters[here.first_cluster + k];
    uint flag = flags[here.first_flag + k];
    bool shows = !faces_away(eye, c) && may_show(rows, c), wanted;
#ifdef SECOND
    wanted = shows && (flag & kDrawn) == 0u;
    flag = (flag & kDrawn) | (shows ? kShown : 0u) | (wanted ? kWanted : 0u);
#else
    wanted = shows && (image.w > 0.5 ? (flag & kShown) != 0u : here.wanted_without_history != 0u);
    flag = (flag & kShown) | (wanted ? kDrawn | kWanted : 0u);
#endif
    flags[here.first_flag + k] = flag;
    if (wanted && !running) ++count;
    running = wanted;
  }
  runs[i] = count;
}
