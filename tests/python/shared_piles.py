"""Piles that the environments of a process have in common, because each takes long to settle."""
import functools

from rubble.envs import crawler_nav, void_world


def share_piles():
    """From now on, every environment gets the same pile for the same mission, seed and number of threads."""
    settle = functools.lru_cache(maxsize=None)(void_world.settle_text)
    crawler_nav.settle_text = void_world.settle_text = settle
