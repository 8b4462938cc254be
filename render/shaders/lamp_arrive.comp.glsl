// Light that arrives at the bake points about what a picture shows, by all bounces, and its direction.
#include "lamp_words.glsl"
#include "packing.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 2) readonly buffer LinkTable { uint links[]; };
layout(std430, binding = 3) readonly buffer PointTable { BakePoint points[]; };
layout(std430, binding = 4) readonly buffer RadianceTable { vec4 radiance[]; };
layout(std430, binding = 5) readonly buffer LitTable { uint lit[]; };
layout(std430, binding = 6) readonly buffer PointList { uint groups_x, groups_y, groups_z, count, point_list[]; };
// Two a point: illuminance, and the vector whose product with a normal is its strength there.
layout(std430, binding = 7) writeonly buffer ArrivedTable { vec4 arrived[]; };

#include "lamp_links.glsl"

void main() {
  uint number = find_number();
  if (number >= count) return;
  uint i = point_list[number];
  BakePoint here = points[i];
  vec3 colour = vec3(0.0), vector = vec3(0.0), normal = normalize(unpack_normal(here.normal));
  float kept = kept_at(distance(here.position, aim.place.xyz));
  uint first = first_link(i), links_here = kept > 0.0 ? aim.links_a_point : 0u;
  int rays = 0;
  for (uint k = 0u; k < links_here; ++k) {
    uint sender = find_sender(links[first + k]);
    rays += int(sender != kNone);
    if (sender >= kNone || !is_lit(sender)) continue;
    vec3 light = radiance[sender].rgb, way = points[sender].position - here.position;
    float away = max(length(way), 1e-4);
    light *= exp(-aim.place.w * away);
    colour += light;
    vec3 w = way / away;
    vector += w * (dot(light, vec3(1.0 / 3.0)) / max(dot(w, normal), 0.35));
  }
  float scale = rays > 0 ? kPi / float(rays) * kept : 0.0;
  colour *= scale, vector *= scale;
  vector += normal * (dot(colour, vec3(1.0 / 3.0)) - dot(vector, normal));
  arrived[2u * i] = vec4(colour, 0.0), arrived[2u * i + 1u] = vec4(vector, 0.0);
}
