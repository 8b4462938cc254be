"""Env, VectorEnv, ParallelEnv, Box and Dict: those of gymnasium and pettingzoo where these are installed, else as much of
them as an environment needs. Boxes also know units and names, which they print."""
from typing import Any

import numpy as np

from ..arguments import checked_seed

try:
    from gymnasium import Env
    from gymnasium.spaces import Box as _Box
    from gymnasium.spaces import Dict
    from gymnasium.utils import seeding
    from gymnasium.vector import AutoresetMode, VectorEnv
    from gymnasium.vector.utils import batch_space

    def make_random(seed):
        return seeding.np_random(seed)
except ImportError:

    def make_random(seed):
        sequence = np.random.SeedSequence(checked_seed(seed))
        return np.random.Generator(np.random.PCG64(sequence)), sequence.entropy

    class Env:  # type: ignore[no-redef,unused-ignore]
        metadata: dict[str, Any] = {"render_modes": []}
        render_mode = None
        spec = None

        def reset(self, *, seed=None, options=None):
            if seed is not None or not hasattr(self, "_random"):
                self._random, self._seed = make_random(seed)

        @property
        def np_random(self):
            if not hasattr(self, "_random"):
                self._random, self._seed = make_random(None)
            return self._random

        @property
        def unwrapped(self):
            return self

        def render(self):
            raise NotImplementedError

        def close(self):
            pass

        def __enter__(self):
            return self

        def __exit__(self, *_):
            self.close()

    class AutoresetMode:  # type: ignore[no-redef,unused-ignore]
        NEXT_STEP = "NextStep"

    class VectorEnv:  # type: ignore[no-redef,unused-ignore]
        closed = False

        def close(self, **more):
            if not self.closed:
                self.close_extras(**more)
                self.closed = True

        @property
        def unwrapped(self):
            return self

    def batch_space(space, count):  # type: ignore[misc,unused-ignore]
        if isinstance(space, Dict):
            return Dict({name: batch_space(one, count) for name, one in space.spaces.items()})
        return Box(space.low, space.high, (count, *space.shape), space.dtype)

    class _Box:  # type: ignore[no-redef,unused-ignore]
        """An array within limits."""

        def __init__(self, low, high, shape, dtype=np.float32):
            self.low = np.broadcast_to(np.asarray(low, dtype), shape).copy()
            self.high = np.broadcast_to(np.asarray(high, dtype), shape).copy()
            self.shape, self.dtype = tuple(shape), np.dtype(dtype)
            self.seed(None)

        def seed(self, seed=None):
            self._random, _ = make_random(seed)

        def sample(self):
            return self._random.uniform(self.low, self.high).astype(self.dtype)

        def contains(self, value):
            value = np.asarray(value)
            return (value.shape == self.shape and np.can_cast(value.dtype, self.dtype)
                    and bool(np.all(value >= self.low) and np.all(value <= self.high)))

    class Dict:  # type: ignore[no-redef,unused-ignore]
        """Spaces by name."""

        def __init__(self, spaces):
            self.spaces = dict(sorted(spaces.items()))

        def __getitem__(self, name):
            return self.spaces[name]

        def __repr__(self):
            return f"Dict({', '.join(f'{name!r}: {space!r}' for name, space in self.spaces.items())})"

        def contains(self, value):
            return value.keys() == self.spaces.keys() and all(s.contains(value[k]) for k, s in self.spaces.items())

try:
    from pettingzoo import ParallelEnv  # type: ignore[import-not-found,unused-ignore]
except ImportError:

    class ParallelEnv:  # type: ignore[no-redef,unused-ignore]
        @property
        def num_agents(self):
            return len(self.agents)

        @property
        def max_num_agents(self):
            return len(self.possible_agents)

        @property
        def unwrapped(self):
            return self


class Box(_Box):
    """parts: the name and the unit of each element, for a space with names; unit: of all elements, for one without."""

    def __init__(self, low, high, shape, dtype=np.float32, unit="", parts=()):
        low, high = (np.broadcast_to(np.asarray(limit, dtype), shape).copy() for limit in (low, high))
        super().__init__(low, high, tuple(shape), dtype)
        self.unit, self.parts = unit, tuple(parts)

    def __repr__(self):
        head = f"Box({self.shape}, {self.dtype}"
        low, high = self.low.ravel(), self.high.ravel()
        if self.parts:
            return head + ": " + ", ".join(
                f"{name} {a:g} to {b:g} {unit}".rstrip() for (name, unit), a, b in zip(self.parts, low, high)) + ")"
        return head + f", {low.min():g} to {high.max():g} {self.unit}".rstrip() + ")"
