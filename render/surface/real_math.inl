// Functions of numbers and of three of them, named as in GLSL. Included into a namespace that has Real, Int, Mask and what
// can be done with them: of lanes (shading/wide.h), or of one number (surface/scalar_surface.h). Only plain IEEE
// operations, in the order written, so that both give the same bits.

RUBBLE_INLINE Real fract(Real x) { return x - floor(x); }
RUBBLE_INLINE Real mix(Real a, Real b, Real t) { return a * (1.0f - t) + b * t; }
RUBBLE_INLINE Real inverse_sqrt(Real x) { return 1.0f / sqrt(x); }
RUBBLE_INLINE Real smoothstep(float low, float high, Real x) {
  const Real t = clamp((x - low) / (high - low), 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

// Within 2e-7 of the value.
RUBBLE_INLINE Real exp2(Real x) {
  x = clamp(x, -126.0f, 126.0f);
  const Real whole = floor(x + 0.5f), f = x - whole;
  // Taylor's series of 2^f.
  Real p = f * 1.5403530e-4f + 1.3333558e-3f;
  p = p * f + 9.6181291e-3f;
  p = p * f + 5.5504109e-2f;
  p = p * f + 2.4022651e-1f;
  p = p * f + 6.9314718e-1f;
  return (p * f + 1.0f) * real_from_bits((to_int(whole) + 127) << 23);
}
RUBBLE_INLINE Real exp(Real x) { return exp2(x * 1.44269504f); }

// Of what is above 1e-38; within 3e-7.
RUBBLE_INLINE Real log2(Real x) {
  // x = 2^e m with m between the square roots of a half and of two.
  const Int bits = bits_of(x) - 0x3f3504f3;
  const Real e = to_real(bits >> 23), m = real_from_bits((bits & 0x007fffff) + 0x3f3504f3);
  const Real t = (m - 1.0f) / (m + 1.0f), t2 = t * t;
  Real p = t2 * 0.32059889f + 0.41219858f;  // 2 / (ln 2 (2 k + 1))
  p = p * t2 + 0.57707802f;
  p = p * t2 + 0.96179669f;
  p = p * t2 + 2.88539008f;
  return p * t + e;
}
RUBBLE_INLINE Real pow(Real x, float y) { return exp2(log2(max(x, 1e-30f)) * y); }

// Of some hundred radians at most; within 1e-4.
RUBBLE_INLINE Real sin(Real x) {
  Real turns = x * 0.15915494f;
  turns -= floor(turns + 0.5f);
  // Back to a quarter of a turn.
  turns = select(turns > 0.25f, 0.5f - turns, select(turns < -0.25f, -0.5f - turns, turns));
  const Real a = turns * 6.2831853f, a2 = a * a;
  Real p = a2 * 2.7557319e-6f - 1.9841270e-4f;
  p = p * a2 + 8.3333333e-3f;
  p = p * a2 - 1.6666667e-1f;
  return a + a * a2 * p;
}

struct Real2 {
  Real x, y;  // a lane each
};

struct Real3 {
  Real x, y, z;  // a lane each

  RUBBLE_INLINE Real3& operator+=(const Real3& b) { return x += b.x, y += b.y, z += b.z, *this; }
  RUBBLE_INLINE Real3& operator*=(const Real3& b) { return x *= b.x, y *= b.y, z *= b.z, *this; }
  RUBBLE_INLINE Real3& operator*=(Real s) { return x *= s, y *= s, z *= s, *this; }
};

RUBBLE_INLINE Real3 real3(Real x, Real y, Real z) { return {x, y, z}; }
RUBBLE_INLINE Real3 operator+(const Real3& a, const Real3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
RUBBLE_INLINE Real3 operator-(const Real3& a, const Real3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
RUBBLE_INLINE Real3 operator-(const Real3& a) { return {-a.x, -a.y, -a.z}; }
RUBBLE_INLINE Real3 operator*(const Real3& a, const Real3& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
RUBBLE_INLINE Real3 operator*(const Real3& a, Real s) { return {a.x * s, a.y * s, a.z * s}; }
RUBBLE_INLINE Real dot(const Real3& a, const Real3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
RUBBLE_INLINE Real3 cross(const Real3& a, const Real3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
RUBBLE_INLINE Real length(const Real3& a) { return sqrt(dot(a, a)); }
RUBBLE_INLINE Real3 normalize(const Real3& a) { return a * inverse_sqrt(dot(a, a)); }
RUBBLE_INLINE Real3 mix(const Real3& a, const Real3& b, Real t) {
  return {mix(a.x, b.x, t), mix(a.y, b.y, t), mix(a.z, b.z, t)};
}
RUBBLE_INLINE Real3 select(Mask m, const Real3& a, const Real3& b) {
  return {select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z)};
}
// The first three of four numbers, in all lanes.
RUBBLE_INLINE Real3 all_lanes(const float (&v)[4]) { return {real(v[0]), real(v[1]), real(v[2])}; }

// a point (x, y, z, 1) times a row.
RUBBLE_INLINE Real times_row(const float (&row)[4], const Real3& p) {
  return p.x * row[0] + p.y * row[1] + p.z * row[2] + row[3];
}
