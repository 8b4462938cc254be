"""Piles of missions that are texts. Environments of one process have each pile in common, as long as one of them uses it."""
import threading
import weakref
from typing import Any

from .. import _core
from ..mission_text import settle

_lock = threading.Lock()
_piles: "weakref.WeakValueDictionary[Any, SettledPile]" = weakref.WeakValueDictionary()


class SettledPile:
    """A pile with what is computed from it once."""

    def __init__(self):
        self._lock, self._made = threading.RLock(), {}

    def once(self, key, make):
        with self._lock:
            if key not in self._made:
                self._made[key] = make()
            return self._made[key]

    @property
    def radius(self):
        """Of a circle about the origin that holds it; m."""
        def measure():
            vertices, _ = self.pile.mesh()
            return float(_core._lengths(vertices[:, :2]).max()) if len(vertices) else 1.0
        return self.once("radius", measure)


def find_pile(mission, seed, threads, overrides=()):
    """The SettledPile of that mission and seed; its `pile` settles when it is the first."""
    key = mission, seed, threads, tuple(overrides)
    with _lock:
        found = _piles.setdefault(key, SettledPile())
    found.pile = found.once("pile", lambda: settle(mission, seed, overrides, threads))
    return found
