-- Standard work of the equilibrium bench: girders, deck slabs and steel of the pack bridge.
return rubble.mission {
  seed = 1,
  packs = { "bridge" },
  pile = {
    layers = 4,
    pieces_per_layer = 120,
    spawn_position = { 0, 0, 5 },
    spawn_bounds = { 7, 7, 8 },
  },
}
