"""Episodes of an environment as a LeRobot dataset, version 3.0."""
import json
import os

import numpy as np

from .. import _core
from ..arguments import checked_seed, mistake
from .spaces import Env


def _is_picture(space):
    return len(space.shape) == 3 and space.dtype == np.uint8 and space.shape[2] in (1, 3)


def _names(key, space):
    """Of the values of a space, as words without gaps."""
    parts = [name for name, _ in getattr(space, "parts", ())] or map(str, range(int(np.prod(space.shape))))
    return [f"{key}.{part}".replace(" ", "_") for part in parts]


def _plain(value):
    return value.tolist() if isinstance(value, (np.ndarray, np.generic)) else str(value)


class LerobotRecorder(Env):
    """An environment whose episodes become the LeRobot dataset `path`, complete with close().

        with rubble.envs.LerobotRecorder(VoidExplore(), "episodes") as env:
            observation, info = env.reset(seed=3)
            ...

    A row has what was seen, the action that followed and its reward: `observation.images.NAME` of each picture,
    `observation.state` of all other values in the order of the space, `action`, `next.reward`, `next.done`. What the last action
    of an episode led to is not recorded. The column `info` of the table of episodes has, as JSON, the seed, what reset() told
    (`randomization` as well), what the last step told, the return and how the episode ended.
    """

    def __init__(self, env, path, task=None):
        """task: a sentence; None: that of the environment."""
        self.env, self.render_mode, self.metadata, self.spec = env, env.render_mode, env.metadata, env.spec
        self.action_space, self.observation_space = env.action_space, env.observation_space
        own, spaces = env.unwrapped, dict(env.observation_space.spaces)
        self._videos = [name for name, space in spaces.items() if _is_picture(space)]
        self._values = [name for name in spaces if name not in self._videos]
        for name in self._values:
            if len(spaces[name].shape) != 1:
                raise mistake("env", f"expected observations that are lists or pictures of uint8: found {name} of shape "
                                     f"{spaces[name].shape}; make the environment without metres")
        features = [("observation.state", "values", [part for name in self._values for part in _names(name, spaces[name])]),
                    ("action", "values", _names("action", env.action_space)),
                    ("next.reward", "number", []), ("next.done", "flag", [])]
        self._rate = float(own.metadata["render_fps"])
        path = os.path.abspath(path)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        self._dataset = _core._LerobotDataset(path, ["observation.images." + name for name in self._videos], features,
                                              type(own).__name__, task or getattr(own, "task", type(own).__name__), self._rate)
        self._steps, self._running = 0, False

    @property
    def unwrapped(self):
        return self.env.unwrapped

    def reset(self, *, seed=None, options=None):
        self._expect_open()
        seed = checked_seed(seed)
        self._end(False, False)
        self._last, self._info = self.env.reset(seed=seed, options=options)
        self._begin = {"seed": seed, "reset": self._info}
        self._return, self._running = 0.0, True
        return self._last, self._info

    def step(self, action):
        self._expect_open()
        if not self._running:
            raise RuntimeError("reset() comes before the first step() of each episode")
        observation, reward, terminated, truncated, info = self.env.step(action)
        since = round(self._steps * 1e9 / self._rate)
        for number, name in enumerate(self._videos):
            self._dataset.add_picture(number, since, np.ascontiguousarray(self._last[name]))
        state = np.concatenate([self._last[name] for name in self._values])
        self._dataset.add_row(since, [state.tolist(), np.asarray(action, np.float32).ravel().tolist(), [float(reward)],
                                      [float(terminated or truncated)]])
        self._steps += 1
        self._return += float(reward)
        self._last, self._info = observation, info
        if terminated or truncated:
            self._end(terminated, truncated)
        return observation, reward, terminated, truncated, info

    def _expect_open(self):
        if self._dataset is None:
            raise RuntimeError("the dataset is complete: nothing is recorded after close()")

    def _end(self, terminated, truncated):
        if self._steps:
            about = {**self._begin, "last": self._info, "return": self._return, "terminated": bool(terminated), "truncated": bool(truncated)}
            self._dataset.end_episode(json.dumps(about, sort_keys=True, default=_plain))
        self._steps, self._running = 0, False

    def render(self):
        return self.env.render()

    def close(self):
        """Ends the running episode and completes the dataset; RunError where there is no episode."""
        if self._dataset is not None:
            dataset = self._dataset
            self._end(False, False)
            self._dataset = None
            self.env.close()
            dataset.finish()

    def __enter__(self):
        return self

    def __exit__(self, kind, *_):
        try:
            self.close()
        except _core.RunError:
            if kind is None:  # else the first mistake is the one to hear of
                raise
