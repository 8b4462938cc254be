-- rubble.robot.rover: four driven wheels, steered by skidding.
return function(given) return rubble.robot_options("rover", given, {}) end
