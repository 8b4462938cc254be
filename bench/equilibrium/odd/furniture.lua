-- Work of the equilibrium bench: furniture and cars.
return rubble.mission {
  seed = 1,
  packs = { "residential", "parking" },
  pile = {
    layers = 2,
    pieces_per_layer = 25,
    spawn_position = { 0, 0, 5 },
    spawn_bounds = { 7, 7, 9 },
    mix = {
      { asset = "sofa" }, { asset = "mattress" }, { asset = "refrigerator" }, { asset = "table" }, { asset = "car_roof", weight = 0.3 },
      { asset = "car_bonnet" },
    },
  },
}
