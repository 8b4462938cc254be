-- Work of the equilibrium bench: nothing but reinforcement bars.
return rubble.mission {
  seed = 1,
  packs = { "concrete" },
  pile = {
    layers = 2,
    pieces_per_layer = 80,
    spawn_position = { 0, 0, 5 },
    spawn_bounds = { 3, 3, 8 },
    mix = {
      { asset = "rebar_straight", weight = 3 }, { asset = "rebar_bent" }, { asset = "rebar_hook" },
    },
  },
}
