-- rubble.find_void(options): places in a void of the settled pile that a sphere can enter. It returns
-- values for `position` and `look_at` of waypoints, which are known after the pile has settled:
-- `entrance`, `approach` (outside, in front of the entrance), `deepest` (farthest from the entrances
-- along the path of the sphere), `widest`.
return function(given)
  local o = rubble.options("rubble.find_void", given, {
    { "radius", 0.2, min = 0.02, max = 10, unit = "m", doc = "Radius of the sphere." },
    { "rank", 1, type = "integer", min = 1, max = 1000000, doc = "Rank in the order of `by`; 1: the first." },
    { "by", "volume", choices = { "volume", "depth" },
      doc = "Order of the voids: by volume, or by the depth that the sphere reaches; largest first." },
    { "outside_radius", 2, min = 0.2, max = 10, unit = "m",
      doc = "Radius of the sphere that defines the outside: the space that it reaches from the sky. All other free space is void (docs/explanation/voids.md)." },
    { "approach", 1, min = 0, max = 100, unit = "m", doc = "Distance of the place `approach` from the entrance." },
  })
  local void = {}
  for _, place in ipairs { "entrance", "approach", "deepest", "widest" } do
    void[place] = { find_void = { radius = o.radius, rank = o.rank, by = o.by, place = place,
                                  distance = o.approach, outside_radius = o.outside_radius } }
  end
  return void
end
