// Optical depth of fog that thins with height, as Air::fog_depth(). In the words of surface_model.glsl, and
//   either(m, n)  where one of both is true

// Along a straight line from a height z. rate: 1 / height in which it thins by e; 0: it does not.
FN Real fog_depth(float density, float rate, Real z, Real slope, Real way) {
  Real even = density * way;
  if (rate <= 0.0f) return even;
  Real end = z + slope * way;
  Mask below = z < 0.0f, ends_below = end < 0.0f;
  Mask all_below = both(z <= 0.0f, end <= 0.0f), partly = either(below, ends_below);
  // The part below the ground, where it is even.
  Real steep = select(partly, slope, real(1.0f));
  Real low = select(partly, select(below, -z / steep, end / steep), real(0.0f));
  Real above = select(partly, way - low, way), from = select(partly, max(z, 0.0f), z);
  Real x = slope * above * rate;
  Mask level = abs(x) < 1e-2f;
  Real mean = select(level, 1.0f - x * (0.5f - x * (1.0f / 6.0f)), (1.0f - exp(-x)) / select(level, real(1.0f), x));
  return select(all_below, even, density * (low + above * exp(-from * rate) * mean));
}
