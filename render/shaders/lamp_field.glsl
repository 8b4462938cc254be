// The lamp's light that the air throws on a surface, as FogLight::lamp_illuminance(); after lamp_words.glsl.
#include "surface_words.glsl"
#define Real4 vec4
#include "harmonics.glsl"
uniform samplerBuffer lamp_terms;       // sixteen colours a point of the air's grid
uniform usamplerBuffer lamp_stand_in;   // of each point, whose light is shown there

vec3 find_lamp_illuminance(vec3 surface, vec3 normal) {
  vec3 p = surface + normal * aim.air_off, most = vec3(aim.air_size.xyz - 1);
  vec3 at = clamp((p - aim.air_origin.xyz) / aim.air_cell.xyz, vec3(0.0), most);
  if (distance(p, aim.air_origin.xyz + at * aim.air_cell.xyz) > aim.air_off) return vec3(0.0);
  ivec3 cell = min(ivec3(at), ivec3(most) - 1);
  vec3 part = at - vec3(cell), sum = vec3(0.0);
  // What the cosine asks for is in the first nine terms.
  float asked[9];
  for (int t = 0; t < 9; ++t)
    asked[t] = harmonics_row(t >> 2, normal)[t & 3] * (t < 1 ? 3.1415927 : t < 4 ? 2.0943951 : 0.7853982);
  for (int c = 0; c < 8; ++c) {
    ivec3 off = ivec3(c & 1, c >> 1 & 1, c >> 2), corner = cell + off;
    vec3 share = mix(1.0 - part, part, vec3(off));
    int i = int(texelFetch(lamp_stand_in, (corner.z * aim.air_size.y + corner.y) * aim.air_size.x + corner.x).x);
    for (int t = 0; t < 9; ++t) sum += texelFetch(lamp_terms, 16 * i + t).rgb * (asked[t] * share.x * share.y * share.z);
  }
  return max(sum, vec3(0.0));
}
