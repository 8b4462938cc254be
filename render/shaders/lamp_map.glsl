// What the lamp meets first in each direction, on the octahedral map; after lamp_words.glsl.
layout(std430, binding = 2) readonly buffer MapTable { float map_distances[]; };

float distance_towards(vec3 d) {
  d /= abs(d.x) + abs(d.y) + abs(d.z);
  vec2 p = d.z >= 0.0 ? d.xy : (1.0 - abs(d.yx)) * vec2(d.x >= 0.0 ? 1.0 : -1.0, d.y >= 0.0 ? 1.0 : -1.0);
  ivec2 texel = clamp(ivec2((p * 0.5 + 0.5) * float(aim.map_side)), ivec2(0), ivec2(aim.map_side - 1));
  return map_distances[texel.y * aim.map_side + texel.x];
}

// Illuminance on a facing surface.
vec3 find_lamp_light(vec3 p) {
  vec3 way = p - aim.place.xyz;
  float d2 = max(dot(way, way), 1e-6);
  float x = (1.0 - dot(way, aim.axis.xyz) * inversesqrt(d2)) * aim.axis.w;
  return aim.intensity.rgb * (exp2(-x * x) / d2);
}
