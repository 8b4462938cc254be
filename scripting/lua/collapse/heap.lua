-- rubble.collapse.heap: nothing is left standing; pieces drop in layers from a box.
return function(given)
  local o = rubble.options("rubble.collapse.heap", given, {
    { "layers", 4, type = "integer", min = 0, max = 1000, doc = "Dropped one after another." },
    { "pieces_per_layer", 300, type = "integer", min = 0, max = 100000, doc = "Pieces in each layer." },
    { "length", 10, above = 0, max = 1000, unit = "m", doc = "Of the box, along X." },
    { "width", 10, above = 0, max = 1000, unit = "m", doc = "Of the box, along Y." },
    { "height", 7, above = 0, max = 1000, unit = "m", doc = "Of the box." },
    { "position", { 0, 0, 0 }, min = -500, max = 500, unit = "m", doc = "On the ground below it." },
    { "mix", {}, type = "table", doc = "As `pile.mix`; empty: every asset of the packs." },
  })
  return {
    layers = o.layers, pieces_per_layer = o.pieces_per_layer, mix = o.mix,
    spawn_position = { o.position[1], o.position[2], o.position[3] + 1 + o.height / 2 },
    spawn_bounds = { o.length, o.width, o.height },
  }
end
