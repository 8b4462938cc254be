// Spherical harmonics to the third order, as lighting/harmonics.h has them. In the words of air_medium.glsl.

FN Real4 row_of(Real x, Real y, Real z, Real w) {
  Real4 row;
  row.x = x, row.y = y, row.z = z, row.w = w;
  return row;
}
// Spherical harmonics to the third order, four at a time, as harmonics_of().
FN Real4 harmonics_row(int four, Real3 v) {
  Real x = v.x, y = v.y, z = v.z, z2 = z * z;
  if (four == 0) return row_of(real(0.2820948f), 0.4886025f * y, 0.4886025f * z, 0.4886025f * x);
  if (four == 1)
    return row_of(1.0925484f * x * y, 1.0925484f * y * z, 0.3153916f * (3.0f * z2 - 1.0f), 1.0925484f * x * z);
  if (four == 2)
    return row_of(0.5462742f * (x * x - y * y), 0.5900436f * y * (3.0f * x * x - y * y), 2.8906114f * x * y * z,
                  0.4570458f * y * (5.0f * z2 - 1.0f));
  return row_of(0.3731763f * z * (5.0f * z2 - 3.0f), 0.4570458f * x * (5.0f * z2 - 1.0f), 1.4453057f * z * (x * x - y * y),
                0.5900436f * x * (x * x - 3.0f * y * y));
}
