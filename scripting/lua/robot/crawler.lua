-- rubble.robot.crawler: two tracks with moving contact surfaces, and four flippers.
return function(given)
  return rubble.robot_options("crawler", given, {
    { "flippers", true, doc = "Has flippers." },
  })
end
