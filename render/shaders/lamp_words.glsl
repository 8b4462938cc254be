// The lamp's light by way of surfaces: the passes of transport/lamp_bounce.h, a bake point or a node an invocation.
struct BakePoint {
  vec3 position;  // world; unit: m
  uint normal;    // as in geometry.glsl
  vec3 albedo;
  uint stand_in;  // of a point inside a piece an open one nearby, else kNone
};
struct Seen {
  uint first_point;  // of a piece that the lamp may see
  uint points_before;  // of the pieces before it in this list
};

layout(std430, binding = 0) readonly buffer AimBlock {
  vec4 place;      // of the lamp; w: extinction of the air about it, 1/m
  vec4 axis;       // the way it looks; w: 1 / (1 - cosine of the half-power angle)
  vec4 intensity;  // kcd
  uint seen_count, point_count;  // of those pieces
  uint links_a_point, unused;
  float reach, fade, near, slack;  // as in transport/lamp_reach.h
  int map_side;
  float air_off;             // from surfaces, where the air's light is asked for; unit: m
  vec4 air_origin, air_cell; // of the grid of the air
  ivec4 air_size;            // its points along each axis
} aim;
layout(std430, binding = 1) readonly buffer SeenList { Seen seen[]; };

const uint kNone = 0xfffffffdu, kClosed = 0x80000000u;  // as BakeLinks
const float kPi = 3.1415927;

// Work groups in rows, for there may be more than one row holds.
uint find_number() { return (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 64u + gl_LocalInvocationID.x; }

// The last piece that has no more points before it.
Seen find_seen(uint number) {
  uint low = 0u, high = aim.seen_count;
  while (high - low > 1u) {
    uint middle = (low + high) / 2u;
    if (seen[middle].points_before <= number) low = middle; else high = middle;
  }
  return seen[low];
}

// Of light so far from the lamp.
float kept_at(float away) { return clamp((aim.reach - away) / aim.fade, 0.0, 1.0); }
