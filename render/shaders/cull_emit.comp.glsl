// The commands that draw the wanted clusters, neighbours together: as glMultiDrawElementsIndirect() reads them.
#include "cull_words.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 5) buffer CommandTable { uint commands[]; };  // five words each
layout(std430, binding = 6) buffer TriangleBlock { uint triangles; } drawn;

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= uint(candidate_count)) return;
  Candidate here = candidates[i];
  uint at = runs[i] * 5u, triangles = 0u;
  bool running = false;
  for (uint k = 0u; k < here.cluster_count; ++k) {
    bool wanted = (flags[here.first_flag + k] & kWanted) != 0u;
    if (wanted) {
      Cluster c = clusters[here.first_cluster + k];
      triangles += c.index_count / 3u;
      if (running) {
        commands[at - 5u] += c.index_count;
      } else {
        commands[at] = c.index_count, commands[at + 1u] = 1u, commands[at + 2u] = c.first_index;
        commands[at + 3u] = 0u, commands[at + 4u] = i;
        at += 5u;
      }
    }
    running = wanted;
  }
  if (triangles > 0u) atomicAdd(drawn.triangles, triangles);
}
