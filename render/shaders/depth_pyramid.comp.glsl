// The farthest depth value of tiles of 4 x 4 pixels, of 2 x 2 of these, and so on, as DepthPyramid of camera/culling.h has them:
// a level each time. A tile an invocation. Variants: FIRST: of the image.
layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = 0) buffer PyramidTable { float farthest[]; };
uniform sampler2D depth;
uniform ivec4 level;       // columns, rows, where it begins, where the one before it does
uniform ivec2 before_size; // columns and rows of that

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, level.xy))) return;
  float least = 1e30;
#ifdef FIRST
  ivec2 size = textureSize(depth, 0), high = min(at * 4 + 4, size);
  for (int y = at.y * 4; y < high.y; ++y)
    for (int x = at.x * 4; x < high.x; ++x) least = min(least, texelFetch(depth, ivec2(x, y), 0).x);
#else
  ivec2 high = min(at * 2 + 2, before_size);
  for (int y = at.y * 2; y < high.y; ++y)
    for (int x = at.x * 2; x < high.x; ++x) least = min(least, farthest[level.w + y * before_size.x + x]);
#endif
  farthest[level.z + at.y * level.x + at.x] = least;
}
