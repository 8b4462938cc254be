// The lamp's light that a surface sends, by the bake point at the end of a link.
vec3 surface_light(uint point) {
  const uint kDark = 0xfffffffeu;  // from here on: nothing, or the sky
  if (point >= kDark || (lit[point / 32u] >> (point % 32u) & 1u) == 0u) return vec3(0.0);
  return texelFetch(radiance, int(point)).rgb;
}
