-- rubble.robot.vine: an inflated tube that grows from its tip by turning inside out.
return function(given)
  return rubble.robot_options("vine", given, {
    { "pressure", 10e3, min = 1, max = 1e6, unit = "Pa", doc = "As `robots[].pressure`." },
    { "radius", 0.05, min = 0.01, max = 0.3, unit = "m", doc = "As `robots[].radius`." },
    { "length", 3, min = 0.001, max = 100, unit = "m", doc = "As `robots[].length`." },
    { "link_length", 0.05, min = 0.02, max = 0.5, unit = "m", doc = "As `robots[].link_length`." },
  })
end
