// The lamp's beam at each point of the air.
#include "frame.glsl"
#include "surface_words.glsl"
#include "lamp_words.glsl"
#include "lamp_map.glsl"
#include "fog_words.glsl"

layout(local_size_x = 64) in;

void main() {
  int i = int(gl_GlobalInvocationID.x);
  if (i >= grid.size.w) return;
  vec3 p = place_of(i), way = aim.place.xyz - p;
  float away = max(length(way), 1e-3), cell = smallest_cell();
  air_points[i].direct = vec3(0.0);
  air_points[i].to_lamp = vec3(0.0, 0.0, 1.0);
  if (away > grid.lamp_reach) return;
  if (away >= 1e-3 && away >= distance_towards(-way) * (1.0 + aim.slack) + aim.near) return;
  vec3 to_lamp = way / away;
  // The mean over what the point stands for: next to the lamp the square of the distance is that of a cell.
  float spread = away * away / (away * away + 0.1 * cell * cell);
  float depth = fog_depth(air_low.w, air_high.w, p.z, to_lamp.z, away) + air_drops.x * away;
  air_points[i].direct = find_lamp_light(p) * (spread * exp(-depth));
  air_points[i].to_lamp = to_lamp;
}
