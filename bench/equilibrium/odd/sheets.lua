-- Work of the equilibrium bench: nothing but thin sheets.
return rubble.mission {
  seed = 1,
  packs = { "residential" },
  pile = {
    layers = 3,
    pieces_per_layer = 50,
    spawn_position = { 0, 0, 5 },
    spawn_bounds = { 4, 4, 8 },
    mix = {
      { asset = "plywood_sheet", scale = 1 }, { asset = "drywall_sheet", scale = 1 },
    },
  },
}
