"""Environments for reinforcement learning. With gymnasium installed they are its subclasses, registered as
rubble/VoidExplore-v0, rubble/SnakeExplore-v0 and rubble/CrawlerNav-v0; without it the same classes work with the
spaces of spaces.py.

    import gymnasium, rubble.envs
    env = gymnasium.make("rubble/VoidExplore-v0")
or
    env = rubble.envs.VoidExplore()
"""
from .crawler_nav import CrawlerNav
from .snake_explore import SnakeExplore
from .void_explore import VoidExplore

try:
    from gymnasium.envs.registration import register as _register
except ImportError:
    pass
else:
    _register(id="rubble/VoidExplore-v0", entry_point="rubble.envs:VoidExplore")
    _register(id="rubble/SnakeExplore-v0", entry_point="rubble.envs:SnakeExplore")
    _register(id="rubble/CrawlerNav-v0", entry_point="rubble.envs:CrawlerNav")

__all__ = ["CrawlerNav", "SnakeExplore", "VoidExplore"]
