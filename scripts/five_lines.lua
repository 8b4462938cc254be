-- The shortest mission: every other key has its default.
return rubble.mission {
  seed = 5,
  pile = { layers = 1, pieces_per_layer = 60 },
}
