// Whose light stands for a point at places that see none of the corners about them: the brightest of what it does not see about
// it, which is where the camera of the lamp is; of points inside a piece, of all about it.
#include "fog_words.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 0) writeonly buffer StandInTable { uint stand_in[]; };
uniform usamplerBuffer nearest, hidden;

const float kClearly = 0.7;

void main() {
  int i = int(gl_GlobalInvocationID.x);
  if (i >= grid.size.w) return;
  int found = int(texelFetch(nearest, i).x);
  bool open = found == i;
  uint unseen = texelFetch(hidden, i).x;
  float chosen = air_points[found].light;
  for (int k = 0; k < 27; ++k) {
    int j = find_neighbour(i, k);
    if (texelFetch(nearest, j).x != uint(j) || (open && (unseen >> k & 1u) == 0u)) continue;
    if (air_points[j].light * kClearly <= chosen) continue;
    chosen = air_points[j].light, found = j;
  }
  stand_in[i] = uint(found);
}
