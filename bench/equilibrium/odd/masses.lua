-- Work of the equilibrium bench: lumps whose masses differ by a factor of 10,000.
return rubble.mission {
  seed = 1,
  packs = { "concrete" },
  pile = {
    layers = 2,
    pieces_per_layer = 80,
    spawn_position = { 0, 0, 5 },
    spawn_bounds = { 5, 5, 10 },
    mix = {
      { asset = "chunk_1", scale = { 0.08, 1.75 } }, { asset = "chunk_4", scale = { 0.1, 1 } },
    },
  },
}
