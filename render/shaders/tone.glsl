// From exposed radiance to display values.
vec3 tone_curve(vec3 x) {
  // The form of Narkowicz's fit of the ACES curve (2015), with a lighter toe: a camera keeps more of
  // its shadows than film.
  return clamp((x * (2.51 * x + 0.12)) / (x * (2.43 * x + 0.66) + 0.14), 0.0, 1.0);
}

// sRGB's transfer function, within 0.001, from square roots.
vec3 srgb(vec3 x) {
  vec3 a = sqrt(x), b = sqrt(a), c = sqrt(b);
  return clamp(0.585122381 * a + 0.783140355 * b - 0.368262736 * c, 0.0, 1.0);
}

// Noise without visible order, from 0 to 1 (Jimenez 2014).
float grain(vec2 pixel) {
  return fract(52.9829189 * fract(dot(pixel, vec2(0.06711056, 0.00583715))));
}

vec3 develop(vec3 x, float noise) {
  // Half a step of noise hides the steps of 8 bits. It is another for each pose, see frame.glsl.
  return srgb(tone_curve(x * 0.8)) + (noise - 0.5) * (1.0 / 255.0);
}
