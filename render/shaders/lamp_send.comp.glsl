// What bake points throw back of the lamp's direct light.
#include "lamp_words.glsl"
#include "lamp_map.glsl"
#include "packing.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 3) readonly buffer PointTable { BakePoint points[]; };
layout(std430, binding = 4) writeonly buffer RadianceTable { vec4 radiance[]; };
layout(std430, binding = 5) buffer LitTable { uint lit[]; };  // a bit for each point whose radiance is not 0

void main() {
  uint number = find_number();
  if (number >= aim.point_count) return;
  Seen piece = find_seen(number);
  uint i = piece.first_point + number - piece.points_before;
  BakePoint here = points[i];
  vec3 way = here.position - aim.place.xyz;
  float facing = -dot(unpack_normal(here.normal), way), away2 = dot(way, way);
  if (facing <= 0.0 || away2 > aim.reach * aim.reach || away2 < 1e-6) return;
  float away = sqrt(away2);
  if (away > distance_towards(way) * (1.0 + aim.slack) + aim.near) return;
  // unpack_normal() gives no unit length.
  facing /= length(unpack_normal(here.normal));
  float kept = kept_at(away) * exp(-aim.place.w * away) * facing / (away * kPi);
  vec3 light = here.albedo * find_lamp_light(here.position) * kept;
  if (light.g <= 0.0) return;
  radiance[i] = vec4(light, 0.0);
  atomicOr(lit[i / 32u], 1u << (i % 32u));
}
