// Darkness in corners too small for the baked light, and the shadows of the lamp, at half the image's
// size.
//
// Depth values are near / Z, which is linear over a plane on the image: the mean of two opposite
// neighbours exceeds the middle only where the surface is hollow. No normal is needed.
uniform sampler2D depth_values;

layout(std140) uniform Contact {
  vec4 reach;  // radius (m) * focal length (pixel), radius (m), 1 / near plane, near plane
  vec4 lens;   // fx, fy, cx, cy
  vec4 lamp;   // in the optical frame; w: its radius
};

layout(location = 0) out vec2 openness;

#ifdef LAMP
// The lamp is close to the lens, so what stands between it and a surface is seen: the way from the
// surface to the lamp is followed on the depth image. `turn` picks a spot of the lamp.
float lamp_visible(vec2 pixel, float z, float turn, float part, vec2 last) {
  vec3 p = vec3((pixel - lens.zw) / lens.xy, 1.0) * z;
  vec3 to = lamp.xyz + vec3(cos(turn), sin(turn), 0.0) * lamp.w - p;
  float clear = 1.0;
  for (int i = 0; i < LAMP_STEPS; ++i) {
    float s = (float(i) + part) * (4.0 / float(LAMP_STEPS));
    vec3 q = p + to * (s * s / (1.0 + s * s));
    vec2 at = q.xy / max(q.z, 1e-3) * lens.xy + lens.zw;
    float value = texelFetch(depth_values, ivec2(clamp(at, vec2(0.0), last) + 0.5), 0).x;
    float there = reach.w / max(value, 1e-9);
    bool known = q.z > 0.02 && all(equal(at, clamp(at, vec2(0.0), last)));
    bool hides = there < q.z * 0.985 - 0.008 && there > q.z * 0.6 - 0.2;
    clear = known && hides ? 0.0 : clear;
  }
  return clear;
}
#endif

void main() {
  ivec2 size = textureSize(depth_values, 0);
  ivec2 pixel = min(ivec2(gl_FragCoord.xy) * 2, size - 1);
  float middle = texelFetch(depth_values, pixel, 0).x;
  float z = reach.w / max(middle, 1e-9);
  float radius = clamp(reach.x / z, 2.0, 48.0);
  // A tap far in front of the surface says nothing about its own hollows.
  float limit = middle * reach.y / z;
  // Four directions turned from pixel to pixel, in a pattern of 4 by 4.
  ivec2 cell = ivec2(gl_FragCoord.xy) & 3;
  float turn = float((cell.x * 4 + cell.y * 7) & 15) * (0.785398 / 16.0);
  vec2 direction = vec2(cos(turn), sin(turn));
  float hollow = 0.0;
  for (int i = 0; i < 4; ++i) {
    float part = 0.25 + 0.25 * float((i * 3 + cell.x + cell.y) & 3);
    ivec2 step = ivec2(direction * radius * part + 0.5);
    float a = texelFetch(depth_values, clamp(pixel + step, ivec2(0), size - 1), 0).x;
    float b = texelFetch(depth_values, clamp(pixel - step, ivec2(0), size - 1), 0).x;
    a = clamp(a - middle, -limit, limit);
    b = clamp(b - middle, -limit, limit);
    // A bore of half a metre's radius is no hollow, nor are the edges between its 48 facets: their darkness is baked.
    hollow += max(a + b - 0.13 * part * limit, 0.0) / part;
    direction = vec2(direction.x - direction.y, direction.x + direction.y) * 0.7071068;
  }
  openness = vec2(1.0 / (1.0 + 0.4 * hollow / max(limit, 1e-9)), 1.0);
#ifdef LAMP
  float part = float((cell.x * 5 + cell.y * 11) & 15) * 0.0625;
  openness.y = lamp_visible(vec2(pixel), z, float((cell.x * 7 + cell.y * 4) & 15) * 0.3927,
                            part, vec2(size) - 1.0);
#endif
}
