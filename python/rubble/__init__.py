"""Rubble from Python: settle piles, ask them questions, look at them, drive robots through them, and read
what a run recorded. Metres, seconds, radians; the world has Z up. docs/reference/python.md shows each.

    import rubble
    pile = rubble.settle("scripts/small.lua", seed=7)
    pile.clearance([[0, 0, 1]])
    frame = rubble.Renderer(pile).render(rubble.look_at([-4, 0, 2], [0, 0, 0.5]), 640, 480)

A pose is an array of seven numbers: x y z, then the quaternion w x y z, of a body with X forward, Y left and
Z up. Mistakes raise InputError, with the attributes file, line, key and diagnostics.
"""
import os as _os

# The assets that a wheel holds, or those that a build keeps beside its program.
for _place in ("assets", _os.path.join("..", "..", "assets")):
    _beside = _os.path.normpath(_os.path.join(_os.path.dirname(__file__), _place))
    if "RUBBLE_ASSETS" not in _os.environ and _os.path.isdir(_beside):
        _os.environ["RUBBLE_ASSETS"] = _beside

from ._core import InputError, Pile, RunError, __version__, open_pile, set_sandbox  # noqa: E402
from .batches import Batch, RayExecutor, batch  # noqa: E402
from .dataset import Dataset, open_dataset  # noqa: E402
from .geometry import compose, look_at, matrix, pose, rotate  # noqa: E402
from .mission_text import settle  # noqa: E402
from .missions import Mission  # noqa: E402
from .program import run  # noqa: E402
from .robots import RobotWorld, Session  # noqa: E402
from .sensors import DepthCamera, Lidar, Renderer  # noqa: E402

__all__ = ["Batch", "Dataset", "DepthCamera", "InputError", "Lidar", "Mission", "Pile", "RayExecutor", "Renderer",
           "RobotWorld", "RunError", "Session", "__version__", "batch", "compose", "look_at", "matrix", "open_dataset", "open_pile",
           "pose", "rotate", "run", "set_sandbox", "settle"]
