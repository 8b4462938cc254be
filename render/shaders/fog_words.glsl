// The lamp's light in fog, scattered any number of times: the passes of transport/air_transfer.h for a lamp, by points of the
// grid of the air and directions of their links.
#define kDirections 64

layout(std430, binding = 3) readonly buffer GridBlock {
  vec4 origin, cell;  // of the grid
  ivec4 size;         // its points along each axis, and all of them
  vec4 directions[kDirections];
  vec4 harmonics[4 * kDirections];  // of each direction
  float light_reach, lamp_reach;    // unit: m
  float tolerance;                  // change of all light by which it ends
} grid;
layout(std430, binding = 4) buffer StateBlock {
  uint brightest;  // of all points in clear air, as the bits of a float
  uint done;
  float before;    // all light, an iteration ago
  uint iterations;
} state;
struct AirPoint {
  vec3 usual;     // mean radiance in clear air
  uint lit;       // 0: inside a piece, or dark; else 1 more than how many cells away from light
  vec3 response;  // of surfaces near it
  float light;    // of all that arrives, the strength of the mean term
  vec3 direct;    // illuminance by the lamp
  float unused_a;
  vec3 to_lamp;
  float unused_b;
};
layout(std430, binding = 5) buffer AirPointTable { AirPoint air_points[]; };

const float kMean = 0.2820948;  // from the first term to the mean over all directions
const float kAngle = 12.566371 / float(kDirections);

ivec3 cell_of(int i) { return ivec3(i % grid.size.x, i / grid.size.x % grid.size.y, i / (grid.size.x * grid.size.y)); }
vec3 place_of(int i) { return grid.origin.xyz + grid.cell.xyz * vec3(cell_of(i)); }
float smallest_cell() { return min(grid.cell.x, min(grid.cell.y, grid.cell.z)); }

// Number `place` of the 27 points about i; i itself at the border.
int find_neighbour(int i, int place) {
  ivec3 at = cell_of(i) + ivec3(place % 3, place / 3 % 3, place / 9) - 1;
  if (any(lessThan(at, ivec3(0))) || any(greaterThanEqual(at, grid.size.xyz))) return i;
  return (at.z * grid.size.y + at.y) * grid.size.x + at.x;
}

// Of a link's part within the box; meets: how far away what it meets is.
float length_of(int i, int direction, float meets) {
  vec3 d = grid.directions[direction].xyz;
  vec3 from = grid.cell.xyz * vec3(cell_of(i)), box = grid.cell.xyz * vec3(grid.size.xyz - 1);
  float border = grid.light_reach;
  for (int a = 0; a < 3; ++a)
    if (abs(d[a]) > 1e-6) border = min(border, (d[a] > 0.0 ? box[a] - from[a] : -from[a]) / d[a]);
  return max(min(meets, border), 0.0);
}
