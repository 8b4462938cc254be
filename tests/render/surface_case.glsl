// What surface_model_test.cpp asks of every compilation of the surface model: each of its functions, from 36 numbers
// between 0 and 1.
struct SurfaceCase {
  Real3 a, b, c, d, e, f, g, h, i, j, k, l;
};
struct SurfaceAnswer {
  Real3 albedo, normal, clear, glow, lobes, shares, tone;
};

FN SurfaceAnswer answer(SurfaceCase t) {
  Real3 centre = real3(real(0.5f), real(0.5f), real(0.5f));
  Real3 normal = normalize(t.a - centre), to_light = normalize(t.b - centre), to_eye = normalize(t.c - centre);
  TextureAxes axes = find_texture_axes(t.d * real(3.0f), normal);
  LookColours look;
  look.dark = t.e, look.bright = t.f, look.accent = t.g;
  look.dust = t.h.x, look.variation = t.h.y, look.reflectance = t.h.z, look.roughness = max(t.i.x, 0.02f), look.glow = t.i.y;
  SurfaceDetail p;
  p.bright = t.i.z, p.mask = t.j.x, p.raised = t.j.y, p.slow = t.j.z * 4.0f - 2.0f, p.debris = t.k.x;
  p.up = t.k.y * 2.0f - 1.0f, p.soil = t.k.z < 0.3f;
  SurfaceLayers s = find_layers(look, p, t.l.x * 2.0f - 1.0f, t.l.y * 2.0f - 1.0f);
  // Glass, paint and neither, a third of the cases each; half of all are wet.
  Mask glass = t.l.z < 0.33f, painted = both(t.l.z >= 0.33f, t.l.z < 0.66f);
  SurfaceLayers pane = make_glass(s, dot(normal, to_eye), p.bright);
  PaintAxes paint = find_paint_axes(t.a - t.b, t.c - t.b, t.d.x, t.d.y, t.e.x, t.e.y);
  SurfaceLayers coat = paint_over(s, decode_srgb3(t.g), t.h.x, t.h.y, t.h.z);
  SurfaceAnswer out_;
  s.albedo = select(glass, pane.albedo, select(painted, coat.albedo, s.albedo));
  s.cover = select(glass, pane.cover, select(painted, coat.cover, s.cover));
  s.reflectance = select(glass, pane.reflectance, select(painted, coat.reflectance, s.reflectance));
  s.roughness = select(glass, pane.roughness, select(painted, coat.roughness, s.roughness));
  s.clear = select(glass, pane.clear, s.clear);
  WetSurface wet = add_water(s, p, 0.7f);
  Mask rains = t.d.z < 0.5f;
  Real3 bent = bend_paint(paint, normal, t.f.x, t.f.y);
  s.albedo = select(rains, wet.layers.albedo, s.albedo);
  s.cover = select(rains, wet.layers.cover, s.cover);
  s.film = select(rains, wet.layers.film, s.film);
  MirrorAngles angles = find_mirror_angles(normal, to_light, to_eye);
  Real mirrored = gloss_share(s, angles.seen) + film_share(s, angles.seen);
  out_.albedo = s.albedo, out_.clear = s.clear, out_.glow = s.glow;
  out_.normal = normalize(mix(bent, axes.along, wet.even));
  out_.lobes = real3(gloss_lobe(s, angles) * angles.lit, film_lobe(s, angles) * angles.lit, base_share(s, mirrored));
  out_.shares = real3(mirrored, other_part(p.slow, p.bright, p.raised),
                      map_place(t.d.x * 20.0f - 10.0f, t.d.y, 0.5f, 0.2f) + wall_shift(t.e.x) + 0.01f * paint_level(paint, 512.0f, t.e.y));
  out_.tone = real3(develop(t.f.x * 4.0f, t.f.y), develop(t.f.z * 0.1f, grain(floor(t.g.x * 64.0f), floor(t.g.y * 64.0f))), real(0.0f));
  return out_;
}
