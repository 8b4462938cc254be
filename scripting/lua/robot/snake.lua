-- rubble.robot.snake: modules whose hinges turn sideways and up and down in turn.
return function(given)
  return rubble.robot_options("snake", given, {
    { "modules", 16, type = "integer", min = 2, max = 64, doc = "How many, the head included." },
  })
end
