// Adds to what bake points throw back the light of all further bounces.
#include "lamp_words.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 2) readonly buffer OnceTable { vec4 once[]; };
layout(std430, binding = 3) readonly buffer PointTable { BakePoint points[]; };
layout(std430, binding = 4) buffer RadianceTable { vec4 radiance[]; };
layout(std430, binding = 5) buffer LitTable { uint lit[]; };
layout(std430, binding = 6) readonly buffer ShareBlock { float again; } share;

void main() {
  uint number = find_number();
  if (number >= aim.point_count) return;
  Seen piece = find_seen(number);
  uint i = piece.first_point + number - piece.points_before, bit = 1u << (i % 32u);
  vec3 more = points[i].albedo * once[i].rgb * share.again;
  if (more.g <= 0.0) return;
  bool had = (atomicOr(lit[i / 32u], bit) & bit) != 0u;
  radiance[i] = vec4(had ? radiance[i].rgb + more : more, 0.0);
}
