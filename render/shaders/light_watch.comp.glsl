// Which pixels of an event camera report a change of their light since the image before: EventPixels::cross() of
// sensors/event_camera.cpp finds the times of their events. DARK: as WatchedPixels.
layout(local_size_x = 256) in;
layout(std430, binding = 0) buffer Levels { vec2 levels[]; };                     // seen last, of the last report
layout(std430, binding = 1) readonly buffer Thresholds { vec2 thresholds[]; };  // up, down
layout(std430, binding = 2) buffer Count { uint change_count; };
struct Change {
  uint pixel;
  float from, to, reference;
};
layout(std430, binding = 3) writeonly buffer Changes { Change changes[]; };
uniform sampler2D radiance;  // kcd/m2
uniform int first_image;

shared uint in_group, first_of_group;

void main() {
  ivec2 size = textureSize(radiance, 0);
  int pixel = int((gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 256u + gl_LocalInvocationIndex);
  if (gl_LocalInvocationIndex == 0u) in_group = 0u;
  barrier();
  bool reports = false;
  uint place = 0u;
  Change change;
  if (pixel < size.x * size.y) {
    vec3 light = texelFetch(radiance, ivec2(pixel % size.x, pixel / size.x), 0).rgb;
    float to = log(max(1000.0 * dot(light, vec3(0.2126, 0.7152, 0.0722)), 0.0) + float(DARK));
    float from = levels[pixel].x, reference = levels[pixel].y;
    if (first_image != 0) from = reference = to;
    change = Change(uint(pixel), from, to, reference);
    float up = thresholds[pixel].x, down = thresholds[pixel].y;
    if (to > from) {
      for (; reference + up <= to; reference += up) reports = true;
    } else if (to < from) {
      for (; reference - down >= to; reference -= down) reports = true;
    }
    levels[pixel] = vec2(to, reference);
    if (reports) place = atomicAdd(in_group, 1u);
  }
  barrier();
  if (gl_LocalInvocationIndex == 0u && in_group > 0u) first_of_group = atomicAdd(change_count, in_group);
  barrier();
  if (reports) changes[first_of_group + place] = change;
}
