-- Standard work of the equilibrium bench: sticks, sheets and window frames of the pack residential.
return rubble.mission {
  seed = 1,
  packs = { "residential" },
  pile = {
    layers = 4,
    pieces_per_layer = 120,
    spawn_position = { 0, 0, 5 },
    spawn_bounds = { 7, 7, 8 },
  },
}
