-- Work of the equilibrium bench: flat slabs on each other.
return rubble.mission {
  seed = 1,
  packs = { "concrete" },
  pile = {
    layers = 3,
    pieces_per_layer = 30,
    spawn_position = { 0, 0, 5 },
    spawn_bounds = { 4, 4, 8 },
    mix = {
      { asset = "slab_4", scale = 1 }, { asset = "facade_panel" }, { asset = "slab_1" },
    },
  },
}
