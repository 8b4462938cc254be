// What of a scene is drawn, as passes/visibility_pass.h chooses it: first what showed in the picture before, then what the depth
// of that does not hide.
struct Cluster {
  vec4 centre;  // of a box and of a sphere around it, in the mesh; w: radius of the sphere
  vec4 half_sides;  // of the box; w: smallest cosine between a normal and the axis
  vec4 axis;    // mean normal
  uint first_index, index_count, unused_a, unused_b;
};
struct Candidate {
  uint first_cluster, cluster_count;
  uint first_flag;  // of these, in the table of flags
  uint wanted_without_history;
};
layout(std430, binding = 0) readonly buffer ClusterTable { Cluster clusters[]; };
layout(std430, binding = 1) readonly buffer RecordTable { float records[]; };  // DrawRecord, one a candidate
layout(std430, binding = 2) readonly buffer CandidateTable { Candidate candidates[]; };
layout(std430, binding = 3) buffer FlagTable { uint flags[]; };  // of each cluster of each placed mesh
layout(std430, binding = 4) buffer RunTable { uint runs[]; };    // of each candidate: how many, then how many before it

const uint kShown = 1u, kDrawn = 2u, kWanted = 4u;  // in the next picture's first drawing; in this picture; now

uniform int candidate_count;
