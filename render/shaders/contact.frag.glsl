// The shadows of the lamp, at half the image's size.
uniform sampler2D depth_values;

layout(std140) uniform Contact {
  vec4 lens;   // fx, fy, cx, cy
  vec4 lamp;   // in the optical frame; w: its radius
  vec4 range;  // x: near plane; depth values are this / Z
};

layout(location = 0) out float openness;

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
    float there = range.x / max(value, 1e-9);
    bool known = q.z > 0.02 && all(equal(at, clamp(at, vec2(0.0), last)));
    bool hides = there < q.z * 0.985 - 0.008 && there > q.z * 0.6 - 0.2;
    clear = known && hides ? 0.0 : clear;
  }
  return clear;
}

void main() {
  ivec2 size = textureSize(depth_values, 0);
  ivec2 pixel = min(ivec2(gl_FragCoord.xy) * 2, size - 1);
  float z = range.x / max(texelFetch(depth_values, pixel, 0).x, 1e-9);
  ivec2 cell = ivec2(gl_FragCoord.xy) & 3;
  float part = float((cell.x * 5 + cell.y * 11) & 15) * 0.0625;
  openness = lamp_visible(vec2(pixel), z, float((cell.x * 7 + cell.y * 4) & 15) * 0.3927, part, vec2(size) - 1.0);
}
