-- Work of the equilibrium bench: pieces of many parts that hook into each other.
return rubble.mission {
  seed = 1,
  packs = { "concrete", "residential", "bridge" },
  pile = {
    layers = 2,
    pieces_per_layer = 50,
    spawn_position = { 0, 0, 5 },
    spawn_bounds = { 5, 5, 9 },
    mix = {
      { asset = "chair" }, { asset = "rebar_tangle" }, { asset = "pipe_shard" }, { asset = "chunk_bars_2" },
      { asset = "door_frame" }, { asset = "box_culvert", scale = 0.4 }, { asset = "hollow_core" },
    },
  },
}
