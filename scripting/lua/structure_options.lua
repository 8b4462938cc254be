-- rubble.structure_options(list): a function's own parameters, and those that every collapse mode
-- has: where the structure stands and what debris covers it.
return function(list)
  local common = {
    { "position", { 0, 0, 0 }, min = -500, max = 500, unit = "m",
      doc = "Position of the origin of the structure in the world." },
    { "yaw_deg", 0, min = -360, max = 360, unit = "degree", doc = "Rotation about this point." },
    { "debris.layers", 2, type = "integer", min = 0, max = 1000,
      doc = "Number of layers of debris, dropped after the structure has settled; 0: none." },
    { "debris.pieces_per_layer", 100, type = "integer", min = 0, max = 100000,
      doc = "Number of pieces in each layer." },
    { "debris.margin", 0.3, min = -10, max = 50, unit = "m",
      doc = "Distance that the debris extends beyond the structure." },
    { "debris.mix", {}, type = "table",
      doc = "As `pile.mix`; empty: chunks, blocks and bricks of the pack `concrete`." },
  }
  local all = {}
  for i, entry in ipairs(list) do all[i] = entry end
  for _, entry in ipairs(common) do all[#all + 1] = entry end
  return all
end
