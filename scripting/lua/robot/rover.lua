-- rubble.robot.rover: four driven wheels, with skid steering.
return function(given) return rubble.robot_options("rover", given, {}) end
