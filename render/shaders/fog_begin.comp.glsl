// What comes to each point of the air from the surfaces that the lamp lights, before the air scatters any.
#include "fog_words.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer MatterTable { vec4 matter[]; };  // two a point: scattered by order; x: extinction
layout(std430, binding = 1) readonly buffer LitTable { uint lit[]; };        // as in lamp_send.comp.glsl
layout(std430, binding = 6) writeonly buffer EndsTable { vec4 ends_in[]; };  // by direction, then by point
layout(std430, binding = 7) writeonly buffer AirTable { vec4 air_in[]; };
uniform usamplerBuffer link_ends;  // distance and bake point, by direction, then by point
uniform usamplerBuffer nearest;
uniform samplerBuffer radiance;    // of bake points that are lit

#include "fog_surface.glsl"

void main() {
  int i = int(gl_GlobalInvocationID.x), count = grid.size.w;
  if (i >= count) return;
  bool open = texelFetch(nearest, i).x == uint(i);
  vec3 sum = vec3(0.0);
  for (int k = 0; k < kDirections; ++k) {
    vec3 light = vec3(0.0);
    if (open) {
      uvec2 end = texelFetch(link_ends, k * count + i).xy;
      light = surface_light(end.y);
      if (light != vec3(0.0)) light *= exp(-matter[2 * i + 1].x * length_of(i, k, uintBitsToFloat(end.x)));
    }
    ends_in[k * count + i] = vec4(light, 0.0), air_in[k * count + i] = vec4(0.0);
    sum += light;
  }
  vec3 usual = (sum * kAngle * grid.harmonics[0].x + air_points[i].direct * grid.harmonics[0].x) * kMean;
  air_points[i].usual = usual;
  air_points[i].lit = 0u;
  atomicMax(state.brightest, floatBitsToUint(dot(usual, vec3(1.0 / 3.0))));
}
