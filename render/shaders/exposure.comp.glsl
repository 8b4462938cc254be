// The exposure that a metered image asks for, as find_exposure() of lighting/exposure.h: written into the block of the
// frame, where resolve.frag.glsl reads it. EXPOSURE_AT: its number there; KEY, DUSK: as ExposureOptions.
layout(local_size_x = 256) in;
layout(std430, binding = 0) buffer FrameNumbers { float frame_numbers[]; };
uniform sampler2D metered;  // log2 of luminance in kcd/m2; below -1000: nothing is seen there

shared vec2 sums[256];  // weighted stops, and weights

float key_of(float kcd) { return 1.03 - 2.0 / (2.0 + log(kcd * 1000.0 + 1.0) / log(10.0)); }

void main() {
  ivec2 size = textureSize(metered, 0);
  int first = int(gl_LocalInvocationIndex);
  vec2 sum = vec2(0.0);
  for (int i = first; i < size.x * size.y; i += 256) {
    ivec2 at = ivec2(i % size.x, i / size.x);
    float stops = texelFetch(metered, at, 0).x;
    if (!(stops > -1000.0)) continue;
    bool middle = 4 * at.x > size.x && 4 * at.x < 3 * size.x && 4 * at.y > size.y && 4 * at.y < 3 * size.y;
    float weight = middle ? 2.0 : 1.0;
    sum += vec2(weight * max(stops, -40.0), weight);
  }
  sums[first] = sum;
  barrier();
  for (int half_count = 128; half_count > 0; half_count /= 2) {
    if (first < half_count) sums[first] += sums[first + half_count];
    barrier();
  }
  if (first > 0) return;
  float exposure = 0.1;
  if (sums[0].y > 0.0) {
    float stops = sums[0].x / sums[0].y;
    float brightness = clamp(key_of(exp2(stops)) / key_of(4.0), DUSK, 1.0);
    exposure = clamp(KEY * brightness * exp2(-stops), 1e-5, 1e6);
  }
  frame_numbers[EXPOSURE_AT] = exposure;
}
