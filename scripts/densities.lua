-- Where pieces fall: try rubble.density.gaussian {}, rubble.density.line {}, an image by
-- rubble.density.image("map.png"), or a function of x and y as here: a heap with a notch.
return rubble.mission {
  seed = 2,
  pile = {
    layers = 3, pieces_per_layer = 50,
    spawn_position = { 0, 0, 3 }, spawn_bounds = { 6, 6, 4 },
    spawn_density = rubble.density.from(function(x, y)
      if x < 0 and math.abs(y) < 0.25 then return 0 end
      return math.exp(-3 * (x * x + y * y))
    end),
  },
  camera = { width = 320, height = 240 },
  trajectory = { waypoints = { { position = { -6, 0, 4 }, look_at = { 0, 0, 0 } } } },
}
