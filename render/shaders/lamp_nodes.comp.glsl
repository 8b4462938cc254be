// Light at the nodes about what a picture shows: what is baked, and what comes of the lamp. Variants: RESTORE, which takes
// the lamp's light back; FOG, which adds what the air throws on surfaces.
#include "lamp_words.glsl"
#include "packing.glsl"

layout(local_size_x = 64) in;
struct Node {
  vec3 position;  // in the mesh
  uint normal;
  vec4 weights;   // of the four points about it
};
// First bake point, first node of light, first in the table of nodes, first in the table of vertices.
layout(std430, binding = 2) readonly buffer PieceTable { uvec4 pieces[]; };
layout(std430, binding = 3) readonly buffer NodeTable { Node nodes[]; };
layout(std430, binding = 4) readonly buffer NodePointTable { uvec4 node_points[]; };
layout(std430, binding = 5) readonly buffer NodeList { uint groups_x, groups_y, groups_z, count; uvec2 node_list[]; };
layout(std430, binding = 6) readonly buffer ArrivedTable { vec4 arrived[]; };
layout(std430, binding = 7) writeonly buffer LightTable { uvec2 shown_light[]; };
uniform usamplerBuffer light_table;   // baked
uniform samplerBuffer piece_rows;     // three a placed mesh: rows of world_from_mesh

#ifdef FOG
#include "lamp_field.glsl"
#endif

void main() {
  uint number = find_number();
  if (number >= count) return;
  uint placed = node_list[number].x, node = node_list[number].y;
  uvec4 of_piece = pieces[placed];
  uint at = of_piece.y + node;
  uvec2 baked = texelFetch(light_table, int(at)).xy;
#ifdef RESTORE
  shown_light[at] = baked;
#else
  Node here = nodes[of_piece.z + node];
  uvec4 about = node_points[of_piece.z + node] + of_piece.x;
  vec3 colour = vec3(0.0), vector = vec3(0.0);
  for (int k = 0; k < 4; ++k)
    colour += arrived[2u * about[k]].rgb * here.weights[k], vector += arrived[2u * about[k] + 1u].rgb * here.weights[k];
  vec4 rows[3];
  for (int k = 0; k < 3; ++k) rows[k] = texelFetch(piece_rows, int(placed) * 3 + k);
  vec3 local = unpack_normal(here.normal);
  vec3 n = normalize(vec3(dot(rows[0].xyz, local), dot(rows[1].xyz, local), dot(rows[2].xyz, local)));
#ifdef FOG
  vec4 h = vec4(here.position, 1.0);
  vec3 more = find_lamp_illuminance(vec3(dot(rows[0], h), dot(rows[1], h), dot(rows[2], h)), n);
  colour += more, vector += n * dot(more, vec3(1.0 / 3.0));
#endif
  if (colour.g <= 0.0) return;
  vec2 red_blue;
  vec3 there = unpack_light(baked, red_blue);
  colour += vec3(red_blue.x, 1.0 - red_blue.x - red_blue.y, red_blue.y) * (3.0 * max(dot(there, n), 0.0));
  vec3 all_light = clamp(there + vector, -60000.0, 60000.0);
  uvec2 shares = uvec2(round(255.0 * colour.rb / (colour.r + colour.g + colour.b)));
  shown_light[at] = uvec2(packHalf2x16(all_light.xy),
                          packHalf2x16(vec2(all_light.z, 0.0)) | shares.x << 16 | shares.y << 24);
#endif
}
