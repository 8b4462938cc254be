// What a pixel's surface is: normal, albedo and baked light, from the triangle it lies on.
struct Surface {
  vec3 normal, face_normal;  // world; with and without relief
  vec3 albedo;
  vec3 ambient;  // klx
  // Mirrors on top, as transport/reflection.h has them: share covered, reflectance, roughness.
  vec3 gloss;
#ifdef GLOW
  vec3 glow;  // kcd/m2
#endif
#ifdef WET
  float film;  // share covered by water
#endif
#ifdef GLASS
  vec3 clear;  // share of light that goes straight through
#endif
};

uniform sampler2DArray look_textures;
uniform sampler2D ground_map;  // from above: debris on the ground, tone; see ground_map.h

// Schlick's approximation of Fresnel's law.
float fresnel(float reflectance, float cosine) {
  float c = 1.0 - cosine, c2 = c * c;
  return reflectance + (1.0 - reflectance) * c2 * c2 * c;
}

// pi times the BRDF of a rough mirror, as transport/reflection.h has it: the distribution of Trowbridge and Reitz, with
// Smith's shadowing of correlated heights (Heitz 2014). Cosines: normal and half-way, eye and half-way, normal and
// light, normal and eye.
float mirror_lobe(float reflectance, float alpha, float facing, float half_way, float lit, float seen) {
  float a2 = alpha * alpha;
  float d = facing * facing * (a2 - 1.0) + 1.0;
  float shadowing = lit * sqrt(seen * seen * (1.0 - a2) + a2) + seen * sqrt(lit * lit * (1.0 - a2) + a2);
  return fresnel(reflectance, half_way) * a2 / (d * d * 2.0 * max(shadowing, 1e-3));
}

const float kWaterReflectance = 0.02, kFilmRoughness = 0.12;

float gloss_lobe(Surface s, vec3 to_light, vec3 to_eye) {
  vec3 h = normalize(to_light + to_eye);
  float facing = clamp(dot(h, s.normal), 0.0, 1.0), half_way = clamp(dot(h, to_eye), 0.0, 1.0);
  float lit = max(dot(to_light, s.normal), 0.0), seen = max(dot(to_eye, s.normal), 0.0);
  float lobe = s.gloss.x * mirror_lobe(s.gloss.y, s.gloss.z, facing, half_way, lit, seen);
#ifdef WET
  lobe += s.film * mirror_lobe(kWaterReflectance, kFilmRoughness, facing, half_way, lit, seen);
#endif
  return lobe;
}

// Share of even light from all around that the mirrors throw back at an angle of this cosine: rough ones rise less
// towards grazing angles (Lagarde 2011).
float mirrored_share(Surface s, float cosine) {
  float c = 1.0 - clamp(cosine, 0.0, 1.0), c2 = c * c, steep = c2 * c2 * c;
  float share = s.gloss.x * (s.gloss.y + max(1.0 - sqrt(s.gloss.z) - s.gloss.y, 0.0) * steep);
#ifdef WET
  share += s.film * (kWaterReflectance + (1.0 - sqrt(kFilmRoughness)) * steep);
#endif
  return share;
}

#ifdef GLASS
// A sheet of glass, see materials/glass.h and LookSurfaces::add_glass(). bright: of its texture.
void add_glass(inout Surface s, float cosine, float bright) {
  float c = clamp(cosine, 0.01, 1.0);
  float inner = sqrt(1.0 - (1.0 - c * c) / (GLASS_INDEX * GLASS_INDEX));
  vec2 face = vec2((c - GLASS_INDEX * inner) / (c + GLASS_INDEX * inner),
                   (GLASS_INDEX * c - inner) / (GLASS_INDEX * c + inner));
  face *= face;
  vec2 enters = (1.0 - face) * (1.0 - face), twice = face * face;
  vec3 clear = exp2(GLASS_CLEAR / inner), both = clear * clear;
  vec3 passed = 0.5 * (enters.x * clear / (1.0 - twice.x * both) + enters.y * clear / (1.0 - twice.y * both));
  vec2 mirrored = face + face * enters * both.y / (1.0 - twice * both.y);
  // What dust covers is matt.
  float dust = (1.0 - s.gloss.x) * GLASS_DUST;
  float covered = dust + (1.0 - dust) * (HAZE_LEAST + HAZE_MORE * bright);
  s.gloss.xy = vec2((1.0 - covered) * 0.5 * (mirrored.x + mirrored.y), 1.0);
  s.albedo = vec3(0.375, 0.36, 0.335) * ((0.55 + 0.75 * bright) * covered / (1.0 - s.gloss.x));
  s.clear = passed * (1.0 - covered);
}
#endif

// What mirrors let through to the base from a light, as a multiple of what they let through of even light
// (Kelemen and Szirmay-Kalos 2001); a twenty-first is the mean of Schlick's slope.
float base_share(Surface s, vec3 to_light) {
  float mean = s.gloss.x * (s.gloss.y + max(1.0 - sqrt(s.gloss.z) - s.gloss.y, 0.0) * (1.0 / 21.0));
  return (1.0 - mirrored_share(s, dot(s.normal, to_light))) / (1.0 - mean);
}

// Breaks the line where the plane of a texture changes, by waves of 40 to 7 mm, as in render/shading/find_surface.h.
vec3 zigzag(vec3 x) { return abs(fract(x) - 0.5); }
vec3 ragged(vec3 x, vec3 y) {
  return 0.14 * zigzag(x * 23.0 + y * 11.0) + 0.09 * zigzag(y * 61.0 - x * 29.0) +
         0.03 * zigzag(x * 127.0 + y * 71.0) - 0.065;
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
  f += ragged(q, q.yzx);
  vec3 plane = normalize(round(f * 1.2));
  vec3 along = abs(plane.z) > 0.9 ? vec3(1.0, 0.0, 0.0)
                                  : normalize(vec3(-plane.y, plane.x, 0.0));
  vec3 across = cross(plane, along);
  vec2 uv = vec2(dot(q, along), dot(q, across)) * dark.w + seed * (1.0 / 65536.0);
  // Slow variation over metres.
  vec2 above = (world.xy + 0.6 * world.z - ground.xy) * ground.z;
  vec2 map = texture(ground_map, 0.5 + 0.5 * above / (1.0 + abs(above))).xy;
  float slow = 4.0 * map.y - 2.0;
  // A wall shows another part of its texture every 1.7 m or so, at the boards' joints.
  if (more.x < 0.5) uv.x += 0.37 * floor(uv.y) + 0.21 * floor(uv.y * 0.5);
  vec3 rx = mx.xyz * scale, ry = my.xyz * scale, rz = mz.xyz * scale;  // rotation rows
  s.face_normal = rx * face.x + ry * face.y + rz * face.z;
  float grazing = max(-dot(s.face_normal, direction), 0.05);
  float level = more.w + log2(z * lens.x) - 0.5 * log2(grazing) - 0.25;
  vec4 texel = textureLod(look_textures, vec3(uv, more.x), max(level, 0.0));
  // Where the slow variation is high the ground shows another part of its texture, so that no repetition meets the eye;
  // between them what lies higher of both.
  if (more.y < 0.2 && slow > -0.6) {
    vec4 other = textureLod(look_textures, vec3(uv.yx * 0.83 + 0.37, more.x), max(level, 0.0)).yxzw;
    texel = mix(texel, other, smoothstep(-0.15, 0.15, slow - 0.15 + 0.6 * (other.z - texel.z)));
  }

  // Relief.
#ifdef GLOW
  vec2 slope = (texel.xy * 4.0 - 2.0) * max(bright.w, 0.0);
#else
  vec2 slope = (texel.xy * 4.0 - 2.0) * bright.w;
#endif
  vec3 tu = turn == 1u ? along.zxy : turn == 2u ? along.yzx : along;
  vec3 tv = turn == 1u ? across.zxy : turn == 2u ? across.yzx : across;
  vec3 bent = smooth_normal - tu * slope.x - tv * slope.y;
  s.normal = normalize(rx * bent.x + ry * bent.y + rz * bent.z);
  float up = rx.z * smooth_normal.x + ry.z * smooth_normal.y + rz.z * smooth_normal.z;

  // Colour: texture, piece, dust.
  // On the ground the mask ranks crumbs: the more debris, the more of them lie there, and dust.
  bool soil = more.x == SOIL;
  float crumbs = smoothstep(0.0, 0.12, texel.w - 1.0 + 0.05 + 0.75 * map.x);
  s.albedo = mix(mix(dark.rgb, bright.rgb, texel.z), accent.rgb * (soil ? 0.55 + 0.7 * texel.z : 1.0),
                 soil ? crumbs : texel.w);
  s.albedo *= 1.0 + (soil ? 0.3 : 0.16) * slow;
  float tint = (float((mw.w >> 16) & 255u) * (2.0 / 255.0) - 1.0) * more.z;
  float warm = (float(mw.w >> 24) * (2.0 / 255.0) - 1.0) * more.z * 0.25;
  s.albedo *= (1.0 + tint) * vec3(1.0 + warm, 1.0, 1.0 - warm);
#ifdef GLOW
  s.glow = s.albedo * (max(-bright.w, 0.0) / max(dot(bright.rgb, vec3(0.2126, 0.7152, 0.0722)), 1e-3));
#endif
  // Dust settles on what faces up, unevenly, and lets pits and cracks show.
  float dust = smoothstep(0.30, 1.05, up + (texel.z - 0.45) * 0.8) *
               (soil ? 0.85 * map.x : more.y);
  s.albedo = mix(s.albedo, vec3(0.375, 0.36, 0.335) * (0.55 + 0.75 * texel.z), dust);
  s.gloss = vec3(1.0 - dust, floor(accent.w) * (1.0 / 255.0), max(fract(accent.w) * (1.0 / 0.99), 0.02));
#ifdef PAINTS
  bool painted = look == PAINTED * 4;
  if (painted) {
    float across = z * lens.x * inversesqrt(grazing) * 0.84 / scale;
    Paint paint = find_paint(triangle, vec3(w0, w1, w2), ab, ac, smooth_normal, across);
    s.albedo = paint.albedo * (1.0 - paint.metalness);
    s.gloss = vec3(paint.reflectance > 0.0 ? 1.0 : 0.0, paint.reflectance, paint.roughness);
    s.normal = normalize(rx * paint.normal.x + ry * paint.normal.y + rz * paint.normal.z);
  }
#endif
#ifdef GLASS
  s.clear = vec3(0.0);
  if (look == GLASS * 4) add_glass(s, -dot(s.face_normal, direction), texel.z);
#endif
#ifdef WET
  // Water darkens what it soaks into, and stands as a film on what faces up.
  float wet = wetness.x * smoothstep(-0.6, 0.5, up + 0.5 * slow);
  s.albedo *= 1.0 - 0.5 * wet;
  float raised = texel.z;
#ifdef SURROUNDED
  // Along a street the eye sees a texture repeat: only what is finer than an eighth of it stands out of the water.
  raised += 0.5 - textureLod(look_textures, vec3(uv, more.x), max(level, log2(float(textureSize(look_textures, 0).x)) - 3.0)).z;
#endif
  float even = smoothstep(0.75, 0.25, raised);
  s.film = wet * (0.35 + 0.65 * smoothstep(0.2, 0.9, up)) * even;
  s.gloss.x *= 1.0 - s.film;
  s.normal = normalize(mix(s.normal, rx * smooth_normal.x + ry * smooth_normal.y + rz * smooth_normal.z,
                           0.6 * wet * even));
#endif

  float lit = max(dot(light, s.normal), 0.15 * length(light));
  s.ambient = vec3(red_blue.x, 1.0 - red_blue.x - red_blue.y, red_blue.y) * (3.0 * lit);
  return s;
}
