-- The pile of the published demonstration: 15 layers, 3,750 assets over about 10 m by 10 m. Under it
-- a floor slab leans on a wall, and a row of box culverts leads to the void beneath, so that the
-- camera has a way in.
return function()
  local slab = rubble.collapse.lean_to {
    length = 6, width = 5, height = 2.2, bearing = 0.3, position = { -2.4, 0.5, 0 }, debris = { layers = 0 },
  }
  local way_in = rubble.collapse.culvert {
    kind = "box", bore = 1, segments = 2, rows = 1, position = { -1.4, -3.8, 0 }, yaw_deg = 90,
    debris = { layers = 0 },
  }
  local pile = rubble.join(slab, way_in)
  pile.layers, pile.pieces_per_layer = 15, 250
  pile.spawn_position, pile.spawn_bounds = { 0, 0, 4.5 }, { 10, 10, 7 }
  pile.mix = {
    { asset = "slab_1", weight = 2 }, { asset = "slab_2", weight = 2 }, { asset = "slab_3", weight = 2 },
    { asset = "slab_5", weight = 2 },
    { asset = "chunk_1", weight = 3 }, { asset = "chunk_2", weight = 3 }, { asset = "chunk_3", weight = 3 },
    { asset = "chunk_4", weight = 4 }, { asset = "chunk_5", weight = 3 }, { asset = "chunk_6", weight = 4 },
    { asset = "cinder_block", weight = 3 }, { asset = "half_cinder_block", weight = 2 },
    { asset = "broken_cinder_block", weight = 3 }, { asset = "brick", weight = 5 },
    { asset = "worn_brick", weight = 4 }, { asset = "half_brick", weight = 4 },
    { asset = "beam", weight = 0.5 }, { asset = "column", weight = 0.5 }, { asset = "pipe_shard", weight = 0.5 },
    { asset = "rebar_straight", weight = 0.5 }, { asset = "rebar_bent", weight = 0.5 },
  }
  return pile
end
