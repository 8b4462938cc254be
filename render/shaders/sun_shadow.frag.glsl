// Share of the sun's disc that a pixel's surface sees, as the mean over the pixel: the shadow map is compared about the
// surface over the pixel's footprint and, as far as the height of what throws the shadow asks, over the disc's image
// (percentage-closer soft shadows, Fernando 2005). Points and order are the same for all pixels: no noise.
// Drawn for blocks of 4 x 4 pixels that may see edges of the map (camera/edge_blocks.h), one beside the other: software
// drivers run all of a shader for each pixel, whatever its branches.
// Variants: VIEWS 1 or 2 of the sun; RAYS as in resolve.frag.glsl.
#include "frame.glsl"
#include "geometry.glsl"

uniform usampler2D sun_blocks;  // column and row of a block, 16 bits each; depth of the nearest edge it meets
uniform usampler2D visibility;
uniform sampler2D depth_values;
uniform sampler2DArrayShadow shadow_map;
uniform sampler2DArray shadow_values;   // the same, without comparison
uniform usampler2DArray shadow_edges;   // by tiles of texels
#ifdef RAYS
uniform sampler2D lens_rays;
uniform sampler2D row_poses;
#endif

layout(location = 0) out float coded;  // 1 to 255 of 255 for a share of 0 to 1; 0: one comparison says all

const int kSearchTaps = 8;
const float kLeastRadius = 0.6;     // of the comparisons; unit: texel
const float kMostFootprint = 16.0;  // unit: texel

// How the eye sees a pixel's surface.
struct Sight {
  vec3 direction;     // from the eye; unit length
  vec3 across, down;  // from pixel to pixel, by the units of the next
  vec2 size;          // unit: m
};

// Where a point is on the map.
struct Place {
  vec2 at;            // 0 to 1
  float z;
  int row, layer;     // of the view that shows it
  float texel;        // its width; unit: m
};

// Number k of points spread evenly over the unit disc: a spiral that turns by the golden angle from each to the next.
vec2 disc_point(int k, float inverse_count, inout vec2 turn) {
  turn = vec2(turn.x * -0.7373688 - turn.y * 0.6754903, turn.x * 0.6754903 + turn.y * -0.7373688);
  return turn * sqrt((float(k) + 0.5) * inverse_count);
}

// Number k of points spread evenly over a pixel (Roberts' sequence); -0.5 to 0.5.
vec2 pixel_point(int k) { return fract(vec2(0.7548777, 0.5698403) * float(k + 1)) - 0.5; }

vec3 face_normal(uvec2 seen) {
  int at = int(seen.x - 1u) * 4;
  vec4 mx = uintBitsToFloat(texelFetch(placed_table, at));
  vec4 my = uintBitsToFloat(texelFetch(placed_table, at + 1));
  vec4 mz = uintBitsToFloat(texelFetch(placed_table, at + 2));
  uvec4 tri = texelFetch(triangle_table, int(seen.y));
  vec3 a = uintBitsToFloat(texelFetch(vertex_table, int(tri.x)).xyz);
  vec3 b = uintBitsToFloat(texelFetch(vertex_table, int(tri.y)).xyz);
  vec3 c = uintBitsToFloat(texelFetch(vertex_table, int(tri.z)).xyz);
  vec3 n = cross(b - a, c - a);
  n = mx.xyz * n.x + my.xyz * n.y + mz.xyz * n.z;
  return n * inversesqrt(max(dot(n, n), 1e-30));
}

// nearest: of what stands beside the edges there.
float share_at(Place place, float nearest, vec3 normal, Sight sight) {
  vec3 a = shadow_rows[place.row].xyz, b = shadow_rows[place.row + 1].xyz, c = shadow_rows[place.row + 2].xyz;
  float depth_of_metre = length(c), facing = -dot(normal, c) / depth_of_metre;
  if (facing <= 0.0) return 0.0;
  facing = max(facing, 0.08);
  // How depth grows over the surface, and what it may be off by: half a texel of that and roughness.
  vec2 slope = vec2(dot(normal, a) / dot(a, a), dot(normal, b) / dot(b, b)) * (2.0 * depth_of_metre / facing);
  float compared = place.z - place.texel * 1.6 / facing * depth_of_metre;
  // From pixel to pixel on the surface, and on the map.
  vec3 slant = sight.direction / min(dot(normal, sight.direction), -0.05);
  vec3 across = (sight.across - slant * dot(normal, sight.across)) * sight.size.x;
  vec3 down = (sight.down - slant * dot(normal, sight.down)) * sight.size.y;
  vec2 x = vec2(dot(a, across), dot(b, across)) * 0.5, y = vec2(dot(a, down), dot(b, down)) * 0.5;
  vec2 side = vec2(textureSize(shadow_values, 0).xy);
  float wide = (length(x) + length(y)) * 0.5 * side.x;
  float shrink = min(1.0, kMostFootprint / max(wide, 1e-6));
  x *= shrink, y *= shrink;

  // How high what hides the sun is above the surface.
  vec2 metre = vec2(length(a), length(b)) * 0.5, turn = vec2(1.0, 0.0);
  vec2 reach = metre * (SUN_RADIUS * max(place.z - nearest, 0.0) / depth_of_metre + place.texel * 1.5);
  float whole = texture(shadow_map, vec4(place.at, float(place.layer), min(compared, 1.0))), sum = 0.0, found = 0.0;
  for (int k = 0; k < kSearchTaps; ++k) {
    vec2 pixel = pixel_point(k), aside = disc_point(k, 1.0 / float(kSearchTaps), turn) * reach;
    vec2 off = x * pixel.x + y * pixel.y + aside;
    ivec3 texel = ivec3(ivec2(clamp(place.at + off, 0.0, 0.99999) * side), place.layer);
    float height = (compared + dot(slope, off) - texelFetch(shadow_values, texel, 0).x) / depth_of_metre;
    // Beyond the disc's image at its own height it hides nothing.
    bool hides = height > 0.0 && abs(aside.x) < metre.x * (SUN_RADIUS * height + place.texel * 1.5);
    sum += hides ? height : 0.0, found += hides ? 1.0 : 0.0;
  }
  bool partly = (found > 0.0 || whole < 1.0) && (found < float(kSearchTaps) || whole > 0.0);
  float blur = max(SUN_RADIUS * sum / max(found, 1.0), kLeastRadius * place.texel);
  reach = metre * blur;
  int count = !partly ? 0 : blur > 6.0 * place.texel ? 32 : blur + place.texel * wide > 1.5 * place.texel ? 16 : 8;
  float inverse_count = 1.0 / float(max(count, 1)), lit = 0.0;
  turn = vec2(1.0, 0.0);
  for (int k = 0; k < count; ++k) {
    vec2 pixel = pixel_point(k), off = x * pixel.x + y * pixel.y + disc_point(k, inverse_count, turn) * reach;
    lit += texture(shadow_map, vec4(place.at + off, float(place.layer), min(compared + dot(slope, off), 1.0)));
  }
  return partly ? (1.0 + 254.0 * lit * inverse_count) / 255.0 : 0.0;
}

// The sun's views are the first.
Place place_of(vec3 p) {
  vec4 h = vec4(p, 1.0);
  int row = 0;
  float texel = light_position[0].w;
  vec2 at = vec2(dot(shadow_rows[0], h), dot(shadow_rows[1], h)) * 0.5 + 0.5;
#if VIEWS > 1
  if (any(notEqual(at, clamp(at, 0.0, 1.0)))) {
    row = 4, texel = light_axis[0].w;
    at = vec2(dot(shadow_rows[4], h), dot(shadow_rows[5], h)) * 0.5 + 0.5;
  }
#endif
  return Place(at, dot(shadow_rows[row + 2], h), row, row / 4, texel);
}

void main() {
  ivec2 place_here = ivec2(gl_FragCoord.xy);
  uvec2 block = texelFetch(sun_blocks, place_here >> 2, 0).xy;
  ivec2 pixel = ivec2(int(block.x & 65535u), int(block.x >> 16)) * 4 + (place_here & 3);
  pixel = min(pixel, ivec2(view.zw) - 1);
#ifdef RAYS
  vec3 slope = texelFetch(lens_rays, pixel, 0).xyz;
  vec4 row_x = texelFetch(row_poses, ivec2(0, pixel.y), 0);
  vec4 row_y = texelFetch(row_poses, ivec2(1, pixel.y), 0);
  vec4 row_z = texelFetch(row_poses, ivec2(2, pixel.y), 0);
#else
  vec3 slope = vec3((vec2(pixel) - lens.zw) * lens.xy, 1.0);
  vec4 row_x = world_from_optical[0], row_y = world_from_optical[1], row_z = world_from_optical[2];
#endif
  float value = texelFetch(depth_values, pixel, 0).x, z = view.x / max(value, 1e-9);
  vec3 ray = vec3(dot(row_x.xyz, slope), dot(row_y.xyz, slope), dot(row_z.xyz, slope)) * z;
  vec3 eye = vec3(row_x.w, row_y.w, row_z.w);
  Place place = place_of(eye + ray);
  ivec2 tile = ivec2(place.at * vec2(textureSize(shadow_values, 0).xy)) / EDGE_TILE;
  // A depth of 16 bits, as shadow_edges.frag.glsl has it.
  uint nearest = texelFetch(shadow_edges, ivec3(tile, place.layer), 0).x & 65535u;
  Sight sight;
  float far = length(ray);
  sight.direction = ray / far;
#ifdef RAYS
  // To the next ray, or from the one before at the border of the image; none beyond that of the lens.
  ivec2 forward = ivec2(lessThan(pixel, textureSize(lens_rays, 0) - 1)) * 2 - 1;
  vec3 right = texelFetch(lens_rays, pixel + ivec2(forward.x, 0), 0).xyz;
  vec3 below = texelFetch(lens_rays, pixel + ivec2(0, forward.y), 0).xyz;
  right = right == vec3(0.0) ? right : (right - slope) * float(forward.x);
  below = below == vec3(0.0) ? below : (below - slope) * float(forward.y);
  sight.across = vec3(dot(row_x.xyz, right), dot(row_y.xyz, right), dot(row_z.xyz, right));
  sight.down = vec3(dot(row_x.xyz, below), dot(row_y.xyz, below), dot(row_z.xyz, below));
  sight.size = vec2(z);
#else
  sight.across = vec3(row_x.x, row_y.x, row_z.x), sight.down = vec3(row_x.y, row_y.y, row_z.y);
  sight.size = lens.xy * z;
#endif
  vec3 normal = face_normal(texelFetch(visibility, pixel, 0).xy);
  bool known = value > 0.0 && all(equal(place.at, clamp(place.at, 0.0, 0.99999)));
  float share = share_at(place, nearest < 65535u ? float(nearest) / 65535.0 : uintBitsToFloat(block.y), normal, sight);
  coded = known && block.x != 0xffffffffu ? share : 0.0;
}
