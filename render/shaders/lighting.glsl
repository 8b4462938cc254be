// The same formulas as lighting.cpp.
uniform sampler2D sky_map;

// Radiance of the sky in a direction that points up, from the octahedral map.
vec3 sky_radiance(vec3 d) {
  vec2 p = d.xy / (abs(d.x) + abs(d.y) + max(d.z, 0.0));
  return texture(sky_map, vec2(p.x + p.y, p.x - p.y) * 0.5 + 0.5).rgb;
}

// The sky as the eye meets it: with the sun's disc, and trees and roofs far away.
vec3 backdrop(vec3 d) {
  vec3 sky = sky_radiance(d);
  float c = dot(d, sun_direction.xyz);
  sky += sun_radiance.rgb * smoothstep(0.999985, 0.999992, c);
  vec2 a = normalize(d.xy);
  float ridge = 0.017 + 0.006 * sin(5.3 * a.x + 2.0 * sin(3.1 * a.y)) + 0.004 * sin(11.0 * a.y + 1.7) +
                0.0025 * sin(37.0 * a.x + 4.0 * sin(19.0 * a.y)) +
                0.0016 * sin(120.0 * a.y - 70.0 * a.x) * sin(83.0 * a.x) +
                0.0008 * sin(310.0 * a.x + 230.0 * a.y);
  float behind = smoothstep(ridge - 0.0008, ridge + 0.0008, d.z);
  return mix(mix(skyline.rgb, sky, 0.55 + 10.0 * max(d.z, 0.0)), sky, behind);
}

// Illuminance of light i on a facing surface; `to_light` gets the direction.
vec3 light_at(const int i, const int type, vec3 p, out vec3 to_light) {
  if (type == 0) {
    to_light = -light_axis[i].xyz;
    return light_colour[i].rgb;
  }
  vec3 offset = light_position[i].xyz - p;
  float d2 = max(dot(offset, offset), 1e-6);
  to_light = offset * inversesqrt(d2);
  float strength = 1.0 / d2;
  if (type == 1) {
    float c = clamp((dot(-to_light, light_axis[i].xyz) - light_axis[i].w) * light_colour[i].w, 0.0, 1.0);
    strength *= c * c * (3.0 - 2.0 * c);
  }
  return light_colour[i].rgb * strength;
}

// Illuminance of the lamp on a facing surface. Intensity falls to half at the half-power angle:
// I = I0 2^-((1 - cos a) / (1 - cos h))^2. A ring of radius R seen from its axis at d gives
// I d / (d^2 + R^2)^1.5: hence `to_lamp` is shorter than 1 near it.
vec3 lamp_at(vec3 p, out vec3 to_lamp, out float lamp_distance) {
  vec3 offset = lamp_position.xyz - p;
  float d2 = max(dot(offset, offset), 1e-6);
  lamp_distance = sqrt(d2);
  float x = (1.0 + dot(offset, lamp_axis.xyz) / lamp_distance) * lamp_axis.w;
  float far2 = d2 + lamp_position.w;
  to_lamp = offset * inversesqrt(far2);
  return lamp_colour.rgb * (exp2(-x * x) / far2);
}

#ifdef AIR
// What beams lose in the mean air along a straight line from a height z, as Air::turned_depth().
float air_depth(float z, float slope, float way) {
  return fog_depth(air_low.w, air_high.w, z, slope, way) + air_drops.x * way;
}

// Share of light i that the air lets pass: of a beam from far away all up to the box.
float air_passes(const int i, const int type, vec3 p, vec3 to_light) {
  float near = 0.0, far = 1e5;
  if (type != 0) {
    far = length(light_position[i].xyz - p);
  } else {
    vec3 way = mix(to_light, vec3(1e-9), lessThan(abs(to_light), vec3(1e-9)));
    vec3 a = (air_low.xyz - p) / way, b = (air_high.xyz - p) / way;
    vec3 first = min(a, b), last = max(a, b);
    near = max(near, max(first.x, max(first.y, first.z)));
    far = min(far, min(last.x, min(last.y, last.z)));
    if (near >= far) return 1.0;
  }
  return exp(-air_depth(p.z + to_light.z * near, to_light.z, far - near));
}
#endif

uniform sampler2DArrayShadow shadow_map;

// 1 where light i arrives, 0 in its shadow.
float light_visible(const int i, const int type, const int first_view, const int views, vec3 p,
                    vec3 normal) {
  int view_index = first_view;
  vec3 q;
  if (type == 0) {
    q = p + normal * (light_position[i].w * 1.6);
  } else {
    vec3 from_light = p - light_position[i].xyz;
    q = p + normal * (light_position[i].w * length(from_light) * 1.6 + 0.002);
    if (views == 6) {
      vec3 a = abs(from_light);
      view_index += a.x >= max(a.y, a.z) ? (from_light.x > 0.0 ? 0 : 1)
                  : a.y >= a.z ? (from_light.y > 0.0 ? 2 : 3) : (from_light.z > 0.0 ? 4 : 5);
    }
  }
  vec4 h = vec4(q, 1.0);
  int row = view_index * 4;
  vec4 clip = vec4(dot(shadow_rows[row], h), dot(shadow_rows[row + 1], h),
                   dot(shadow_rows[row + 2], h), dot(shadow_rows[row + 3], h));
  vec3 at;
  if (type == 0) {
    at = vec3(clip.xy * 0.5 + 0.5, min(clip.z, 1.0));
    if (any(notEqual(at.xy, clamp(at.xy, 0.0, 1.0)))) {
      // Outside the last map nothing is in the way.
      if (views < 2) return 1.0;
      h.xyz = p + normal * (light_axis[i].w * 1.6);
      row += 4, view_index += 1;
      clip = vec4(dot(shadow_rows[row], h), dot(shadow_rows[row + 1], h), dot(shadow_rows[row + 2], h), 1.0);
      at = vec3(clip.xy * 0.5 + 0.5, min(clip.z, 1.0));
      if (any(notEqual(at.xy, clamp(at.xy, 0.0, 1.0)))) return 1.0;
    }
  } else {
    if (clip.w <= 0.0) return 0.0;
    at = vec3(clip.xy / clip.w * 0.5 + 0.5, clip.z / clip.w);
  }
  return texture(shadow_map, vec4(at.xy, float(view_index), at.z));
}
