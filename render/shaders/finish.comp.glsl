// A picture as three bytes a pixel, four pixels an invocation. Variants: SMOOTH: with the stairs along silhouettes smoothed, as
// passes/antialias.h does on the processor, with the same bits.
layout(local_size_x = 64) in;
layout(std430, binding = 0) writeonly buffer RgbTable { uint words[]; };
uniform sampler2D colours;
uniform sampler2D depth_values;

const int kFarthestEnd = 10;      // how far a stair is followed; unit: pixel
const int kLeastContrast = 12;    // of luma, 0 to 255
const float kDepthEdge = 0.006;   // bend of depth, as a share of it

ivec3 colour_at(ivec2 p) { return ivec3(texelFetch(colours, p, 0).rgb * 255.0 + 0.5); }
int luma(ivec2 p) {
  ivec3 c = colour_at(p);
  return (77 * c.r + 150 * c.g + 29 * c.b) >> 8;
}

#ifdef SMOOTH
// Depth values are linear over a plane, so a bend or jump is where the mean of two opposite neighbours differs from the middle.
bool bends(ivec2 p, ivec2 step) {
  float v = texelFetch(depth_values, p, 0).x;
  float a = texelFetch(depth_values, p - step, 0).x, b = texelFetch(depth_values, p + step, 0).x;
  return abs(a + b - 2.0 * v) > max(v, max(a, b)) * kDepthEdge;
}

// Steps along the edge until the mean across it leaves that of the pixel by more than half of the contrast.
int find_end(ivec2 p, ivec2 across, ivec2 along, int room, int mean2, int limit2, out int difference) {
  difference = 0;
  for (int n = 1; n <= kFarthestEnd; ++n) {
    if (n > room) return n;
    p += along;
    difference = luma(p) + luma(p + across) - mean2;
    if (abs(difference) >= limit2) return n;
  }
  return kFarthestEnd + 1;
}

ivec3 smoothed(ivec2 p, ivec2 size) {
  ivec3 here = colour_at(p);
  int m = luma(p), n = luma(p - ivec2(0, 1)), s = luma(p + ivec2(0, 1)), w = luma(p - ivec2(1, 0)), e = luma(p + ivec2(1, 0));
  int range = max(max(max(m, n), max(s, w)), e) - min(min(min(m, n), min(s, w)), e);
  if (range < kLeastContrast) return here;
  bool level = abs(n + s - 2 * m) >= abs(w + e - 2 * m);
  // Which neighbour lies across the edge, and which way the edge runs.
  int back = level ? n : w, front = level ? s : e;
  bool forward = abs(front - m) > abs(back - m);
  ivec2 step = level ? ivec2(0, 1) : ivec2(1, 0), along = level ? ivec2(1, 0) : ivec2(0, 1), across = forward ? step : -step;
  int other = forward ? front : back, mean2 = m + other, limit2 = max(2, abs(m - other) / 2);
  int place = level ? p.x : p.y, last = (level ? size.x : size.y) - 1, before, after;
  int to_before = find_end(p, across, -along, place, mean2, limit2, before);
  int to_after = find_end(p, across, along, last - place, mean2, limit2, after);
  bool nearer_before = to_before < to_after;
  int nearest = nearer_before ? to_before : to_after, difference = nearer_before ? before : after;
  float share = 0.0;
  // Only the side of the stair that the nearer end belongs to is moved.
  if ((2 * m - mean2 < 0) != (difference < 0)) share = max(0.0, 0.5 - float(nearest) / float(to_before + to_after));
  // A lone pixel that stands out from all around it.
  int around = (2 * (n + s + w + e) - 8 * m) / 8;
  float lone = min(1.0, float(abs(around)) / float(range));
  share = max(share, lone * lone * 0.35);
  vec3 a = vec3(here), b = vec3(colour_at(p + across));
  return ivec3(a + (b - a) * share + 0.5);
}
#endif

void main() {
  ivec2 size = textureSize(colours, 0);
  int number = int((gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 64u + gl_LocalInvocationID.x);
  uint bytes[12];
  for (int k = 0; k < 4; ++k) {
    int i = 4 * number + k;
    ivec3 colour = ivec3(0);
    if (i < size.x * size.y) {
      ivec2 p = ivec2(i % size.x, i / size.x);
      colour = colour_at(p);
#ifdef SMOOTH
      bool inner = all(greaterThan(p, ivec2(0))) && all(lessThan(p, size - 1));
      if (inner && (bends(p, ivec2(1, 0)) || bends(p, ivec2(0, 1)))) colour = smoothed(p, size);
#endif
    }
    for (int c = 0; c < 3; ++c) bytes[3 * k + c] = uint(colour[c]);
  }
  if (4 * number >= size.x * size.y) return;
  for (int k = 0; k < 3; ++k)
    words[3 * number + k] = bytes[4 * k] | bytes[4 * k + 1] << 8 | bytes[4 * k + 2] << 16 | bytes[4 * k + 3] << 24;
}
