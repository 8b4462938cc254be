// Surfaces with the colours of a user's file. Only where PAINTS, their number, is not 0. PAINTED: the look that says so;
// PAINT_SIDE: of the images, in texels.
uniform usamplerBuffer paint_table;  // two a paint, then three a triangle, by its last vertex
uniform sampler2DArray paint_images;

struct Paint {
  vec3 albedo, normal;  // the latter in the mesh frame
  float roughness, metalness, reflectance;  // as paint_over() wants them
};

// w: weights of the corners; ab, ac: edges, mesh frame; footprint: width of what is seen across the surface there.
Paint find_paint(uint triangle, vec3 w, vec3 ab, vec3 ac, vec3 normal, float footprint) {
  int at = 2 * PAINTS + 3 * int(triangle);
  vec4 t0 = uintBitsToFloat(texelFetch(paint_table, at));
  uvec4 t1 = texelFetch(paint_table, at + 1), t2 = texelFetch(paint_table, at + 2);
  vec4 p0 = uintBitsToFloat(texelFetch(paint_table, 2 * int(t1.z)));
  vec4 p1 = uintBitsToFloat(texelFetch(paint_table, 2 * int(t1.z) + 1));
  Paint p;
  p.albedo = p0.rgb * (w.x * decode_srgb3(unpackUnorm4x8(t2.x).rgb) + w.y * decode_srgb3(unpackUnorm4x8(t2.y).rgb) +
                       w.z * decode_srgb3(unpackUnorm4x8(t2.z).rgb));
  p.normal = normal;
  p.roughness = p0.w, p.metalness = p1.x, p.reflectance = p1.y;
  vec2 uv2 = uintBitsToFloat(t1.xy);
  vec2 uv = w.x * t0.xy + w.y * t0.zw + w.z * uv2;
  vec2 d1 = t0.zw - t0.xy, d2 = uv2 - t0.xy;
  PaintAxes axes = find_paint_axes(ab, ac, d1.x, d1.y, d2.x, d2.y);
  float level = paint_level(axes, PAINT_SIDE, footprint);
  if (p1.z >= 0.0)
    p.albedo *= decode_srgb3(textureLod(paint_images, vec3(uv.x, 1.0 - uv.y, p1.z), level).rgb);
  if (p1.w >= 0.0) {
    vec4 texel = textureLod(paint_images, vec3(uv.x, 1.0 - uv.y, p1.w), level);
    p.roughness *= texel.z;
    p.metalness *= texel.w;
    p.normal = bend_paint(axes, normal, texel.x, texel.y);
  }
  return p;
}
