-- rubble.collapse.heap: a heap without standing parts: pieces drop in layers from a box.
return function(given)
  local o = rubble.options("rubble.collapse.heap", given, {
    { "layers", 4, type = "integer", min = 0, max = 1000, doc = "Number of layers, dropped one after another." },
    { "pieces_per_layer", 300, type = "integer", min = 0, max = 100000, doc = "Number of pieces in each layer." },
    { "length", 10, above = 0, max = 1000, unit = "m", doc = "Length of the box in which pieces start, along X." },
    { "width", 10, above = 0, max = 1000, unit = "m", doc = "Width of the box, along Y." },
    { "height", 7, above = 0, max = 1000, unit = "m", doc = "Height of the box." },
    { "position", { 0, 0, 0 }, min = -500, max = 500, unit = "m", doc = "Point on the ground below the box." },
    { "mix", {}, type = "table", doc = "As `pile.mix`; empty: every asset of the packs." },
  })
  return {
    layers = o.layers, pieces_per_layer = o.pieces_per_layer, mix = o.mix,
    spawn_position = { o.position[1], o.position[2], o.position[3] + 1 + o.height / 2 },
    spawn_bounds = { o.length, o.width, o.height },
  }
end
