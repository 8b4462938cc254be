// Directions and light as the tables of a scene have them.

// A direction from two 16-bit signed parts (Cigolle et al. 2014); not of unit length.
vec3 unpack_normal(uint code) {
  vec2 p = vec2(ivec2(int(code << 16), int(code)) >> 16) * (1.0 / 32767.0);
  vec3 n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
  float t = max(-n.z, 0.0);
  n.x += n.x >= 0.0 ? -t : t;
  n.y += n.y >= 0.0 ? -t : t;
  return n;
}

// dot(n, result) is the illuminance of a surface of normal n; `chroma` gets red, green and blue
// shares that add up to 1.
vec3 unpack_light(uvec2 code, out vec2 red_blue) {
  red_blue = vec2(float((code.y >> 16) & 255u), float(code.y >> 24)) * (1.0 / 255.0);
  return vec3(unpackHalf2x16(code.x), unpackHalf2x16(code.y).x);
}
