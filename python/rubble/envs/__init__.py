"""Environments for reinforcement learning. With gymnasium installed they are its subclasses, registered as
rubble/VoidExplore-v0, rubble/SnakeExplore-v0 and rubble/CrawlerNav-v0; without it the same classes work with the
spaces of spaces.py. TeamNav has several robots, by PettingZoo's parallel interface. Batch steps many environments;
LerobotRecorder keeps episodes as a dataset.

    import gymnasium  # which imports rubble.envs by its name
    env = gymnasium.make("rubble.envs:rubble/VoidExplore-v0", max_episode_steps=200, render_mode="rgb_array")
or
    env = rubble.envs.VoidExplore()
"""
from .batch import Batch
from .crawler_nav import CrawlerNav
from .episodes import LerobotRecorder
from .randomization import (Calibration, Choice, Light, LogUniform, Materials, Normal, Poses, Randomization, Uniform,
                            Weather)
from .registry import register as _register
from .snake_explore import SnakeExplore
from .team_nav import TeamNav
from .void_explore import VoidExplore

try:
    _register()
except ImportError:  # no gymnasium
    pass

__all__ = ["Batch", "Calibration", "Choice", "CrawlerNav", "LerobotRecorder", "Light", "LogUniform", "Materials", "Normal", "Poses",
           "Randomization", "SnakeExplore", "TeamNav", "Uniform", "VoidExplore", "Weather"]
