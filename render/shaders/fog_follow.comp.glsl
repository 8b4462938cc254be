// Along each link: what lies at its end arrives weakened, and the air on the way adds what it scattered in the iteration before.
#include "fog_words.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 1) readonly buffer LitTable { uint lit[]; };
layout(std430, binding = 2) readonly buffer EmittedTable { vec4 emitted[]; };
layout(std430, binding = 6) writeonly buffer EndsTable { vec4 ends_in[]; };
layout(std430, binding = 7) writeonly buffer AirTable { vec4 air_in[]; };
uniform usamplerBuffer link_ends;
uniform usamplerBuffer first_place;   // by point, then by direction: where the places of a link begin in seen_corners
uniform usamplerBuffer seen_corners;  // of each place which of the corners about it it sees
uniform samplerBuffer radiance;

#include "fog_surface.glsl"

const float kLeastShare = 0.02;  // of what the corners weigh that a place sees, for them to stand for all eight
const float kWiden = 0.5;        // as AirLinks::cut()

// The cell about a place, and the weights of those of its corners that are seen; false: none is.
bool find_corners(vec3 at, uint seen, out int low, out float weight[8]) {
  ivec3 cell = clamp(ivec3(at), ivec3(0), grid.size.xyz - 2);
  vec3 part = at - vec3(cell);
  low = (cell.z * grid.size.y + cell.y) * grid.size.x + cell.x;
  float sum = 0.0;
  for (int c = 0; c < 8; ++c) {
    vec3 share = mix(1.0 - part, part, vec3(c & 1, c >> 1 & 1, c >> 2));
    weight[c] = (seen >> c & 1u) != 0u ? share.x * share.y * share.z : 0.0;
    sum += weight[c];
  }
  if (sum < kLeastShare) return false;
  for (int c = 0; c < 8; ++c) weight[c] /= sum;
  return true;
}
int corner_of(int low, int c) {
  return low + (c & 1) + (c >> 1 & 1) * grid.size.x + (c >> 2) * grid.size.x * grid.size.y;
}

void main() {
  int i = int(gl_GlobalInvocationID.x), k = int(gl_GlobalInvocationID.y), count = grid.size.w;
  if (i >= count || state.done != 0u) return;
  if (air_points[i].lit == 0u) {
    air_in[k * count + i] = ends_in[k * count + i] = vec4(0.0);
    return;
  }
  uvec2 end = texelFetch(link_ends, k * count + i).xy;
  float meets = uintBitsToFloat(end.x), length = length_of(i, k, meets), passed = 1.0;
  int place = int(texelFetch(first_place, i * kDirections + k).x);
  vec3 from = vec3(cell_of(i)), way = grid.directions[k].xyz / grid.cell.xyz, sum = vec3(0.0);
  int low;
  float weight[8];
  for (float s = 0.0; s < length;) {
    float step = min(max(smallest_cell(), kWiden * s), length - s);
    vec4 here = vec4(0.0);
    if (find_corners(from + way * (s + 0.5 * step), texelFetch(seen_corners, place).x, low, weight)) {
      for (int c = 0; c < 8; ++c)
        if (weight[c] > 0.0) here += emitted[k * count + corner_of(low, c)] * weight[c];
    } else {
      here = emitted[k * count + i];
    }
    ++place;
    float through = exp(-here.w * step);
    sum += here.rgb * (passed * (1.0 - through));
    passed *= through;
    s += step;
  }
  vec3 far = surface_light(end.y);
  if (far != vec3(0.0) && meets <= length) {
    vec3 at = from + way * max(length - 0.5 * smallest_cell(), 0.5 * length), response = vec3(0.0);
    if (find_corners(at, texelFetch(seen_corners, place).x, low, weight)) {
      for (int c = 0; c < 8; ++c)
        if (weight[c] > 0.0) response += air_points[corner_of(low, c)].response * weight[c];
    } else {
      response = air_points[i].response;
    }
    far *= response;
  }
  air_in[k * count + i] = vec4(sum, 0.0), ends_in[k * count + i] = vec4(far * passed, 0.0);
}
