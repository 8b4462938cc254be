// What a pixel's surface is: normal, layers and baked light, from the triangle it lies on.

#ifdef PAINTS
#include "paint.glsl"
#endif

struct Surface {
  vec3 normal, face_normal;  // world; with and without relief
  vec3 ambient;              // klx
  SurfaceLayers layers;
};

uniform sampler2DArray look_textures;
uniform sampler2D ground_map;  // from above: debris on the ground, tone; see ground_map.h

// Share of even light from all around that the mirrors throw back at an angle of this cosine.
float mirrored_share(Surface s, float cosine) {
  float share = gloss_share(s.layers, cosine);
#ifdef WET
  share += film_share(s.layers, cosine);
#endif
  return share;
}

Surface find_surface(uint placed, uint triangle, vec3 world, vec3 direction, float z) {
  Surface s;
  // The point in the mesh frame.
  int at = int(placed) * 4;
  vec4 mx = uintBitsToFloat(texelFetch(placed_table, at));
  vec4 my = uintBitsToFloat(texelFetch(placed_table, at + 1));
  vec4 mz = uintBitsToFloat(texelFetch(placed_table, at + 2));
  uvec4 mw = texelFetch(placed_table, at + 3);
  float scale = uintBitsToFloat(mw.x);
  vec4 h = vec4(world, 1.0);
  vec3 p = vec3(dot(mx, h), dot(my, h), dot(mz, h));

  // The triangle, and the weights of its corners.
  uvec4 tri = texelFetch(triangle_table, int(triangle));
  uvec4 c0 = texelFetch(vertex_table, int(tri.x));
  uvec4 c1 = texelFetch(vertex_table, int(tri.y));
  uvec4 c2 = texelFetch(vertex_table, int(tri.z));
  vec3 a = uintBitsToFloat(c0.xyz);
  vec3 ab = uintBitsToFloat(c1.xyz) - a, ac = uintBitsToFloat(c2.xyz) - a;
  vec3 area = cross(ab, ac);
  float inverse_area = 1.0 / max(dot(area, area), 1e-30);
  vec3 ap = p - a;
  float w1 = dot(cross(ap, ac), area) * inverse_area;
  float w2 = dot(cross(ab, ap), area) * inverse_area;
  w1 = clamp(w1, 0.0, 1.0);
  w2 = clamp(w2, 0.0, 1.0 - w1);
  float w0 = 1.0 - w1 - w2;
  vec3 face = area * inversesqrt(max(dot(area, area), 1e-30));
  vec3 smooth_normal = w0 * unpack_normal(c0.w) + w1 * unpack_normal(c1.w) +
                       w2 * unpack_normal(c2.w);
  smooth_normal = normalize(smooth_normal + 0.001 * face);

  // Baked light.
  vec2 rb0, rb1, rb2;
  int first_light = int(mw.y);
  vec3 lw;
  ivec3 node = find_light_nodes(tri, vec3(w0, w1, w2), lw) + first_light;
  vec3 l0 = unpack_light(texelFetch(light_table, node.x).xy, rb0);
  vec3 l1 = unpack_light(texelFetch(light_table, node.y).xy, rb1);
  vec3 l2 = unpack_light(texelFetch(light_table, node.z).xy, rb2);
  vec3 light = lw.x * l0 + lw.y * l1 + lw.z * l2;
  vec2 red_blue = lw.x * rb0 + lw.y * rb1 + lw.z * rb2;

  // The look, on the one of 26 planes that the surface is nearest to: little stretching, one fetch.
  int look = find_look(tri) * 4;
  vec4 dark = looks[look], bright = looks[look + 1], accent = looks[look + 2];
  vec4 more = looks[look + 3];
  uint turn = mw.w & 3u;  // which axis of the mesh is longest: grain runs along it
  vec3 q = (turn == 1u ? p.yzx : turn == 2u ? p.zxy : p) * scale;
  vec2 seed = vec2(float(mw.z & 0xffffu), float(mw.z >> 16));
  if ((mw.w & 4u) != 0u) {  // cut from a body, whose textures run on
    vec3 o = vec3(seed * (1.0 / 1024.0) - 32.0, float((mw.w >> 3) & 0x1fffu) * (1.0 / 256.0) - 2.0);
    q += turn == 1u ? o.yzx : turn == 2u ? o.zxy : o;
    seed = vec2(0.0);
  }
  vec3 f = turn == 1u ? smooth_normal.yzx : turn == 2u ? smooth_normal.zxy : smooth_normal;
  TextureAxes axes = find_texture_axes(q, f);
  vec2 uv = vec2(dot(q, axes.along), dot(q, axes.across)) * dark.w + seed * (1.0 / 65536.0);
  // Slow variation over metres.
  vec2 map = texture(ground_map, vec2(map_place(world.x, world.z, ground.x, ground.z),
                                      map_place(world.y, world.z, ground.y, ground.z))).xy;
  float slow = 4.0 * map.y - 2.0;
  if (more.x < 0.5) uv.x += wall_shift(uv.y);
  vec3 rx = mx.xyz * scale, ry = my.xyz * scale, rz = mz.xyz * scale;  // rotation rows
  s.face_normal = rx * face.x + ry * face.y + rz * face.z;
  float grazing = max(-dot(s.face_normal, direction), 0.05);
  float level = more.w + log2(z * lens.x) - 0.5 * log2(grazing) - 0.25;
  vec4 texel = textureLod(look_textures, vec3(uv, more.x), max(level, 0.0));
  if (more.y < 0.2 && slow > -0.6) {
    vec4 other = textureLod(look_textures, vec3(uv.yx * 0.83 + 0.37, more.x), max(level, 0.0)).yxzw;
    texel = mix(texel, other, other_part(slow, texel.z, other.z));
  }

  // Relief; a bump below 0 is a glow.
  vec2 slope = (texel.xy * 4.0 - 2.0) * max(bright.w, 0.0);
  vec3 tu = turn == 1u ? axes.along.zxy : turn == 2u ? axes.along.yzx : axes.along;
  vec3 tv = turn == 1u ? axes.across.zxy : turn == 2u ? axes.across.yzx : axes.across;
  vec3 bent = smooth_normal - tu * slope.x - tv * slope.y;
  s.normal = normalize(rx * bent.x + ry * bent.y + rz * bent.z);
  vec3 smooth_world = rx * smooth_normal.x + ry * smooth_normal.y + rz * smooth_normal.z;

  SurfaceDetail detail = SurfaceDetail(texel.z, texel.w, texel.z, slow, map.x, smooth_world.z, more.x == SOIL);
  LookColours colours = LookColours(dark.rgb, bright.rgb, accent.rgb, more.y, more.z, floor(accent.w) * (1.0 / 255.0),
                                    max(fract(accent.w) * (1.0 / 0.99), 0.02), max(-bright.w, 0.0));
  s.layers = find_layers(colours, detail, float((mw.w >> 16) & 255u) * (2.0 / 255.0) - 1.0,
                         float(mw.w >> 24) * (2.0 / 255.0) - 1.0);
#ifdef PAINTS
  if (look == PAINTED * 4) {
    float across = z * lens.x * inversesqrt(grazing) * 0.84 / scale;
    Paint paint = find_paint(triangle, vec3(w0, w1, w2), ab, ac, smooth_normal, across);
    s.layers = paint_over(s.layers, paint.albedo, paint.roughness, paint.metalness, paint.reflectance);
    s.normal = normalize(rx * paint.normal.x + ry * paint.normal.y + rz * paint.normal.z);
  }
#endif
#ifdef GLASS
  if (look == GLASS * 4) s.layers = make_glass(s.layers, -dot(s.face_normal, direction), texel.z);
#endif
#ifdef WET
#ifdef SURROUNDED
  // Along a street the eye sees a texture repeat: only what is finer than an eighth of it stands out of the water.
  detail.raised += 0.5 - textureLod(look_textures, vec3(uv, more.x), max(level, log2(float(textureSize(look_textures, 0).x)) - 3.0)).z;
#endif
  WetSurface wet = add_water(s.layers, detail, wetness.x);
  s.layers = wet.layers;
  s.normal = normalize(mix(s.normal, smooth_world, wet.even));
#endif

  float lit = max(dot(light, s.normal), 0.15 * length(light));
  s.ambient = vec3(red_blue.x, 1.0 - red_blue.x - red_blue.y, red_blue.y) * (3.0 * lit);
  return s;
}
