#include "scripting/reference/schema_docs.h"

namespace rubble {

const char* const kLuaBaseAnnotations = R"lua(
---A vector with `+`, `-`, and `*` by a number.
---@class rubble.Vec
---@field x number
---@field y number
---@field z number
---@operator add(rubble.Vec): rubble.Vec
---@operator sub(rubble.Vec): rubble.Vec
---@operator mul(number): rubble.Vec
---@operator unm: rubble.Vec
local Vec = {}
---@param other rubble.Vector
---@return number
function Vec:dot(other) end
---@param other rubble.Vector
---@return rubble.Vec
function Vec:cross(other) end
---@return number
function Vec:norm() end

---{x, y, z}, or {x = 1, y = 2, z = 3}
---@alias rubble.Vector number[]|rubble.Vec|{x: number, y: number, z: number}
---A number, or {min, max}
---@alias rubble.Range number|number[]

---A stream of random numbers, which follows from the seed and its name alone.
---@class rubble.Random
local Random = {}
---@param low? number of the range; default 0
---@param high? number default 1
---@return number
function Random:uniform(low, high) end
---@param low integer included
---@param high integer included
---@return integer
function Random:integer(low, high) end
---@param mean? number default 0
---@param deviation? number default 1
---@return number
function Random:normal(mean, deviation) end
---@generic T
---@param list T[]
---@return T
function Random:choice(list) end
---@return rubble.Vec # of length 1
function Random:direction() end

---@class rubble
rubble = {}

---Says that the table is the mission; returns it.
---@param mission rubble.Mission
---@return rubble.Mission
function rubble.mission(mission) end
---The random stream of that name.
---@param name string
---@return rubble.Random
function rubble.random(name) end
---A vector of three numbers; without any: zero.
---@overload fun(): rubble.Vec
---@param x number
---@param y number
---@param z number
---@return rubble.Vec
function rubble.vec(x, y, z) end
---The vector turned by roll, pitch and yaw. unit: degree
---@param rpy_deg rubble.Vector
---@param v rubble.Vector
---@return rubble.Vec
function rubble.rotate(rpy_deg, v) end
---Runs another file of the script's folder and returns its value.
---@param file string
---@return any
function rubble.include(file) end
---The numbers and words of a text file of the script's folder.
---@param file string
---@return {rows: (number|string)[][], names: string[]?, lines: integer[]}
function rubble.read_table(file) end
---A picture or an elevation model of the script's folder, row by row from the top: grey levels from 0 to 1, or
---where `metric`, heights in m. `block`: points of the file, a side, over which each value is averaged; `cut_columns` and
---`cut_rows`: those at its edges that fill no whole block and are left out.
---@param file string
---@param side? integer points a side, at most; 256
---@return {columns: integer, rows: integer, values: number[], metric: boolean, levels: number?, block: integer, cut_columns: integer, cut_rows: integer, spacing: number?, east: number?, north: number?, degrees: boolean, colour: boolean}
function rubble.read_image(file, side) end
---A recorded trajectory of the script's folder; bodies have X forward and Z up.
---@param file string
---@param options? {frame: string?, columns: string?}
---@return {format: string, stamped: boolean, poses: rubble.mission.trajectory.waypoints[], notes: string[]}
function rubble.read_trajectory(file, options) end
---An accelerogram of the script's folder. unit: m/s2, s
---@param file string
---@param options? {step: number?, unit: string?}
---@return {values: number[], step: number, peak: number, format: string, notes: string[]}
function rubble.read_accelerogram(file, options) end
---A calibration of cameras or a LiDAR from the script's folder, as keys of a mission.
---@param file string
---@return {format: string, notes: string[], camera: table?, cameras: table?, lidar: table?}
function rubble.read_calibration(file) end
---A parameter of the script: `--set NAME=VALUE` and `--vary NAME=...` give it another value.
---@param name string letters, digits and _; not that of a key of the mission
---@param default any its type follows from it, as of `rubble.options`
---@param more table? `{ min =, above =, max =, unit =, type =, choices =, doc = }`
---@return any
function rubble.parameter(name, default, more) end
---Every parameter of a function with its value, checked.
---@param name string of the function, for messages
---@param given table?
---@param list table[] `{ "name", default, min =, above =, max =, unit =, type =, choices =, doc = }`
---@return table
function rubble.options(name, given, list) end
---Says that a parameter is wrong, where only the function can see it.
---@param name string of the function
---@param parameter string
---@param expected string
---@param found any
function rubble.reject(name, parameter, expected, found) end
---The parameters of a collapse mode, and those that every mode has.
---@param list table[] as of `rubble.options`
---@return table[]
function rubble.structure_options(list) end
---A pile from what is placed and the debris that `rubble.structure_options` describes.
---@param options table
---@param placed rubble.mission.pile.placed[]
---@return rubble.mission.pile
function rubble.assemble(options, placed) end
---One pile from several: all that is placed, at most one building and one terrain, and what falls.
---@param ... rubble.mission.pile
---@return rubble.mission.pile
function rubble.join(...) end
---A pile that is a building and what becomes of it.
---@param building rubble.mission.pile.building
---@return rubble.mission.pile
function rubble.building(building) end
---The plan of a building from a text file of the script's folder.
---@param file string
---@return rubble.mission.pile.building.plan
function rubble.read_plan(file) end
---The parameters of a path, and those that every path has.
---@param list table[] as of `rubble.options`
---@return table[]
function rubble.trajectory_options(list) end
---A trajectory from waypoints and the options that `rubble.trajectory_options` describes.
---@param options table
---@param waypoints table[]
---@param interpolation? string
---@return rubble.mission.trajectory
function rubble.fly(options, waypoints, interpolation) end
---Keeps a function that drives a robot, for `control` (docs/reference/robots.md).
---@param f fun(sense: table): table
---@return integer
function rubble.controller(f) end
---An entry of `robots` from a model's own parameters and those that every robot has.
---@param model string
---@param given table
---@param list table[] as of `rubble.options`
---@return table
function rubble.robot_options(model, given, list) end

rubble.collapse = {}
rubble.density = {}
rubble.terrain = {}
rubble.trajectory = {}
rubble.robot = {}

---A density from a picture of the script's folder: white where most falls, its upper edge at +Y.
---@param file string
---@return table # a `pile.spawn_density`
function rubble.density.image(file) end
---A terrain from a picture or an elevation model of the script's folder: black is 0, white is `amplitude`.
---@param file string
---@param options table
---@return table # a `pile.terrain`
function rubble.terrain.image(file, options) end

---Of pack.lua: says that the table is the pack; returns it.
---@param pack_table rubble.Pack
---@return rubble.Pack
function pack(pack_table) end
---Of a suite: says that the table is the suite; returns it.
---@param suite_table {runs: table[]}
---@return table
function suite(suite_table) end
)lua";

}  // namespace rubble
