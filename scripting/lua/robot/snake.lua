-- rubble.robot.snake: a chain of modules, with hinges that bend alternately sideways and up or down.
return function(given)
  return rubble.robot_options("snake", given, {
    { "modules", 16, type = "integer", min = 2, max = 64, doc = "Number of modules, including the head." },
  })
end
