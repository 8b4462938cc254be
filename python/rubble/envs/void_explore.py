"""rubble/VoidExplore-v0: a flying ball with a depth camera explores a void of a settled pile.

Action: Box(-1, 1, (4,)): forwards, left, up (at most `speed`) and turning to the left (at most `turn_rate`),
for `period` seconds. The body stops where it would come nearer to a surface than its radius.

Observation: dict of
  depth      (size, size) float32, m along the optical axis, max_range where nothing is nearer;
  pose       (4,) float32: forwards, left and up since the start (m, in the frame of the start), yaw (rad);
  clearance  (1,) float32: how far the body's centre is from everything solid, m.

Reward of a step: 100 times the share of the void's cells that the camera sees for the first time, less 0.01,
less 0.1 where the body was stopped. A cell is seen when it lies before the surface that a ray of the depth
picture meets, within max_range. The episode ends (terminated) when `enough` of the void has been seen, and is
cut off (truncated) after max_steps.

The pile of an episode is drawn from pile_seeds by the episode's own seed, which alone decides the episode:
not those before it, nor the process, nor the threads. Piles are settled once and kept in memory.
"""
import numpy as np

from .. import _core, geometry
from ..sensors import DepthCamera
from .settled import settle_text
from .spaces import Box, Dict, Env

MISSION = """
return rubble.mission {
  pile = { layers = 2, pieces_per_layer = 60, spawn_position = { 0, 0, 3 }, spawn_bounds = { 5, 5, 4 } },
}
"""


class _World:
    """A pile with the void that is explored, the way in and the cells to be seen."""

    def __init__(self, mission, seed, radius, voxel, threads):
        self.pile = settle_text(mission, seed, threads)
        voids = [v for v in self.pile.voids(radius, voxel) if v["entrances"]]
        self.void = voids[0] if voids else None
        if not self.void:
            return
        entrance = self.void["entrances"][0]
        inward = entrance["inward"]
        self.start = geometry.pose(entrance["position"], (0, 0, np.arctan2(inward[1], inward[0])))
        centres = self.void["cells"]
        self.corner = centres.min(axis=0) - 0.5 * voxel
        cells = np.floor((centres - self.corner) / voxel).astype(np.int64)
        self.size = cells.max(axis=0) + 1
        self.mask = np.zeros(self.size, bool)
        self.mask[tuple(cells.T)] = True
        self.count = int(self.mask.sum())


class VoidExplore(Env):
    metadata = {"render_modes": []}

    def __init__(self, mission=MISSION, pile_seeds=range(1, 6), radius=0.15, size=64, fov_deg=90.0, max_range=5.0,
                 speed=0.5, turn_rate=1.0, period=0.2, max_steps=500, enough=0.95, voxel=0.1, threads=1,
                 render_mode=None):
        self.render_mode = render_mode
        self._mission, self._seeds = mission, [int(s) for s in pile_seeds]
        self._radius, self._size, self._max_range, self._voxel = radius, size, max_range, voxel
        self._fov_deg, self._speed, self._turn_rate, self._period = fov_deg, speed, turn_rate, period
        self._max_steps, self._enough, self._threads = max_steps, enough, threads
        self._worlds = {}
        self._world = self._camera = None
        self.action_space = Box(-1.0, 1.0, (4,), np.float32)
        self.observation_space = Dict({
            "clearance": Box(0.0, max_range, (1,), np.float32),
            "depth": Box(0.0, max_range, (size, size), np.float32),
            "pose": Box(-1000.0, 1000.0, (4,), np.float32)})

    def _find_world(self, seed):
        """The pile of that seed with its camera, settled when it is first asked for."""
        if seed not in self._worlds:
            world = _World(self._mission, seed, self._radius, self._voxel, self._threads)
            world.camera = world.void and DepthCamera(world.pile, self._size, self._size, self._fov_deg,
                                                      self._max_range * 2, self._threads)
            self._worlds[seed] = world
        return self._worlds[seed]

    def _choose_world(self):
        for seed in self.np_random.permutation(self._seeds):
            world = self._find_world(int(seed))
            if world.void:
                return world, int(seed)
        error = _core.InputError(f"radius: no pile of pile_seeds has a void that a ball of {self._radius} m can "
                                 "enter: expected a smaller radius, a smaller voxel or other seeds")
        error.key = "radius"
        raise error

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self._world, pile_seed = self._choose_world()
        self._start = self._world.start
        self._position, self._yaw = self._start[:3].copy(), 0.0
        self._seen = np.zeros_like(self._world.mask)
        self._steps = self._stopped = 0
        observation = self._observe()
        return observation, self._describe(pile_seed=pile_seed)

    def step(self, action):
        if self._world is None:
            raise RuntimeError("reset() comes before step()")
        action = np.asarray(action, float)
        if action.shape != (4,) or not np.all(np.isfinite(action)):
            error = _core.InputError(f"action: expected 4 finite numbers: found {action!r}")
            error.key = "action"
            raise error
        action = np.clip(action, -1, 1)
        stopped = not self._move(action)
        self._steps += 1
        self._stopped += stopped
        before = int(self._seen.sum())
        observation = self._observe()
        share = (int(self._seen.sum()) - before) / self._world.count
        reward = 100.0 * share - 0.01 - 0.1 * stopped
        terminated = bool(self._seen.sum() >= self._enough * self._world.count)
        truncated = self._steps >= self._max_steps
        return observation, float(reward), terminated, truncated, self._describe()

    def _body(self):
        turned = geometry.pose((0, 0, 0), (0, 0, self._yaw))
        pose = geometry.compose(self._start, turned)
        pose[:3] = self._position
        return pose

    def _move(self, action):
        """False: a surface is in the way. Looked for every quarter of the radius."""
        self._yaw += float(action[3]) * self._turn_rate * self._period
        way = geometry.matrix(self._body())[:3, :3] @ (action[:3] * (self._speed * self._period))
        length = float(np.linalg.norm(way))
        if length == 0:
            return True
        parts = max(1, int(np.ceil(length / (0.25 * self._radius))))
        places = self._position + np.outer(np.arange(1, parts + 1) / parts, way)
        free = self._world.pile.clearance(places, self._max_range) >= self._radius
        allowed = parts if free.all() else int(np.argmin(free))
        if allowed:
            self._position = places[allowed - 1]
        return allowed == parts

    def _observe(self):
        pose = self._body()
        depth = self._world.camera.depth(pose)
        self._look(pose, depth)
        start = geometry.matrix(self._start)
        moved = start[:3, :3].T @ (self._position - start[:3, 3])
        clearance = self._world.pile.clearance(self._position[None], self._max_range)
        return {"clearance": clearance.astype(np.float32),
                "depth": np.minimum(depth, np.float32(self._max_range)),
                "pose": np.append(moved, self._yaw).astype(np.float32)}

    def _look(self, pose, depth):
        """Marks the cells before the surfaces of every fourth ray each way."""
        world, k = self._world, self._world.camera.K
        v, u = np.mgrid[2:self._size:4, 2:self._size:4]
        right, down = ((u - k[0, 2]) / k[0, 0]).ravel(), ((v - k[1, 2]) / k[1, 1]).ravel()
        slopes = np.stack([np.ones_like(right), -right, -down], axis=1)  # in the body, per metre of depth
        step = 0.5 * self._voxel  # from place to place along a ray; m
        along = np.arange(0.5, self._max_range / step) * step
        near = along[None, :] < np.minimum(depth[v, u].ravel(), self._max_range)[:, None]
        m = geometry.matrix(pose)
        points = m[:3, 3] + (slopes[:, None, :] * along[None, :, None])[near] @ m[:3, :3].T
        cells = np.floor((points - world.corner) / self._voxel).astype(np.int64)
        cells = cells[np.all((cells >= 0) & (cells < world.size), axis=1)]
        self._seen[tuple(cells.T)] = True
        self._seen &= world.mask

    def _describe(self, **more):
        return {"coverage": float(self._seen.sum() / self._world.count), "stops": self._stopped, **more}
