// Surfaces with the colours of a user's file, as find_paint() in transport/paint_point.h. Only where PAINTS, their
// number, is not 0. PAINTED: the look that says so; PAINT_SIDE: of the images, in texels.
uniform usamplerBuffer paint_table;  // two a paint, then three a triangle, by its last vertex
uniform sampler2DArray paint_images;

vec3 decode_srgb(vec3 code) {
  return mix(pow((code + 0.055) / 1.055, vec3(2.4)), code / 12.92, lessThanEqual(code, vec3(0.04045)));
}

struct Paint {
  vec3 albedo, normal;  // the latter in the mesh frame
  float roughness, metalness, reflectance;
};

// w: weights of the corners; ab, ac: edges, mesh frame; footprint: width of what is seen across the surface there.
Paint find_paint(uint triangle, vec3 w, vec3 ab, vec3 ac, vec3 normal, float footprint) {
  int at = 2 * PAINTS + 3 * int(triangle);
  vec4 t0 = uintBitsToFloat(texelFetch(paint_table, at));
  uvec4 t1 = texelFetch(paint_table, at + 1), t2 = texelFetch(paint_table, at + 2);
  vec4 p0 = uintBitsToFloat(texelFetch(paint_table, 2 * int(t1.z)));
  vec4 p1 = uintBitsToFloat(texelFetch(paint_table, 2 * int(t1.z) + 1));
  Paint p;
  p.albedo = p0.rgb * (w.x * decode_srgb(unpackUnorm4x8(t2.x).rgb) + w.y * decode_srgb(unpackUnorm4x8(t2.y).rgb) +
                       w.z * decode_srgb(unpackUnorm4x8(t2.z).rgb));
  p.normal = normal;
  float rough = p0.w;
  p.metalness = p1.x;
  vec2 uv2 = uintBitsToFloat(t1.xy);
  vec2 uv = w.x * t0.xy + w.y * t0.zw + w.z * uv2;
  vec2 d1 = t0.zw - t0.xy, d2 = uv2 - t0.xy;
  float turn = d1.x * d2.y - d1.y * d2.x;
  float level = log2(max(PAINT_SIDE * sqrt(abs(turn) / max(length(cross(ab, ac)), 1e-20)) * footprint, 1.0));
  if (p1.z >= 0.0)
    p.albedo *= decode_srgb(textureLod(paint_images, vec3(uv.x, 1.0 - uv.y, p1.z), level).rgb);
  if (p1.w >= 0.0) {
    vec4 texel = textureLod(paint_images, vec3(uv.x, 1.0 - uv.y, p1.w), level);
    rough *= texel.z;
    p.metalness *= texel.w;
    vec2 slope = (texel.xy * 255.0 - 128.0) / 127.0;
    vec3 along = ab * d2.y - ac * d1.y, across = ac * d1.x - ab * d2.x;
    along -= normal * dot(along, normal);
    across -= normal * dot(across, normal);
    slope *= turn < 0.0 ? -1.0 : 1.0;
    vec3 bent = along * (slope.x * inversesqrt(max(dot(along, along), 1e-30))) +
                across * (slope.y * inversesqrt(max(dot(across, across), 1e-30)));
    p.normal = normalize(bent + normal * sqrt(max(1.0 - dot(slope, slope), 0.04)));
  }
  p.roughness = max(rough * rough, 0.02);
  p.reflectance = mix(p1.y, min(dot(p.albedo, vec3(0.2126, 0.7152, 0.0722)), 0.99), p.metalness);
  return p;
}
