"""Pictures of environments: depths as levels, and what render() draws."""
import numpy as np

from .spaces import Box

_SOLID, _FREE = np.array([70, 66, 60]), np.array([236, 232, 224])
_PATH, _BODY, _GOAL = np.array([60, 110, 200]), np.array([214, 72, 40]), np.array([30, 150, 70])


def depth_space(size, max_range, metres):
    if metres:
        return Box(0.0, max_range, (size, size), np.float32, unit="m")
    return Box(0, 255, (size, size, 1), np.uint8, unit=f"levels of {max_range:g}/255 m")


def to_levels(depth, max_range):
    """Height x width x 1, uint8; 255: max_range or more."""
    return np.rint(np.minimum(depth, max_range) * np.float32(255 / max_range)).astype(np.uint8)[..., None]


def upscale(picture, size):
    """Height x width (x 1 or 3), uint8, to size x size x 3 by whole pixels, framed where it does not fit."""
    rgb = np.broadcast_to(picture if picture.ndim == 3 else picture[..., None], picture.shape[:2] + (3,))
    times = max(1, size // max(rgb.shape[:2]))
    large = rgb.repeat(times, axis=0).repeat(times, axis=1)[:size, :size]
    whole = np.zeros((size, size, 3), np.uint8)
    top, left = ((size - n) // 2 for n in large.shape[:2])
    whole[top:top + large.shape[0], left:left + large.shape[1]] = large
    return whole


class Section:
    """A horizontal section of a pile, seen from above: X to the right, Y upwards. Dark: solid; the lighter, the nearer is
    what lies below the section."""

    def __init__(self, pile, middle, half, size):
        """middle: x y z of its middle; half: of its width; m. size: pixels."""
        self._middle, self._half, self._size = np.asarray(middle, float)[:2], half, size
        steps = (np.arange(size) + 0.5) / size * 2 * half - half
        x, y = np.meshgrid(self._middle[0] + steps, self._middle[1] - steps)
        points = np.stack([x.ravel(), y.ravel(), np.full(x.size, float(middle[2]))], axis=1)
        hits = pile.cast_rays(points, np.tile([0.0, 0.0, -1.0], (x.size, 1)))
        # From within a piece a ray meets its surface from behind.
        solid = (hits["normal"][:, 2] < 0).reshape(size, size, 1)
        below = np.minimum(hits["distance"], float(middle[2]) + 1e-6).reshape(size, size, 1)
        light = _FREE * (1 - 0.4 * below / (float(middle[2]) + 1e-6))
        self.rgb = np.where(solid, _SOLID, light).astype(np.uint8)

    def mark(self, points, colour, radius):
        """Squares around points of the world (n x 2 or more, m); radius: m."""
        spread = max(1, int(radius / (2 * self._half) * self._size))
        for x, y in np.asarray(points, float).reshape(len(points), -1)[:, :2]:
            column = int((x - self._middle[0] + self._half) / (2 * self._half) * self._size)
            row = int((self._middle[1] + self._half - y) / (2 * self._half) * self._size)
            self.rgb[max(0, row - spread):max(0, row + spread + 1), max(0, column - spread):max(0, column + spread + 1)] = colour

    def draw_way(self, places, goal=None, radius=0.1):
        """Where the body has been (n x 3, m), where it is (the last), and where it is to go."""
        self.mark(places, _PATH, 0)
        if goal is not None:
            self.mark([goal], _GOAL, radius)
        self.mark(places[-1:], _BODY, radius)
