// The edges of the sun's shadow map by tiles, by 2 x 2 of these, and so on, as EdgePyramid of camera/edge_blocks.h has them: a
// level each time. A tile an invocation.
layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = 0) buffer EdgeTable { uint edges[]; };  // as in edge_blocks.comp.glsl
uniform usampler2DArray shadow_edges;  // the first word of each tile is its range
uniform ivec4 level;  // side; where it begins; where the one before it does; layer of the map

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  int side = level.x, before_side = textureSize(shadow_edges, 0).x;
  if (at.x >= side || at.y >= side) return;
  uint range;
  if (level.y == level.z) {
    range = texelFetch(shadow_edges, ivec3(at, level.w), 0).x;
  } else {
    while ((before_side + 1) / 2 > side) before_side = (before_side + 1) / 2;
    uint nearest = 65535u, most = 0u;
    for (int k = 0; k < 4; ++k) {
      ivec2 from = min(at * 2 + ivec2(k & 1, k >> 1), ivec2(before_side - 1));
      uint code = edges[level.z + from.y * before_side + from.x];
      nearest = min(nearest, code & 65535u), most = max(most, code >> 16);
    }
    range = nearest | most << 16;
  }
  edges[level.y + at.y * side + at.x] = range;
}
