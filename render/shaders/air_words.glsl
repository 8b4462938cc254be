// air_medium.glsl and air_model.glsl in GLSL, with the data that shading/air_block.h describes.
#include "surface_words.glsl"
#define Int int
#define Real4 vec4
#define any(m) (m)
#define integer(i) (i)
#define to_int(x) int(x)
#define to_real(i) float(i)
#define all_lanes(v) ((v).xyz)
#define INOUT(T) inout T
#define SLICES(name) inout float name[64]

struct AirLight {
  vec4 position, axis, colour;
  int type;
  float cos_outer, cone_width, unused;
};
layout(std430, binding = 0) readonly buffer AirBlock {
  vec4 drift, box_low, box_high, origin, cell, open, lamp_position, lamp_axis, lamp_colour;
  AirLight lights[4];
  float distance[64], drops[64];
  ivec4 size;
  int columns, rows, slices;
  float fog_density, fog_rate, albedo, fog_g, dust_g, drops_g, billows, billow_scale;
  int noise_side, puff_count;
  float beam_fog, beam_drops;
  int light_count, local, has_direct;
  float half_size;
  int has_around, around_columns, around_rows, rays_an_entry, lamp;
  float lamp_cone, lamp_size2;
  int has_near_glow, near_glow_steps;
  float near_glow_cell, near_glow_reach;
  int has_lens;
} d;
layout(std430, binding = 1) readonly buffer Wanted { int wanted[]; };  // slices of each ray

#ifdef RAYS
uniform sampler2D lens_rays;  // as in resolve.frag.glsl
uniform sampler2D row_poses;
#endif

// The ray through that place of the table, 0.5 in the middle of its first column or row.
void find_air_ray(vec2 place, out vec3 eye, out vec3 way) {
  vec2 pixel = place * view.zw / vec2(d.columns, d.rows) - 0.5;
  vec3 slope = vec3((pixel - lens.zw) * lens.xy, 1.0);
#ifdef RAYS
  ivec2 nearest = clamp(ivec2(pixel + 0.5), ivec2(0), ivec2(view.zw) - 1);
  if (d.has_lens != 0) slope = texelFetch(lens_rays, nearest, 0).xyz;
  if (slope == vec3(0.0)) slope = vec3(0.0, 0.0, 1.0);
  vec4 row_x = texelFetch(row_poses, ivec2(0, nearest.y), 0), row_y = texelFetch(row_poses, ivec2(1, nearest.y), 0);
  vec4 row_z = texelFetch(row_poses, ivec2(2, nearest.y), 0);
#else
  vec4 row_x = world_from_optical[0], row_y = world_from_optical[1], row_z = world_from_optical[2];
#endif
  eye = vec3(row_x.w, row_y.w, row_z.w);
  way = normalize(vec3(dot(row_x.xyz, slope), dot(row_y.xyz, slope), dot(row_z.xyz, slope)));
}
