// Darkness in corners too small for the baked light, at half the image's size.
//
// Depth values are near / Z, which is linear over a plane on the image: the mean of two opposite
// neighbours exceeds the middle only where the surface is hollow. No normal is needed.
uniform sampler2D depth_values;

layout(std140) uniform Contact {
  vec4 reach;  // radius (m) * focal length (pixel), radius (m), 1 / near plane, near plane
};

layout(location = 0) out float openness;

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
    hollow += max(a + b, 0.0) / part;
    direction = vec2(direction.x - direction.y, direction.x + direction.y) * 0.7071068;
  }
  openness = 1.0 / (1.0 + 0.4 * hollow / max(limit, 1e-9));
}
