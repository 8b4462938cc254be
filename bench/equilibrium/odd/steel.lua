-- Work of the equilibrium bench: girders, rails and mats of steel.
return rubble.mission {
  seed = 1,
  packs = { "bridge", "parking" },
  pile = {
    layers = 2,
    pieces_per_layer = 40,
    spawn_position = { 0, 0, 5 },
    spawn_bounds = { 6, 6, 9 },
    mix = {
      { asset = "steel_girder" }, { asset = "steel_girder_torn" }, { asset = "guard_rail" }, { asset = "rebar_mat" }, { asset = "bridge_rail" },
    },
  },
}
