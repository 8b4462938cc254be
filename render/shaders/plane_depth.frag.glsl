// The depth value near / Z of the triangle's own plane under the pixel's centre. What the device
// interpolates is off by up to 0.2 mm where a triangle reaches from very near to far.
#include "geometry.glsl"

uniform usampler2D visibility;

layout(std140) uniform Plane {
  vec4 world_from_optical[3];  // rows
  vec4 lens;                   // 1/fx, 1/fy, cx, cy
};

layout(location = 0) out float value;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  uvec2 seen = texelFetch(visibility, pixel, 0).xy;
  value = 0.0;
  if (seen.x == 0u) return;
  vec3 slope = vec3((vec2(pixel) - lens.zw) * lens.xy, 1.0);
  vec3 ray = vec3(dot(world_from_optical[0].xyz, slope), dot(world_from_optical[1].xyz, slope),
                  dot(world_from_optical[2].xyz, slope));
  vec4 eye = vec4(world_from_optical[0].w, world_from_optical[1].w, world_from_optical[2].w, 1.0);
  int at = int(seen.x - 1u) * 4;
  vec4 mx = uintBitsToFloat(texelFetch(placed_table, at));
  vec4 my = uintBitsToFloat(texelFetch(placed_table, at + 1));
  vec4 mz = uintBitsToFloat(texelFetch(placed_table, at + 2));
  vec3 from = vec3(dot(mx, eye), dot(my, eye), dot(mz, eye));
  vec3 along = vec3(dot(mx.xyz, ray), dot(my.xyz, ray), dot(mz.xyz, ray));
  uvec4 tri = texelFetch(triangle_table, int(seen.y));
  vec3 a = uintBitsToFloat(texelFetch(vertex_table, int(tri.x)).xyz);
  vec3 b = uintBitsToFloat(texelFetch(vertex_table, int(tri.y)).xyz);
  vec3 c = uintBitsToFloat(texelFetch(vertex_table, int(tri.z)).xyz);
  vec3 normal = cross(b - a, c - a);
  // Seen edge-on the plane says little: then the nearest corner is as good.
  float z = dot(normal, a - from) / dot(normal, along);
  float za = dot(a - from, along), zb = dot(b - from, along), zc = dot(c - from, along);
  float per = 1.0 / dot(along, along);
  float low = min(za, min(zb, zc)) * per, high = max(za, max(zb, zc)) * per;
  // Bounds along this ray rather than along the axis: widened by what the slant can add.
  float room = 0.5 * (high - low) + 1e-4 * high;
  z = clamp(z, max(low - room, NEAR_PLANE), high + room);
  value = NEAR_PLANE / z;
}
