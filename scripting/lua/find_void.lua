-- rubble.find_void(options): the places of a void of the settled pile that a sphere of some radius
-- can enter. What it gives stands for points that are known once the pile has settled, in
-- `position` and `look_at` of a waypoint: `entrance`, `approach` (outside, before the entrance),
-- `deepest` (as far as the sphere gets from the entrances), `widest`.
return function(given)
  local o = rubble.options("rubble.find_void", given, {
    { "radius", 0.2, min = 0.02, max = 10, unit = "m", doc = "Of the sphere." },
    { "rank", 1, type = "integer", min = 1, max = 1000000, doc = "1: the first in the order of `by`." },
    { "by", "volume", choices = { "volume", "depth" },
      doc = "Largest first, or the one that it gets deepest into." },
    { "outside_radius", 2, min = 0.2, max = 10, unit = "m",
      doc = "Outside is what a sphere of this radius reaches from the sky, and all other free space is void: as `rubble voids` has it (docs/voids.md)." },
    { "approach", 1, min = 0, max = 100, unit = "m", doc = "How far outside `approach` is." },
  })
  local void = {}
  for _, place in ipairs { "entrance", "approach", "deepest", "widest" } do
    void[place] = { find_void = { radius = o.radius, rank = o.rank, by = o.by, place = place,
                                  distance = o.approach, outside_radius = o.outside_radius } }
  end
  return void
end
