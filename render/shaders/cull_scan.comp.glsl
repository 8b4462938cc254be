// Where the runs of each candidate begin in the list of what is drawn, and how many there are in all.
#include "cull_words.glsl"

layout(local_size_x = 256) in;
layout(std430, binding = 6) writeonly buffer CountBlock { uint count; } all_runs;

shared uint sums[256];

void main() {
  uint local = gl_LocalInvocationID.x, share = (uint(candidate_count) + 255u) / 256u;
  uint first = local * share, end = min(first + share, uint(candidate_count)), sum = 0u;
  for (uint i = first; i < end; ++i) sum += runs[i];
  sums[local] = sum;
  for (uint step = 1u; step < 256u; step *= 2u) {
    barrier();
    uint before = local >= step ? sums[local - step] : 0u;
    barrier();
    sums[local] += before;
  }
  barrier();
  uint before = sums[local] - sum;
  for (uint i = first; i < end; ++i) {
    uint of_this = runs[i];
    runs[i] = before;
    before += of_this;
  }
  if (local == 255u) all_runs.count = sums[255];
}
