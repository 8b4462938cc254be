// Where a shadow map of the sun has edges, by tiles of TILE x TILE texels: what stands there throws a shadow that is
// soft as far as the sun's disc is wide, and no pixel elsewhere needs more than one comparison.
// Variants: FIND reads the map, SPREAD goes along one axis and then the other.
// A tile's texel: least depth of what stands beside an edge (1: no edge reaches it) and greatest depth about the tile,
// as two halves of a word, and how far the edges reach (unit: tile).
layout(location = 0) out uvec2 found;

layout(std140) uniform Edges {
  vec4 ground;  // depth of the ground at the map's left lower corner, and how it grows to the right and up
  vec4 scale;   // reach of an edge of depth difference 1 and of any edge, unit: tile; least difference
  ivec4 spread;  // layer of the map; along x, y; tiles to look at on either side
};

// To the next step of 16 bits, so that nothing is lost.
uvec2 coded(float nearest, float most, uint reach) {
  vec2 depth = clamp(vec2(nearest, most), 0.0, 1.0) * 65535.0;
  return uvec2(uint(floor(depth.x)) | uint(ceil(depth.y)) << 16, reach);
}

#ifdef FIND
uniform sampler2DArray shadow_values;

float nearest, farthest;

void compare(float one, float other, float below) {
  float near = min(one, other), far = max(one, other);
  if (far - near < scale.z) return;
  nearest = min(nearest, near);
  farthest = max(farthest, far < 1.0 ? far : below);
}

void main() {
  ivec2 first = ivec2(gl_FragCoord.xy) * TILE, last = textureSize(shadow_values, 0).xy - 1;
  vec2 at = gl_FragCoord.xy * float(TILE) / vec2(last + 1);
  float below = max(ground.x + dot(ground.yz, at), 1.0), most = 0.0;  // where the map shows nothing
  nearest = 1.0, farthest = 0.0;
  float before[TILE + 1];
  for (int y = 0; y <= TILE; ++y) {
    float left = 0.0;
    for (int x = 0; x <= TILE; ++x) {
      float depth = texelFetch(shadow_values, ivec3(min(first + ivec2(x, y), last), spread.x), 0).x;
      if (x > 0) compare(left, depth, below);
      if (y > 0) compare(before[x], depth, below);
      most = max(most, depth);
      left = before[x] = depth;
    }
  }
  float reach = nearest < 1.0 ? ceil((farthest - nearest) * scale.x + scale.y) : 0.0;
  found = coded(nearest, most, uint(min(reach, 255.0)));
}
#else
uniform usampler2DArray tiles;

uvec2 tile_at(ivec2 place) {
  ivec2 last = textureSize(tiles, 0).xy - 1;
  return texelFetch(tiles, ivec3(clamp(place, ivec2(0), last), spread.x), 0).xy;
}

void main() {
  ivec2 here = ivec2(gl_FragCoord.xy);
  uint nearest = 65535u, most = 0u, reach = 0u;
  for (int i = -spread.w; i <= spread.w; ++i) {
    uvec2 tile = tile_at(here + spread.yz * i);
    if (int(tile.y) < abs(i)) continue;
    nearest = min(nearest, tile.x & 65535u), reach = max(reach, tile.y);
  }
  int about = min(int(reach), spread.w);
  for (int i = -about; i <= about; ++i) most = max(most, tile_at(here + spread.yz * i).x >> 16);
  found = uvec2(nearest | most << 16, reach);
}
#endif
