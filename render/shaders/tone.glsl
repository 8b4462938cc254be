// From exposed radiance to display values, in the words of surface_model.glsl.

// The form of Narkowicz's fit of the ACES curve (2015), with a lighter toe: a camera keeps more of its shadows than film.
FN Real tone_curve(Real x) { return clamp((x * (2.51f * x + 0.12f)) / (x * (2.43f * x + 0.66f) + 0.14f), 0.0f, 1.0f); }

// sRGB's transfer function, within 0.001, from square roots.
FN Real encode_srgb(Real x) {
  Real a = sqrt(x), b = sqrt(a), c = sqrt(b);
  return clamp(0.585122381f * a + 0.783140355f * b - 0.368262736f * c, 0.0f, 1.0f);
}

// Noise without visible order, from 0 to 1 (Jimenez 2014). x, y: of the pixel.
FN Real grain(Real x, Real y) { return fract(52.9829189f * fract(x * 0.06711056f + y * 0.00583715f)); }

// Half a step of noise hides the steps of 8 bits. It is another for each pose, see frame.glsl.
FN Real develop(Real x, Real noise) { return encode_srgb(tone_curve(x * 0.8f)) + (noise - 0.5f) * (1.0f / 255.0f); }
