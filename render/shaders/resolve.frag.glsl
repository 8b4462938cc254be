// From "which triangle is here" to colour: surface, light, air, tone.
// Variants: LIGHT_COUNT 1 to 4; for each light LIGHT_i as "type, first view, views" with type 0
// directional, 1 spot, 2 point; LAMP; AIR that is not clear; WET; LINEAR (kcd/m2
// out, no tone mapping); SOFT_SUN where sun_shadow.frag.glsl has drawn; PAINTS, PAINTED and
// PAINT_SIDE where meshes have colours of their own; GLOW where a look
// shines; GLASS, the look that is clear, where a mesh has it, and BEHIND where what is behind it was drawn; SURROUNDED by a street; METER (log2 of luminance of each 4th pixel in each direction, for the
// exposure; below -1000: none); RAYS (each pixel has a ray of its own). VEIL_FROM:
// where clean air begins to veil what is seen, m.
#include "frame.glsl"
#include "geometry.glsl"
#include "surface_words.glsl"
#include "lighting.glsl"
#include "surface.glsl"

uniform usampler2D visibility;
uniform sampler2D depth_values;
uniform usampler2D sun_numbers;  // see colour/sun_shadow_pass.h
uniform sampler2D sun_shares;
#ifdef BEHIND
uniform sampler2D behind;  // glass: radiance, kcd/m2, and 0 where it is dark
#endif
#ifdef LAMP
uniform sampler2D openness;  // to the lamp; half size
#endif

#ifdef RAYS
uniform sampler2D lens_rays;  // optical frame, of length 1 / max(cosine with the axis, 0.05)
uniform sampler2D row_poses;  // rows of world_from_optical, one column each
#endif

layout(location = 0) out vec4 colour;

uniform sampler3D air_table;  // light thrown back and transmittance, by pixel and distance

struct Shading {
  vec3 e, glare;  // on the albedo, and mirrored
};

void reflect_light(inout Shading sum, Surface s, vec3 e, vec3 to_light, vec3 to_eye) {
  MirrorAngles angles = find_mirror_angles(s.normal, to_light, to_eye);
  float lobe = gloss_lobe(s.layers, angles);
#ifdef WET
  lobe += film_lobe(s.layers, angles);
#endif
  sum.glare += e * lobe;
  sum.e += e * base_share(s.layers, mirrored_share(s, dot(s.normal, to_light)));
}

void add_light(inout Shading sum, const int i, const int type, const int first_view,
               const int views, Surface s, vec3 world, vec3 to_eye) {
  vec3 to_light;
  vec3 e = light_at(i, type, world, to_light);
  float facing = max(dot(s.normal, to_light), 0.0);
  // A bumped normal must not catch light that the face itself cannot see.
  facing *= clamp(dot(s.face_normal, to_light) * 8.0, 0.0, 1.0);
  float seen = light_visible(i, type, first_view, views, world, s.face_normal);
#ifdef SOFT_SUN
  if (i == 0) {
    // The first block is none.
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    int block = int(texelFetch(sun_numbers, pixel >> 2, 0).x);
    float coded = texelFetch(sun_shares, (ivec2(block & 255, block >> 8) << 2) + (pixel & 3), 0).x * 255.0;
    if (coded > 0.5) seen = (coded - 1.0) * (1.0 / 254.0);
  }
#endif
  e *= facing * seen;
#ifdef AIR
  e *= air_passes(i, type, world, to_light);
#endif
  reflect_light(sum, s, e, to_light, to_eye);
}

vec3 shade(Surface s, vec3 world, vec3 to_eye, float lamp_seen, float passed) {
  Shading sum = Shading(s.ambient, vec3(0.0));
  add_light(sum, 0, LIGHT_0, s, world, to_eye);
#if LIGHT_COUNT > 1
  add_light(sum, 1, LIGHT_1, s, world, to_eye);
#endif
#if LIGHT_COUNT > 2
  add_light(sum, 2, LIGHT_2, s, world, to_eye);
#endif
#if LIGHT_COUNT > 3
  add_light(sum, 3, LIGHT_3, s, world, to_eye);
#endif
#ifdef LAMP
  vec3 to_lamp;
  float lamp_distance;
  vec3 lamp = lamp_at(world, to_lamp, lamp_distance);
#ifdef AIR
  lamp *= pow(passed, air_drops.y);
#endif
  lamp *= max(dot(s.normal, to_lamp), 0.0) * clamp(dot(s.face_normal, to_lamp) * 8.0, 0.0, 1.0) *
          lamp_seen;
  reflect_light(sum, s, lamp, to_lamp, to_eye);
#endif
  // What the mirrors on top throw back of the light all around, the base below does not get.
  float mirrored = mirrored_share(s, dot(s.normal, to_eye));
#ifdef SURROUNDED
  // Panes and puddles show the sky above the roofs.
  vec3 around = s.ambient, to_sky = reflect(-to_eye, s.normal);
  float even = s.layers.cover * (1.0 - smoothstep(0.04, 0.12, s.layers.roughness));
#ifdef WET
  even = max(even, s.layers.film);
#endif
  around = mix(around, sky_radiance(vec3(to_sky.xy, max(to_sky.z, 0.01))) * 3.14159,
               even * smoothstep(0.05, 0.4, to_sky.z));
  return (sum.e * s.layers.albedo * (1.0 - mirrored) + around * mirrored + sum.glare) * 0.318310;
#else
  return (sum.e * s.layers.albedo * (1.0 - mirrored) + s.ambient * mirrored + sum.glare) * 0.318310;
#endif
}

void main() {
#ifdef METER
  ivec2 pixel = ivec2(gl_FragCoord.xy) * 4 + 2;
#else
  ivec2 pixel = ivec2(gl_FragCoord.xy);
#endif
  uvec2 seen = texelFetch(visibility, pixel, 0).xy;
  bool surface = seen.x != 0u;
#ifdef RAYS
  // Any lens, and for each row the pose at its own time; see passes/ray_pass.h.
  vec3 slope = texelFetch(lens_rays, pixel, 0).xyz;
  if (slope == vec3(0.0)) {
    colour = vec4(0.0, 0.0, 0.0, 1.0);  // black, and nothing to the light meter
#ifdef METER
    colour.x = -2000.0;
#endif
    return;
  }
  vec4 row_x = texelFetch(row_poses, ivec2(0, pixel.y), 0);
  vec4 row_y = texelFetch(row_poses, ivec2(1, pixel.y), 0);
  vec4 row_z = texelFetch(row_poses, ivec2(2, pixel.y), 0);
#else
  // Direction with unit Z in the optical frame.
  vec3 slope = vec3((vec2(pixel) - lens.zw) * lens.xy, 1.0);
  vec4 row_x = world_from_optical[0], row_y = world_from_optical[1], row_z = world_from_optical[2];
#endif
  vec3 ray = vec3(dot(row_x.xyz, slope), dot(row_y.xyz, slope), dot(row_z.xyz, slope));
  vec3 eye = vec3(row_x.w, row_y.w, row_z.w);
  float ray_length = length(slope);
  vec3 direction = ray / ray_length;
  vec3 radiance;
#ifdef BEHIND
  vec3 clear = vec3(0.0), before = vec3(0.0);  // before: what the air before the glass adds
#endif
  float far = 1e9;
  float value = texelFetch(depth_values, pixel, 0).x;
  float z = view.x / max(value, 1e-9);
  if (surface) far = z * ray_length;
  float passed = 1.0;
#ifdef AIR
  vec4 air = texture(air_table, vec3((vec2(pixel) + 0.5) / view.zw,
                                     (far / (far + 2.0) * AIR_STEPS + 0.5) / (AIR_STEPS + 1.0)));
  passed = air.a;
#endif
  if (!surface) {
    radiance = backdrop(direction);
  } else {
    vec3 world = eye + ray * z;
    Surface s = find_surface(seen.x - 1u, seen.y, world, direction, z);
    float lamp_seen = 0.0;
#ifdef LAMP
    lamp_seen = texture(openness, (vec2(pixel) + 0.5) / view.zw).x;
#endif
    radiance = shade(s, world, -direction, lamp_seen, passed);
#ifdef BEHIND
    clear = s.layers.clear;
#endif
#ifdef GLOW
    radiance += s.layers.glow;
#endif
    // Clean air veils what is far: the horizon has no edge.
    float there = max(far - VEIL_FROM, 0.0);
#ifdef SURROUNDED
    float veil = exp2(-there * 5.64e-4);  // what is far is there, at a visibility of 10 km
#else
    float veil = exp2(-there * there * 4e-5 / (1.0 + there * 0.012));
#endif
    vec3 veiling = sky_radiance(vec3(direction.xy, 0.02));
    radiance = mix(veiling, radiance, veil);
#ifdef BEHIND
    before = veiling * (1.0 - veil);
#endif
  }
#ifdef AIR
  radiance = radiance * air.a + air.rgb;
#ifdef BEHIND
  before = before * air.a + air.rgb;
#endif
#endif
#ifdef BEHIND
  // With all air up to there, in place of what is behind no more than the air before the glass.
  if (clear.y > 0.0) {
    vec4 through = texelFetch(behind, pixel, 0);
    radiance += (through.rgb - before) * clear * through.a;
  }
#endif
#ifdef METER
  colour.x = log2(max(dot(radiance * balance.rgb, vec3(0.2126, 0.7152, 0.0722)), 1e-30));
#elif defined LINEAR
  colour = vec4(radiance, value < 0.0 ? 0.0 : 1.0);
#else
  vec3 exposed = radiance * (view.y * balance.rgb);
  float noise = grain(float(pixel.x) + wetness.y, float(pixel.y) + wetness.z);
  colour = vec4(develop(exposed.x, noise), develop(exposed.y, noise), develop(exposed.z, noise), 1.0);
#endif
}
