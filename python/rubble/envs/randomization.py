"""What an episode draws besides its pile, start and goal: values of materials, light, calibration, poses and weather.

    from rubble.envs import CrawlerNav, Calibration, Materials, Normal, Randomization, Uniform
    env = CrawlerNav(randomization=Randomization(materials=Materials(friction=Uniform(0.4, 0.9)),
                                                 calibration=Calibration(range_noise=Normal(0.02, 0.005, low=0))))
    observation, info = env.reset(seed=3)
    info["randomization"]   # {"calibration.range_noise": 0.0213, "materials.friction": 0.55}

Each key has a stream of random numbers of its own, from the seed of the episode: another key that is drawn changes none of
the others. The same seed gives the same values and observations, bit for bit.
"""
from __future__ import annotations

import math
from dataclasses import dataclass, field, fields
from typing import Any, Optional, Sequence, Union

import numpy as np

from .. import _core
from ..arguments import mistake


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float, np.integer, np.floating)) and not isinstance(value, bool) and math.isfinite(value)


def _plain(value: Any) -> Any:
    """A number or text of numpy as Python's: arithmetic and text do not depend on the numpy."""
    if isinstance(value, np.floating):
        return float(value)
    return value.item() if isinstance(value, np.generic) else value


def _make_plain(of: Any) -> None:
    """All members of a dataclass."""
    for one in fields(of):
        value = getattr(of, one.name)
        object.__setattr__(of, one.name, tuple(map(_plain, value)) if isinstance(value, tuple) else _plain(value))


class _Distribution:
    def _expect(self, fine: bool, expected: str) -> None:
        if not fine:
            raise mistake(type(self).__name__, f"expected {expected}: found {self!r}")


@dataclass(frozen=True)
class Uniform(_Distribution):
    """A number from low to high, each as likely as another."""
    low: float
    high: float

    def __post_init__(self) -> None:
        _make_plain(self)
        self._expect(_is_number(self.low) and _is_number(self.high) and self.low <= self.high, "two numbers, low <= high")

    def limits(self) -> tuple[float, float]:
        return float(self.low), float(self.high)

    def draw(self, random: _core._Random) -> float:
        return min(self.low + (self.high - self.low) * float(random.uniform(1)[0]), float(self.high))


@dataclass(frozen=True)
class LogUniform(_Distribution):
    """A number from low to high, each factor as likely as another."""
    low: float
    high: float

    def __post_init__(self) -> None:
        _make_plain(self)
        self._expect(_is_number(self.low) and _is_number(self.high) and 0 < self.low <= self.high,
                     "two numbers, 0 < low <= high")

    def limits(self) -> tuple[float, float]:
        return float(self.low), float(self.high)

    def draw(self, random: _core._Random) -> float:
        low, high = _core._log(self.low), _core._log(self.high)
        return min(max(_core._exp(low + (high - low) * float(random.uniform(1)[0])), float(self.low)), float(self.high))


@dataclass(frozen=True)
class Normal(_Distribution):
    """A number about the mean, at most 6 standard deviations away. Beyond low or high, it is low or high."""
    mean: float
    std: float
    low: Optional[float] = None
    high: Optional[float] = None

    def __post_init__(self) -> None:
        _make_plain(self)
        self._expect(_is_number(self.mean) and _is_number(self.std) and self.std >= 0
                     and all(limit is None or _is_number(limit) for limit in (self.low, self.high)),
                     "a mean, a standard deviation of at least 0, and limits that are numbers")
        self._expect((self.low is None or self.low <= self.mean) and (self.high is None or self.mean <= self.high),
                     "low <= mean <= high")

    def limits(self) -> tuple[float, float]:
        low, high = self.mean - 6 * self.std, self.mean + 6 * self.std
        return (low if self.low is None else max(low, float(self.low)),
                high if self.high is None else min(high, float(self.high)))

    def draw(self, random: _core._Random) -> float:
        low, high = self.limits()
        return float(min(max(self.mean + self.std * float(random.normal(1)[0]), low), high))


@dataclass(frozen=True)
class Choice(_Distribution):
    """One of the values, by their weights; without weights, each as likely as another."""
    values: Sequence[Union[float, str]]
    weights: Optional[Sequence[float]] = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "values", tuple(self.values) if isinstance(self.values, (list, tuple, range)) else ())
        if self.weights is not None:
            object.__setattr__(self, "weights", tuple(self.weights))
        _make_plain(self)
        self._expect(len(self.values) > 0 and all(isinstance(v, str) or _is_number(v) for v in self.values),
                     "a list of numbers or texts, not empty")
        if self.weights is not None:
            self._expect(len(self.weights) == len(self.values) and all(_is_number(w) and w >= 0 for w in self.weights)
                         and sum(self.weights) > 0, "as many weights as values, at least 0, one of them above 0")

    def draw(self, random: _core._Random) -> Union[float, str]:
        weights = self.weights or (1.0,) * len(self.values)
        left = float(random.uniform(1)[0]) * sum(weights)
        for value, weight in zip(self.values, weights):
            left -= weight
            if left < 0:
                return value
        return next(v for v, w in zip(reversed(self.values), reversed(weights)) if w > 0)


# What a key may be: a distribution, or a value that every episode has. None: as the environment has it.
Value = Union[None, float, str, Uniform, LogUniform, Normal, Choice]


def _key(meaning: str, unit: str, low: Any = None, high: Any = None, names: Sequence[str] = ()) -> Any:
    return field(default=None, metadata={"meaning": meaning, "unit": unit, "low": low, "high": high, "names": tuple(names)})


class _Part:
    """Keys that belong together; each is checked when the part is made."""

    def __post_init__(self) -> None:
        _make_plain(self)
        for one in fields(self):  # type: ignore[arg-type]  # its classes are dataclasses
            self._check(f"{type(self).__name__.lower()}.{one.name}", getattr(self, one.name), one.metadata)

    @staticmethod
    def _check(key: str, value: Any, about: Any) -> None:
        names = about["names"]
        kinds = "a text, Choice" if names else "a number, Uniform, LogUniform, Normal, Choice"
        if value is None:
            return
        if isinstance(value, Choice):
            values = value.values
        elif not names and isinstance(value, _Distribution):
            values = value.limits()  # type: ignore[attr-defined]
        else:
            values = (value,)
        if not all(isinstance(v, str) if names else _is_number(v) for v in values):
            raise mistake(key, f"expected {kinds} or None: found {value!r}")
        for v in values:
            if names and v not in names:
                raise mistake(key, f"expected one of {', '.join(names)}: found {v!r}")
            if not names and not about["low"] <= v <= about["high"]:
                unit = f" {about['unit']}" if about["unit"] else ""
                more = "; give Normal its low and high" if isinstance(value, Normal) else ""
                raise mistake(key, f"expected {about['low']:g} to {about['high']:g}{unit}: found {value!r}, "
                                   f"which can be {v:g}{more}")


@dataclass(frozen=True)
class Materials(_Part):
    friction: Value = _key("friction of tracks, wheels or skin against concrete, instead of the model's", "", 0, 2)


@dataclass(frozen=True)
class Light(_Part):
    """The sun, instead of the mission's light. Each new light of a pile is baked, which takes seconds: prefer Choice."""
    elevation_deg: Value = _key("elevation of the sun", "degree", -18, 90)
    azimuth_deg: Value = _key("azimuth of the sun, from X towards Y", "degree", -360, 360)
    sky: Value = _key("sky of the sun", "", names=("clear", "hazy", "cloudy", "overcast", "moonlit", "city_night", "cie_clear"))
    cloud_cover: Value = _key("share of the sky that is cloud, with the sky `cloudy`", "", 0, 1)

    def __post_init__(self) -> None:
        super().__post_init__()
        skies = self.sky.values if isinstance(self.sky, Choice) else (self.sky,)
        if self.cloud_cover is not None and "cloudy" not in skies:
            raise mistake("light.cloud_cover", f"has no effect without the sky: expected sky=\"cloudy\": found sky={self.sky!r}")


@dataclass(frozen=True)
class Calibration(_Part):
    """Of the camera, and of the ranges of depth and scan."""
    fov_deg: Value = _key("horizontal field of view, instead of that of the argument", "degree", 1, 170)
    shift_x: Value = _key("principal point to the right of the middle", "pixel", -8, 8)
    shift_y: Value = _key("principal point below the middle", "pixel", -8, 8)
    range_scale: Value = _key("factor of all ranges", "", 0.5, 2)
    range_noise: Value = _key("standard deviation of each range", "m", 0, 1)
    dropout: Value = _key("share of ranges that are lost: they show `max_range`", "", 0, 1)


@dataclass(frozen=True)
class Poses(_Part):
    """Of the start."""
    yaw_deg: Value = _key("turn to the left", "degree", -180, 180)
    sideways: Value = _key("shift to the left", "m", -2, 2)
    away: Value = _key("shift backwards", "m", 0, 5)


@dataclass(frozen=True)
class Weather(_Part):
    fog_density: Value = _key("extinction coefficient of fog", "1/m", 0, 10)
    rain_mm_h: Value = _key("rate of rain", "mm/h", 0, 100)
    snow_mm_h: Value = _key("rate of snowfall, as melted water", "mm/h", 0, 10)


@dataclass(frozen=True)
class Randomization:
    """The parts; a key that is None is not drawn."""
    materials: Materials = Materials()
    light: Light = Light()
    calibration: Calibration = Calibration()
    poses: Poses = Poses()
    weather: Weather = Weather()

    def __post_init__(self) -> None:
        for one in fields(self):
            wanted, found = type(one.default), getattr(self, one.name)
            if not isinstance(found, wanted):
                raise mistake(f"randomization.{one.name}", f"expected {wanted.__name__}: found {found!r}")

    def keys(self) -> dict[str, Value]:
        """What is drawn, by key such as "materials.friction", in the order of the names."""
        found = {}
        for part in fields(self):
            for one in fields(getattr(self, part.name)):
                value = getattr(getattr(self, part.name), one.name)
                if value is not None:
                    found[f"{part.name}.{one.name}"] = value
        return dict(sorted(found.items()))


class Drawn:
    """The values of an episode. randomization: None: nothing is drawn."""

    def __init__(self, randomization: Optional[Randomization], supported: Sequence[str], where: str) -> None:
        """supported: keys, or parts followed by ".*"; where: the environment, as an error names it."""
        if randomization is not None and not isinstance(randomization, Randomization):
            raise mistake("randomization", f"expected a rubble.envs.Randomization or None: found {randomization!r}")
        self._keys = {} if randomization is None else randomization.keys()
        self.values: dict[str, Any] = {}
        self._given, self._seed = randomization is not None, 0
        for key in self._keys:
            if key not in supported and key.partition(".")[0] + ".*" not in supported:
                raise mistake(f"randomization.{key}", f"has no effect in {where}: expected only {', '.join(sorted(supported))}")

    def draw(self, random: np.random.Generator) -> None:
        """For the episode that begins. random: of the environment; nothing is drawn from it without a randomization."""
        if self._given:
            self._seed = int(random.integers(2**63))
            self.values = {key: of.draw(_core._Random(self._seed, key)) if isinstance(of, _Distribution) else of
                           for key, of in self._keys.items()}
            self._noise, self._lost = (_core._Random(self._seed, name) for name in ("range noise", "dropout"))

    def info(self) -> dict[str, Any]:
        return {"randomization": dict(self.values)} if self._given else {}

    def get(self, key: str, default: Any = None) -> Any:
        return self.values.get(key, default)

    def measure(self, ranges: np.ndarray, max_range: float) -> np.ndarray:
        """Exact ranges as a sensor of this episode measures them, from 0 to max_range."""
        scale, noise, lost = (self.values.get(f"calibration.{name}") for name in ("range_scale", "range_noise", "dropout"))
        if scale is None and noise is None and lost is None:
            return ranges
        made = np.asarray(ranges, float)
        if scale is not None:
            made = np.where(made < max_range, made * scale, made)
        if noise is not None:
            made = made + np.where(made < max_range, noise * self._noise.normal(made.size).reshape(made.shape), 0)
        if lost is not None:
            made = np.where(self._lost.uniform(made.size).reshape(made.shape) < lost, max_range, made)
        return made.clip(0, max_range).astype(ranges.dtype)

    def overrides(self) -> list[str]:
        """Of the mission: light and weather."""
        made = [f"light.{key[6:]}={value}" for key, value in self.values.items() if key.startswith("light.")]
        if made:
            made.append("light.type=sun")
        return made + [f"air.{key[8:]}={value!r}" for key, value in self.values.items() if key.startswith("weather.")]
