// Illuminance of bake points by one bounce, by every other link; and for each work group how much light was thrown back
// before and after it.
#include "lamp_words.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 2) readonly buffer LinkTable { uint links[]; };
layout(std430, binding = 3) readonly buffer PointTable { BakePoint points[]; };
layout(std430, binding = 4) readonly buffer RadianceTable { vec4 radiance[]; };
layout(std430, binding = 5) readonly buffer LitTable { uint lit[]; };
layout(std430, binding = 6) writeonly buffer OnceTable { vec4 once[]; };
layout(std430, binding = 7) writeonly buffer SumTable { vec2 sums[]; };

#include "lamp_links.glsl"

shared vec2 parts[64];

vec3 gather(uint i, vec3 position) {
  uint first = first_link(i);
  vec3 sum = vec3(0.0);
  int rays = 0;
  for (uint k = 0u; k < aim.links_a_point; k += 2u) {
    uint sender = find_sender(links[first + k]);
    rays += int(sender != kNone);
    if (sender >= kNone || !is_lit(sender)) continue;
    float share = aim.place.w > 0.0 ? exp(-aim.place.w * distance(position, points[sender].position)) : 1.0;
    sum += radiance[sender].rgb * share;
  }
  return rays > 0 ? sum * (kPi / float(rays)) : vec3(0.0);
}

void main() {
  uint number = find_number(), local = gl_LocalInvocationID.x;
  vec2 part = vec2(0.0);
  if (number < aim.point_count) {
    Seen piece = find_seen(number);
    uint i = piece.first_point + number - piece.points_before;
    BakePoint here = points[i];
    vec3 light = kept_at(distance(here.position, aim.place.xyz)) > 0.0 ? gather(i, here.position) : vec3(0.0);
    once[i] = vec4(light, 0.0);
    if (is_lit(i)) part.x = dot(radiance[i].rgb, vec3(1.0 / 3.0));
    part.y = dot(here.albedo * light, vec3(1.0 / 3.0));
  }
  parts[local] = part;
  for (uint step = 32u; step > 0u; step /= 2u) {
    barrier();
    if (local < step) parts[local] += parts[local + step];
  }
  if (local == 0u) sums[gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x] = parts[0];
}
