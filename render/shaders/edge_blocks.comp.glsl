// Which blocks of 4 x 4 pixels may show soft edges of the sun's shadows: what camera/edge_blocks.h finds on the processor, by
// the same formulas. A block an invocation. Variants: VIEWS 1 or 2 of the sun; RAYS: all blocks with surfaces.
#include "frame.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(r32ui, binding = 0) writeonly uniform uimage2D numbers;  // of each block; 0: none
layout(rg32ui, binding = 1) writeonly uniform uimage2D places;  // by number, as sun_shadow.frag.glsl reads them
// As glDrawArraysIndirect() reads it: six vertices a block.
layout(std430, binding = 0) buffer DrawBlock { uint vertices, blocks, first, base; } draw;
// Nearest and most, 16 bits each, of tiles of the map, of 2 x 2 of these, and so on; then those of the next view.
layout(std430, binding = 1) readonly buffer EdgeTable { uint edges[]; };
uniform sampler2D depth_values;
uniform usampler2DArray shadow_edges;  // for the number of tiles alone

const float kFlat = 0.002;  // how far depth values of a flat block are from linear, as a share
const float kAway = 0.1;    // cosine of an angle with the sun that is surely beyond a right one
const uint kNoEdge = 65535u;

uvec2 both(uvec2 a, uint code) { return uvec2(min(a.x, code & 65535u), max(a.y, code >> 16)); }

// What a rectangle of the map, 0 to 1, meets of the edges of a view.
uvec2 range_of(int of_view, vec2 low, vec2 high) {
  int side = textureSize(shadow_edges, 0).x, first = 0;
  ivec2 a = ivec2(clamp(low * float(side), 0.0, float(side - 1)));
  ivec2 b = ivec2(clamp(high * float(side), 0.0, float(side - 1)));
#if VIEWS > 1
  if (of_view > 0) {
    int all_tiles = 0;
    for (int s = side;; s = (s + 1) / 2) {
      all_tiles += s * s;
      if (s == 1) break;
    }
    first = all_tiles;
  }
#endif
  while (max(b.x - a.x, b.y - a.y) > 2) {
    a /= 2, b /= 2;
    first += side * side;
    side = (side + 1) / 2;
  }
  uvec2 range = uvec2(kNoEdge, 0u);
  for (int y = a.y; y <= b.y; ++y)
    for (int x = a.x; x <= b.x; ++x) range = both(range, edges[first + y * side + x]);
  return range;
}

// The nearest edge that a block meets at depths from z0 to z1.
uint nearest_edge(vec2 corner, float z0, float z1) {
  uint nearest = kNoEdge;
  for (int of_view = 0; of_view < VIEWS; ++of_view) {
    vec3 low, high;
    for (int i = 0; i < 3; ++i) {
      // A place on the map is eye + z (corner + u right + v down), 0 to 1.
      vec4 row = shadow_rows[4 * of_view + i];
      float part = i < 2 ? 0.5 : 1.0, middle = i < 2 ? 0.5 : 0.0;
      vec3 r0 = world_from_optical[0].xyz, r1 = world_from_optical[1].xyz, r2 = world_from_optical[2].xyz;
      vec3 axis = vec3(row.x * r0.x + row.y * r1.x + row.z * r2.x, row.x * r0.y + row.y * r1.y + row.z * r2.y,
                       row.x * r0.z + row.y * r1.z + row.z * r2.z);
      vec3 at = vec3(world_from_optical[0].w, world_from_optical[1].w, world_from_optical[2].w);
      float eye = (dot(row.xyz, at) + row.w) * part + middle;
      float right = axis.x * lens.x, down = axis.y * lens.y;
      float a = (axis.z + (corner.x - lens.z) * right + (corner.y - lens.w) * down) * part;
      float b = 4.0 * right * part, c = 4.0 * down * part;
      float least = a + min(b, 0.0) + min(c, 0.0), most = a + max(b, 0.0) + max(c, 0.0);
      low[i] = eye + min(z0 * least, z1 * least), high[i] = eye + max(z0 * most, z1 * most);
    }
    if (high.x < 0.0 || high.y < 0.0 || low.x > 1.0 || low.y > 1.0) continue;
    uvec2 range = range_of(of_view, low.xy, high.xy);
    if (float(range.x) < high.z * 65535.0 && min(low.z, 1.0) * 65535.0 <= float(range.y)) nearest = min(nearest, range.x);
    if (low.x >= 0.0 && low.y >= 0.0 && high.x <= 1.0 && high.y <= 1.0) break;
  }
  return nearest;
}

// Whether the sun is clearly behind the surface, by the depth values of a block's corners: they are linear over a plane.
bool looks_away(ivec2 pixel, ivec2 size) {
  if (any(greaterThanEqual(pixel + 3, size))) return false;
  float a = texelFetch(depth_values, pixel, 0).x, b = texelFetch(depth_values, pixel + ivec2(3, 0), 0).x;
  float c = texelFetch(depth_values, pixel + ivec2(0, 3), 0).x, e = texelFetch(depth_values, pixel + 3, 0).x;
  float least = min(min(a, b), min(c, e));
  if (least <= 0.0 || abs(a + e - b - c) > kFlat * least) return false;
  vec2 slope = (vec2(pixel) - lens.zw) * lens.xy;
  float across = (b + e - a - c) / (6.0 * lens.x), down = (c + e - a - b) / (6.0 * lens.y);
  vec3 from_eye = vec3(across, down, a - slope.x * across - slope.y * down);
  vec3 world = vec3(dot(world_from_optical[0].xyz, from_eye), dot(world_from_optical[1].xyz, from_eye),
                    dot(world_from_optical[2].xyz, from_eye));
  return dot(world, -light_axis[0].xyz) > kAway * length(from_eye);
}

void main() {
  ivec2 block = ivec2(gl_GlobalInvocationID.xy), size = textureSize(depth_values, 0), pixel = block * 4;
  if (any(greaterThanEqual(pixel, size))) return;
  float least = 3e38, most = 0.0;
  for (int k = 0; k < 16; ++k) {
    ivec2 at = pixel + ivec2(k & 3, k >> 2);
    if (any(greaterThanEqual(at, size))) continue;
    float value = texelFetch(depth_values, at, 0).x;
    if (value > 0.0) least = min(least, value);
    most = max(most, value);
  }
  uint nearest = kNoEdge;
#ifdef RAYS
  if (most > 0.0) nearest = kNoEdge - 1u;
#else
  if (most > 0.0 && !looks_away(pixel, size)) nearest = nearest_edge(vec2(pixel) - 0.5, view.x / most, view.x / least);
#endif
  uint number = 0u;
  if (nearest < kNoEdge) {
    number = atomicAdd(draw.blocks, 1u) + 1u;  // the first is none
    imageStore(places, ivec2(number & 255u, number >> 8),
               uvec4(uint(block.x) | uint(block.y) << 16, floatBitsToUint(float(nearest) / 65535.0), 0u, 0u));
  }
  imageStore(numbers, block, uvec4(number));
}
