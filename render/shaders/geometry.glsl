// The scene's tables, see geometry.h.
uniform usamplerBuffer vertex_table;    // position, packed normal
// By its last vertex: three vertices; look (5 bits), steps between nodes of light along an edge (4), how
// often the vertices were turned from their order in the mesh (2) and, where there are more steps than
// one, the first of the nodes (21).
uniform usamplerBuffer triangle_table;
uniform usamplerBuffer placed_table;    // four a placed mesh
uniform usamplerBuffer light_table;     // baked light, one a node of each placed mesh

#include "packing.glsl"

// The last 11 bits of a triangle's word: its look + 45 (turns of its corners + 3 (steps between nodes - 1)).
int find_look(uvec4 triangle) {
  return int((triangle.w & 2047u) % 45u);
}

// The three nodes of light about a place of these weights on a triangle, and their weights; as
// find_light_nodes() in geometry/light_nodes.h.
ivec3 find_light_nodes(uvec4 triangle, vec3 w, out vec3 weight) {
  uint steps = (triangle.w & 2047u) / 45u, turns = steps % 3u;
  int n = int(steps / 3u) + 1, first = int(triangle.w >> 11);
  vec2 at = (turns == 1u ? w.xy : turns == 2u ? w.zx : w.yz) * float(n);
  int i = min(int(at.x), n - 1), j = min(int(at.y), n - 1 - i);
  float fx = at.x - float(i), fy = at.y - float(j);
  bool upper = fx + fy > 1.0 && i + j + 2 <= n;
  int row = first + j * (2 * n + 3 - j) / 2 + i, above = row + n + 1 - j;
  weight = upper ? vec3(fx + fy - 1.0, 1.0 - fx, 1.0 - fy) : vec3(1.0 - fx - fy, fx, fy);
  if (n < 2) weight = w;
  ivec3 grid = upper ? ivec3(above + 1, above, row + 1) : ivec3(row, row + 1, above);
  return n > 1 ? grid : ivec3(triangle.xyz);
}
