// Light from all around in fog along every so-many-th ray of the table of the air, by orders of spherical harmonics: see
// RadianceGrid of lighting/radiance_grid.h. An entry an invocation. Variants: RAYS, as in resolve.frag.glsl.
#include "frame.glsl"
#include "air_words.glsl"
#include "harmonics.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = 2) readonly buffer FieldBlock {
  vec4 origin, cell;  // of the grid
  ivec4 size;         // its points, and the parts of a cell along each axis
  vec4 open[16];
  int has_lamp, has_seen, has_stand_in, has_lamp_stand_in, has_lamp_ends;
} field;
layout(std430, binding = 3) readonly buffer Seen { uint seen_corners[]; };  // four a word
layout(std430, binding = 4) readonly buffer StandIn { uint stand_in[]; };
layout(std430, binding = 6) readonly buffer LampStandIn { uint lamp_stand_in[]; };

layout(std430, binding = 5) writeonly buffer AroundTable { vec4 around_rows[]; };
// Sixteen colours a point. Of the lamp: what the air has scattered, then what surfaces have.
uniform samplerBuffer terms, lamp_terms;

const float kPi = 3.1415927;

struct Orders {
  vec3 l[4];
};
struct Corners {
  int at[8];
  float weight[8];
};

void harmonics_of(vec3 v, out float y[16]) {
  for (int four = 0; four < 4; ++four) {
    vec4 row = harmonics_row(four, v);
    for (int k = 0; k < 4; ++k) y[four * 4 + k] = row[k];
  }
}
int order_of(int t) { return t < 1 ? 0 : t < 4 ? 1 : t < 9 ? 2 : 3; }

vec3 grid_length() { return field.cell.xyz * vec3(field.size.xyz - 1); }
vec3 nearest_point(vec3 p) { return clamp(p, field.origin.xyz, field.origin.xyz + grid_length()); }

int count_points() { return field.size.x * field.size.y * field.size.z; }

uint seen_from(vec3 p) {
  if (field.has_seen == 0) return 255u;
  int cuts = field.size.w, cell = 0, part = 0, row = 1, parts = 1;
  for (int i = 0; i < 3; ++i) {
    float at = max((p[i] - field.origin[i]) / field.cell[i], 0.0);
    int low = min(int(at), field.size[i] - 2), within = clamp(int((at - float(low)) * float(cuts)), 0, cuts - 1);
    cell += low * row, part += within * parts;
    row *= field.size[i], parts *= cuts;
  }
  int number = cell * parts + part;
  return seen_corners[number >> 2] >> ((number & 3) * 8) & 255u;
}

// As AirGrid::about() and Corners::keep().
Corners corners_about(vec3 p, bool of_lamp) {
  ivec3 low;
  vec3 part;
  for (int i = 0; i < 3; ++i) {
    float most = float(field.size[i] - 1), at = clamp((p[i] - field.origin[i]) / field.cell[i], 0.0, most);
    low[i] = min(int(at), int(most) - 1);
    part[i] = at - float(low[i]);
  }
  Corners corners;
  for (int k = 0; k < 8; ++k) {
    ivec3 off = ivec3(k & 1, k >> 1 & 1, k >> 2);
    corners.at[k] = ((low.z + off.z) * field.size.y + low.y + off.y) * field.size.x + low.x + off.x;
    vec3 share = mix(1.0 - part, part, vec3(off));
    corners.weight[k] = share.x * share.y * share.z;
  }
  uint seen = seen_from(p);
  if (seen == 255u || (of_lamp ? field.has_lamp_stand_in : field.has_stand_in) == 0) return corners;
  float sum = 0.0;
  for (int k = 0; k < 8; ++k)
    if ((seen >> k & 1u) != 0u) sum += corners.weight[k];
  float share = min(sum / 0.25, 1.0);
  float of_seen = sum > 0.0 ? share / sum : 0.0, of_others = sum < 1.0 ? (1.0 - share) / (1.0 - sum) : 0.0;
  for (int k = 0; k < 8; ++k) {
    bool is_seen = (seen >> k & 1u) != 0u;
    corners.weight[k] *= is_seen ? of_seen : of_others;
    if (!is_seen) corners.at[k] = int(of_lamp ? lamp_stand_in[corners.at[k]] : stand_in[corners.at[k]]);
  }
  return corners;
}

// Of each table: 0: of the place, in stops as factor_in_stops(); 1, 2: of the lamp, by the air and by surfaces.
const int kPlace = 0, kLampAir = 1, kLampEnds = 2;
vec3 term_of(int table, int point, int t) {
  if (table == kPlace) return texelFetch(terms, point * 16 + t).rgb;
  return texelFetch(lamp_terms, ((table == kLampEnds ? count_points() : 0) + point) * 16 + t).rgb;
}

float factor_in_stops(Corners corners) {
  float light[8], most = 0.0, mean = 0.0, stops = 0.0;
  for (int k = 0; k < 8; ++k) {
    light[k] = dot(term_of(kPlace, corners.at[k], 0), vec3(1.0 / 3.0));
    most = max(most, light[k]);
    mean += corners.weight[k] * light[k];
  }
  if (most <= 0.0 || mean <= 0.0) return 1.0;
  for (int k = 0; k < 8; ++k) stops += corners.weight[k] * log2(max(light[k] / most, 1.0 / 4096.0));
  return min(most * exp2(stops) / mean, 1.0);
}

void add_towards(Corners corners, int table, float factor, float y[16], inout Orders sum) {
  for (int k = 0; k < 8; ++k) {
    if (corners.weight[k] == 0.0) continue;
    for (int t = 0; t < 16; ++t) sum.l[order_of(t)] += term_of(table, corners.at[k], t) * (factor * corners.weight[k] * y[t]);
  }
}
Orders towards(Corners corners, bool of_lamp, float y[16]) {
  Orders sum = Orders(vec3[4](vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0)));
  add_towards(corners, of_lamp ? kLampAir : kPlace, of_lamp ? 1.0 : factor_in_stops(corners), y, sum);
  if (!of_lamp && field.has_lamp_ends != 0) add_towards(corners, kLampEnds, 1.0, y, sum);
  return sum;
}

Orders open_towards(float y[16]) {
  Orders sum = Orders(vec3[4](vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0)));
  for (int t = 0; t < 16; ++t) sum.l[order_of(t)] += field.open[t].xyz * y[t];
  return sum;
}

vec3 sum_of(Orders o) { return o.l[0] + o.l[1] + o.l[2] + o.l[3]; }

// As RadianceGrid::add_disc(), as far as it goes the way of y.
void add_disc(vec3 p, int quarter, float share, float y[16], inout Orders sum) {
  vec3 size = grid_length();
  vec3 side = vec3((quarter & 1) != 0 ? 0.25 : -0.25, (quarter & 2) != 0 ? 0.25 : -0.25, quarter == 0 || quarter == 3 ? 0.25 : -0.25);
  vec3 way = field.origin.xyz + size * (0.5 + side) - p;
  float enters = 0.0;  // as a share of the way
  for (int a = 0; a < 3; ++a) {
    float border = way[a] > 0.0 ? field.origin[a] : field.origin[a] + size[a];
    if (abs(way[a]) > 1e-6) enters = max(enters, min((border - p[a]) / way[a], 1.0));
  }
  float away = length(way);
  vec3 to_disc = way / away, facing = abs(to_disc);
  float shown = facing.x * size.y * size.z + facing.y * size.z * size.x + facing.z * size.x * size.y;
  float disc2 = shown / (4.0 * kPi);  // radius squared
  float e2 = max(1.0 - disc2 / (away * away), 0.0), edge = sqrt(e2);
  // Integrals over the disc of Legendre's polynomials.
  float disc[4] = float[4](1.0 - edge, (1.0 - e2) / 2.0, edge * (1.0 - e2) / 2.0, (1.0 - e2) * (5.0 * e2 - 1.0) / 8.0);
  float there[16];
  harmonics_of(to_disc, there);
  vec3 instead = sum_of(towards(corners_about(p + way * enters, false), false, there)) - sum_of(open_towards(there));
  for (int t = 0; t < 16; ++t) sum.l[order_of(t)] += instead * (2.0 * kPi * share * disc[order_of(t)] * there[t] * y[t]);
}

void store(int entry, int part, Orders o) {
  for (int c = 0; c < 3; ++c) around_rows[entry * 6 + part * 3 + c] = vec4(o.l[0][c], o.l[1][c], o.l[2][c], o.l[3][c]);
}

// Slices that a ray reads which is between this one and its neighbours.
int slices_about(ivec2 at) {
  int most = 0;
  ivec2 low = max(ivec2(0), (at - 1) * d.rays_an_entry), high = min(ivec2(d.columns, d.rows), (at + 2) * d.rays_an_entry);
  for (int y = low.y; y < high.y; ++y)
    for (int x = low.x; x < high.x; ++x) most = max(most, wanted[y * d.columns + x]);
  return most;
}

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  int slice = int(gl_GlobalInvocationID.z) + 1;
  if (at.x >= d.around_columns || at.y >= d.around_rows || slice >= slices_about(at)) return;
  vec3 eye, way;
  find_air_ray(vec2(at * d.rays_an_entry + d.rays_an_entry / 2) + 0.5, eye, way);
  vec3 p = eye + way * (0.5 * (d.distance[slice - 1] + d.distance[slice])), near = nearest_point(p);
  float y[16];
  harmonics_of(way, y);
  int entry = (slice * d.around_rows + at.y) * d.around_columns + at.x;
  Orders all_light = towards(corners_about(near, false), false, y);
  float off = length(p - near);
  Orders none = Orders(vec3[4](vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0)));
  if (off > 0.0) {
    // Next to the box what the border's nearest sees; farther away the open surroundings with the box in them.
    float part = 4.0 * off / length(grid_length()), share = 1.0 / ((1.0 + part * part) * (1.0 + part * part));
    Orders open = open_towards(y);
    for (int l = 0; l < 4; ++l) all_light.l[l] = all_light.l[l] * share + open.l[l] * (1.0 - share);
    for (int k = 0; k < 4; ++k) add_disc(p, k, 1.0 - share, y, all_light);
  }
  store(entry, 0, all_light);
  if (field.has_lamp == 0 || off > 0.0) {
    store(entry, 1, none);
  } else {
    store(entry, 1, towards(corners_about(p, true), true, y));
  }
}
