// Lists the nodes of light about what a picture shows, and the bake points about these, each once. A pixel an invocation.
#include "geometry.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = 0) readonly buffer PieceTable { uvec4 pieces[]; };  // see lamp_nodes.comp.glsl
layout(std430, binding = 1) readonly buffer NodePointTable { uvec4 node_points[]; };
layout(std430, binding = 2) readonly buffer SeenTable { uint seen_pieces[]; };  // a bit for each that the lamp may see
layout(std430, binding = 3) buffer NodeShowsTable { uint node_shows[]; };
layout(std430, binding = 4) buffer PointShowsTable { uint point_shows[]; };
// As glDispatchComputeIndirect() reads it: groups of 64, in rows.
const uint kRow = 32768u;
struct ListHead {
  uint groups_x, groups_y, groups_z, count;
};
layout(std430, binding = 5) buffer NodeList { ListHead node_head; uvec2 node_list[]; };  // placed mesh and node
layout(std430, binding = 6) buffer PointList { ListHead point_head; uint point_list[]; };
uniform usampler2D visibility;

void show_node(uint placed, uvec4 piece, uint node) {
  uint at = piece.y + node, bit = 1u << (at % 32u);
  if ((node_shows[at / 32u] & bit) != 0u || (atomicOr(node_shows[at / 32u], bit) & bit) != 0u) return;
  uint number = atomicAdd(node_head.count, 1u);
  node_list[number] = uvec2(placed, node);
  atomicMax(node_head.groups_x, min(number / 64u + 1u, kRow)), atomicMax(node_head.groups_y, number / (64u * kRow) + 1u);
  uvec4 about = node_points[piece.z + node] + piece.x;
  for (int k = 0; k < 4; ++k) {
    uint point = about[k], point_bit = 1u << (point % 32u);
    if ((atomicOr(point_shows[point / 32u], point_bit) & point_bit) != 0u) continue;
    number = atomicAdd(point_head.count, 1u);
    point_list[number] = point;
    atomicMax(point_head.groups_x, min(number / 64u + 1u, kRow)), atomicMax(point_head.groups_y, number / (64u * kRow) + 1u);
  }
}

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy), size = textureSize(visibility, 0);
  if (at.x >= size.x || at.y >= size.y) return;
  uvec2 here = texelFetch(visibility, at, 0).xy;
  if (here.x == 0u) return;
  uint placed = here.x - 1u;
  if ((seen_pieces[placed / 32u] >> (placed % 32u) & 1u) == 0u) return;
  // Most pixels show what the one before or above shows.
  if (at.x > 0 && texelFetch(visibility, at - ivec2(1, 0), 0).xy == here) return;
  if (at.y > 0 && texelFetch(visibility, at - ivec2(0, 1), 0).xy == here) return;
  uvec4 piece = pieces[placed];
  uvec4 triangle = texelFetch(triangle_table, int(here.y));
  uint n = (triangle.w & 2047u) / 45u / 3u + 1u;
  if (n < 2u) {
    for (int k = 0; k < 3; ++k) show_node(placed, piece, triangle[k] - piece.w);
  } else {
    uint first = (triangle.w >> 11) - piece.w;
    for (uint i = 0u; i < (n + 1u) * (n + 2u) / 2u; ++i) show_node(placed, piece, first + i);
  }
}
