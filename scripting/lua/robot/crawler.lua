-- rubble.robot.crawler: two tracks whose contact surface moves, and four flippers.
return function(given)
  return rubble.robot_options("crawler", given, {
    { "flippers", true, doc = "Whether it has them." },
  })
end
