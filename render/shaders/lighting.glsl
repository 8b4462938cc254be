// The same formulas as lighting.cpp.
vec3 sky_radiance(vec3 d) {
  float level = 1.0 - max(d.z, 0.0);
  level *= level;
  level *= level;
  float s = max(dot(d, sun_direction.xyz), 0.0);
  s *= s;
  s *= s;
  s *= s;
  return mix(sky_zenith.rgb, sky_horizon.rgb, level) + sky_glow.rgb * s;
}

// Illuminance of the main light on a facing surface; `to_light` gets the direction.
vec3 light_at(vec3 p, out vec3 to_light) {
#if LIGHT_TYPE == 0
  to_light = -light_axis.xyz;
  return light_colour.rgb;
#else
  vec3 offset = light_position.xyz - p;
  float d2 = max(dot(offset, offset), 1e-6);
  to_light = offset * inversesqrt(d2);
  float strength = 1.0 / d2;
#if LIGHT_TYPE == 1
  float c = clamp((dot(-to_light, light_axis.xyz) - light_axis.w) * light_colour.w, 0.0, 1.0);
  strength *= c * c * (3.0 - 2.0 * c);
#endif
  return light_colour.rgb * strength;
#endif
}

// Illuminance of the lamp on a facing surface. Intensity falls to half at the half-power angle:
// I = I0 2^-((1 - cos a) / (1 - cos h))^2.
vec3 lamp_at(vec3 p, out vec3 to_lamp, out float lamp_distance) {
  vec3 offset = lamp_position.xyz - p;
  float d2 = max(dot(offset, offset), 1e-6);
  float inverse = inversesqrt(d2);
  lamp_distance = d2 * inverse;
  to_lamp = offset * inverse;
  float x = (1.0 + dot(to_lamp, lamp_axis.xyz)) * lamp_axis.w;
  return lamp_colour.rgb * (exp2(-x * x) / d2);
}

uniform sampler2DArrayShadow shadow_map;

// 1 where the main light arrives, 0 in its shadow.
float light_visible(vec3 p, vec3 normal) {
  int view_index = 0;
#if LIGHT_TYPE == 0
  vec3 q = p + normal * shadow_texel.x * 1.6;
#else
  vec3 from_light = p - light_position.xyz;
  float reach = length(from_light);
  vec3 q = p + normal * (shadow_texel.x * reach * 1.6 + 0.002);
#if SHADOW_VIEWS == 6
  vec3 a = abs(from_light);
  view_index = a.x >= max(a.y, a.z) ? (from_light.x > 0.0 ? 0 : 1)
             : a.y >= a.z ? (from_light.y > 0.0 ? 2 : 3) : (from_light.z > 0.0 ? 4 : 5);
#endif
#endif
  vec4 h = vec4(q, 1.0);
  int row = view_index * 4;
  vec4 clip = vec4(dot(shadow_rows[row], h), dot(shadow_rows[row + 1], h),
                   dot(shadow_rows[row + 2], h), dot(shadow_rows[row + 3], h));
#if LIGHT_TYPE == 0
  vec3 at = vec3(clip.xy * 0.5 + 0.5, min(clip.z, 1.0));
  // Outside the map nothing is in the way.
  if (any(notEqual(at.xy, clamp(at.xy, 0.0, 1.0)))) return 1.0;
#else
  if (clip.w <= 0.0) return 0.0;
  vec3 at = vec3(clip.xy / clip.w * 0.5 + 0.5, clip.z / clip.w);
#endif
  return texture(shadow_map, vec4(at.xy, float(view_index), at.z));
}
