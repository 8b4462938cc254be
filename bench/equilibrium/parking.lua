-- Standard work of the equilibrium bench: crushed cars, double tees and guard rails of the pack
-- parking. They are large: 60 of them fit into the box.
return rubble.mission {
  seed = 1,
  packs = { "parking" },
  pile = {
    layers = 4,
    pieces_per_layer = 60,
    spawn_position = { 0, 0, 5 },
    spawn_bounds = { 7, 7, 8 },
  },
}
