// The table of the air, a ray an invocation: see media/air_volume.h. Variants: RAYS, as in resolve.frag.glsl.
#include "frame.glsl"
#include "air_words.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba32f, binding = 0) writeonly uniform image3D table;

struct Puff {
  vec4 place;
  float extinction, unused_a, unused_b, unused_c;
};
layout(std430, binding = 2) readonly buffer Noise { float noise_values[]; };
layout(std430, binding = 3) readonly buffer Puffs { Puff puffs[]; };
layout(std430, binding = 4) readonly buffer Radiance { vec4 baked_radiance[]; };
layout(std430, binding = 5) readonly buffer Direct { vec4 baked_direct[]; };
layout(std430, binding = 6) readonly buffer AroundTable { vec4 around_rows[]; };
layout(std430, binding = 7) readonly buffer NearTable { vec4 near_glow_rows[]; };

float noise_value(int i) { return noise_values[i]; }
vec4 puff_place(int i) { return puffs[i].place; }
float puff_extinction(int i) { return puffs[i].extinction; }
vec3 baked_at(int light, int point) {
  if (light < 0) return baked_radiance[point].xyz;
  return baked_direct[light * (d.size[0] * d.size[1] * d.size[2]) + point].xyz;
}
vec4 near_glow_row(int i) { return near_glow_rows[i]; }
vec4 around_row(int i) { return around_rows[i]; }

#include "air_medium.glsl"
#include "harmonics.glsl"
#include "air_model.glsl"

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  vec3 eye, way;
  find_air_ray(vec2(at) + 0.5, eye, way);
  AirRay ray = make_air_ray(eye, way, at.x, at.y);
  int slices = wanted[at.y * d.columns + at.x];
  float dust[64];
  for (int slice = 0; slice < slices; ++slice) dust[slice] = 0.0;
  if (d.puff_count > 0) add_dust(eye, way, slices, dust);
  AirSum sum = AirSum(vec3(0.0), 0.0, 0.0);
  imageStore(table, ivec3(at, 0), vec4(0.0, 0.0, 0.0, 1.0));
  for (int slice = 1; slice < slices; ++slice) {
    add_slice(ray, slice, dust[slice], sum);
    imageStore(table, ivec3(at, slice), vec4(sum.glow, exp(-sum.depth)));
  }
}
