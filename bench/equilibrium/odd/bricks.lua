-- Work of the equilibrium bench: nothing but bricks of one kind.
return rubble.mission {
  seed = 1,
  packs = { "concrete" },
  pile = {
    layers = 2,
    pieces_per_layer = 150,
    spawn_position = { 0, 0, 5 },
    spawn_bounds = { 2, 2, 6 },
    mix = {
      { asset = "brick", scale = 1 },
    },
  },
}
