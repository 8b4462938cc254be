-- A slab that leans on a wall, placed before the debris falls: `fixed` pieces never move.
return rubble.mission {
  seed = 4,
  pile = {
    layers = 1, pieces_per_layer = 40, spawn_position = { 0, 0, 4 }, spawn_bounds = { 4, 4, 3 },
    mix = { { asset = "brick", weight = 2 }, { asset = "chunk_4", scale = { 0.8, 1.2 } } },
    placed = {
      { asset = "wall_stub", position = { 0, 0, 0.72 } },
      { asset = "floor_slab", position = { 0, 1.35, 0.95 }, rpy_deg = { -28, 0, 0 }, fixed = false },
    },
  },
  camera = { width = 320, height = 240 },
  trajectory = { waypoints = { { position = { -5, 3, 2 }, look_at = { 0, 0.7, 0.6 } } } },
}
