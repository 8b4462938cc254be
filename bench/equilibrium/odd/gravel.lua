-- Work of the equilibrium bench: gravel of 3 cm.
return rubble.mission {
  seed = 1,
  packs = { "concrete" },
  pile = {
    layers = 2,
    pieces_per_layer = 150,
    spawn_position = { 0, 0, 5 },
    spawn_bounds = { 0.6, 0.6, 2 },
    mix = {
      { asset = "chunk_1", scale = 0.08 }, { asset = "chunk_2", scale = { 0.06, 0.1 } }, { asset = "chunk_4", scale = 0.12 },
    },
  },
}
