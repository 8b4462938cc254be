-- Standard work of the equilibrium bench: the pack concrete, every piece by its own weight.
return rubble.mission {
  seed = 1,
  packs = { "concrete" },
  pile = {
    layers = 4,
    pieces_per_layer = 120,
    spawn_position = { 0, 0, 5 },
    spawn_bounds = { 7, 7, 8 },
  },
}
