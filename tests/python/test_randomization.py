"""What episodes draw: in its limits, recorded, equal for equal seeds, felt by the body and its sensors; mistakes are named."""
import os
import sys
import unittest

import numpy as np

import rubble
from rubble import _core
from rubble.envs import (Calibration, Choice, CrawlerNav, Light, LogUniform, Materials, Normal, Poses, Randomization, SnakeExplore,
                         TeamNav, Uniform, VoidExplore, Weather)
from rubble.envs.randomization import Drawn

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from shared_piles import share_piles

share_piles()

SMALL = {VoidExplore: {"size": 16, "pile_seeds": [1, 2]}, CrawlerNav: {"rays": 16, "pile_seeds": [1, 2]},
         SnakeExplore: {"size": 16, "pile_seeds": [1, 2]}}
ALL = Randomization(
    materials=Materials(friction=Uniform(0.2, 1.2)),
    calibration=Calibration(fov_deg=Uniform(60, 110), shift_x=Uniform(-3, 3), shift_y=Normal(0, 1, low=-2, high=2),
                            range_scale=Normal(1, 0.02), range_noise=LogUniform(0.001, 0.1), dropout=Choice([0, 0.05])),
    poses=Poses(yaw_deg=Uniform(-20, 20), sideways=Uniform(-0.3, 0.3), away=Uniform(0, 0.5)))


def only(randomization, *keys):
    """As much of it as an environment takes."""
    parts = {}
    for key in keys:
        part, _, name = key.partition(".")
        parts.setdefault(part, {})[name] = getattr(getattr(randomization, part), name)
    return Randomization(**{part: type(getattr(randomization, part))(**named) for part, named in parts.items()})


RANGES = ("calibration.range_scale", "calibration.range_noise", "calibration.dropout")
CAMERA = ("calibration.fov_deg", "calibration.shift_x", "calibration.shift_y", *RANGES)
FITTING = {VoidExplore: only(ALL, *CAMERA, "poses.yaw_deg"),
           CrawlerNav: only(ALL, *RANGES, "materials.friction", "poses.yaw_deg", "poses.sideways", "poses.away"),
           SnakeExplore: only(ALL, *CAMERA, "materials.friction", "poses.away")}


def play(env, seed, steps=5):
    """Everything that an episode gives; the drawn values."""
    observation, info = env.reset(seed=seed)
    told = [observation[name].tobytes() for name in sorted(observation)]
    for k in range(steps):
        observation, reward, *_ = env.step(np.full(env.action_space.shape, 0.9 - 0.3 * k, np.float32))
        told += [observation[name].tobytes() for name in sorted(observation)] + [reward]
    return told, info["randomization"]


class Distributions(unittest.TestCase):
    def draw(self, of, count=2000):
        return [of.draw(_core._Random(seed, "x")) for seed in range(count)]

    def test_values_are_within_limits_and_spread_as_they_say(self):
        values = np.array(self.draw(Uniform(-1, 3)))
        self.assertTrue(values.min() >= -1 and values.max() <= 3)
        np.testing.assert_allclose([values.mean(), values.std()], [1, 4 / np.sqrt(12)], atol=0.1)
        values = np.array(self.draw(LogUniform(0.01, 100)))
        self.assertTrue(values.min() >= 0.01 and values.max() <= 100)
        np.testing.assert_allclose([(values < 1).mean(), (values < 0.1).mean()], [0.5, 0.25], atol=0.05)
        values = np.array(self.draw(Normal(5, 2)))
        np.testing.assert_allclose([values.mean(), values.std()], [5, 2], atol=0.15)
        values = np.array(self.draw(Normal(5, 2, low=4, high=6)))
        self.assertEqual((values.min(), values.max()), (4, 6))
        drawn = self.draw(Choice(["a", "b", "c"], weights=[1, 0, 3]))
        self.assertNotIn("b", drawn)
        self.assertAlmostEqual(drawn.count("c") / len(drawn), 0.75, delta=0.04)
        self.assertEqual(set(self.draw(Choice([1, 2]), 50)), {1, 2})
        self.assertEqual(self.draw(Uniform(2, 2), 3), [2, 2, 2])

    def test_the_bits_are_those_of_every_machine(self):
        self.assertEqual([of.draw(_core._Random(7, "calibration.fov_deg")).hex()
                          for of in (Uniform(0, 1), Normal(0, 1), LogUniform(1, 10))], BITS)

    def test_numbers_of_numpy_are_those_of_python(self):
        """Their text and arithmetic would depend on the numpy."""
        for kind in (np.float32, np.float64):
            low, high = kind(0.4), kind(0.6)
            for of, plain in ((Uniform(low, high), Uniform(float(low), float(high))),
                              (LogUniform(low, high), LogUniform(float(low), float(high))),
                              (Normal(high, kind(0.01), low, kind(1)), Normal(float(high), float(kind(0.01)), float(low), 1.0)),
                              (Choice([low, high], [kind(0.1), kind(0.2)]), Choice([float(low), float(high)], [float(kind(0.1)), float(kind(0.2))])),
                              (Choice([np.int64(1), np.int32(2)]), Choice([1, 2]))):
                self.assertEqual(repr(of), repr(plain))
                for value, wanted in zip(self.draw(of, 20), self.draw(plain, 20)):
                    self.assertIs(type(value), type(wanted))
                    self.assertEqual(value, wanted)
        drawn = Drawn(Randomization(weather=Weather(fog_density=np.float64(0.25), rain_mm_h=Choice(list(np.float64([3.5])))),
                                    light=Light(sky=np.str_("clear"))), ("weather.*", "light.*"), "here")
        drawn.draw(np.random.default_rng(1))
        self.assertEqual(drawn.overrides(), ["light.sky=clear", "light.type=sun", "air.fog_density=0.25", "air.rain_mm_h=3.5"])
        with self.assertRaises(rubble.InputError):
            Choice([np.bool_(True)])

    def test_mistakes_are_named(self):
        for make, key, text in (
                (lambda: Uniform(2, 1), "Uniform", "low <= high"),
                (lambda: Uniform("1", 2), "Uniform", "two numbers"),
                (lambda: LogUniform(0, 1), "LogUniform", "0 < low"),
                (lambda: Normal(0, -1), "Normal", "at least 0"),
                (lambda: Normal(0, 1, low=1), "Normal", "low <= mean"),
                (lambda: Choice([]), "Choice", "not empty"),
                (lambda: Choice([1, 2], [1]), "Choice", "as many weights"),
                (lambda: Materials(friction=Uniform(0.5, 2.5)), "materials.friction", "0 to 2: found Uniform(low=0.5, high=2.5)"),
                (lambda: Materials(friction=True), "materials.friction", "expected a number"),
                (lambda: Materials(friction="ice"), "materials.friction", "expected a number"),
                (lambda: Calibration(range_noise=Normal(0.01, 0.01)), "calibration.range_noise", "give Normal its low and high"),
                (lambda: Light(sky="blue"), "light.sky", "one of clear, hazy"),
                (lambda: Light(sky=Uniform(0, 1)), "light.sky", "expected a text"),
                (lambda: Light(sky=Choice(["clear", 3])), "light.sky", "expected a text"),
                (lambda: Light(sky="clear", cloud_cover=0.5), "light.cloud_cover", 'sky="cloudy"'),
                (lambda: Weather(rain_mm_h=-1), "weather.rain_mm_h", "0 to 100 mm/h"),
                (lambda: Randomization(materials=Light()), "randomization.materials", "expected Materials"),
                (lambda: CrawlerNav(randomization={"friction": 1}), "randomization", "Randomization or None"),
                (lambda: CrawlerNav(randomization=Randomization(light=Light(sky="clear"))), "randomization.light.sky", "CrawlerNav"),
                (lambda: CrawlerNav(randomization=Randomization(calibration=Calibration(fov_deg=80))),
                 "randomization.calibration.fov_deg", "no effect"),
                (lambda: VoidExplore(randomization=Randomization(weather=Weather(fog_density=1))),
                 "randomization.weather.fog_density", "without colour"),
                (lambda: VoidExplore(randomization=Randomization(materials=Materials(friction=1))),
                 "randomization.materials.friction", "no effect")):
            with self.assertRaises(rubble.InputError, msg=key) as raised:
                make()
            self.assertEqual(raised.exception.key, key)
            self.assertIn(text, str(raised.exception))
        with self.assertRaises(TypeError):  # a key that is not there
            Materials(frction=1)


class Episodes(unittest.TestCase):
    def test_equal_seeds_give_equal_values_and_observations(self):
        for kind, randomization in FITTING.items():
            env, other = (kind(randomization=randomization, **SMALL[kind]) for _ in range(2))
            played = {seed: play(env, seed) for seed in (3, 4)}
            self.assertEqual(list(played[3][1]), list(randomization.keys()))
            self.assertNotEqual(played[3], played[4])
            for seed in (4, 3):
                self.assertEqual(play(other, seed), played[seed], kind.__name__)

    def test_a_key_that_is_drawn_besides_changes_no_other(self):
        friction = {"materials": ALL.materials}
        plain, more = (CrawlerNav(randomization=Randomization(**parts), **SMALL[CrawlerNav])
                       for parts in (friction, {**friction, "poses": ALL.poses}))
        self.assertEqual(play(plain, 3)[1]["materials.friction"], play(more, 3)[1]["materials.friction"])

    def test_without_a_randomization_nothing_is_drawn_and_recorded(self):
        plain, empty = CrawlerNav(**SMALL[CrawlerNav]), CrawlerNav(randomization=Randomization(), **SMALL[CrawlerNav])
        self.assertNotIn("randomization", plain.reset(seed=3)[1])
        observation, info = empty.reset(seed=3)
        self.assertEqual(info["randomization"], {})
        np.testing.assert_array_equal(observation["scan"], plain.reset(seed=3)[0]["scan"])

    def reset(self, kind, seed=3, **parts):
        env = kind(randomization=Randomization(**parts), **SMALL[kind], **({"metres": True} if kind != CrawlerNav else {}))
        return env, env.reset(seed=seed)[0]

    def test_ranges_are_measured_as_drawn(self):
        _, exact = self.reset(CrawlerNav)
        for parts, check in ((Calibration(range_scale=1.1), lambda e, m: np.testing.assert_allclose(m, np.minimum(1.1 * e, 8), rtol=1e-5)),
                             (Calibration(dropout=1), lambda e, m: np.testing.assert_array_equal(m, 8)),
                             (Calibration(range_noise=0.2), lambda e, m: self.assertTrue(0.05 < np.std((m - e)[e < 7]) < 0.5)),
                             (Calibration(range_noise=0.0), np.testing.assert_array_equal)):
            check(exact["scan"], self.reset(CrawlerNav, calibration=parts)[1]["scan"])
        env, _ = self.reset(CrawlerNav, calibration=Calibration(range_noise=0.1))
        scans = [env.step([0, 0, 0, 0])[0]["scan"] for _ in range(2)]
        self.assertGreater(np.abs(scans[0] - scans[1]).max(), 0.05)  # each scan has noise of its own

    def test_a_camera_is_calibrated_as_drawn(self):
        _, exact = self.reset(VoidExplore)
        _, shifted = self.reset(VoidExplore, calibration=Calibration(shift_x=2, shift_y=-3))
        np.testing.assert_allclose(shifted["depth"][:-3, 2:], exact["depth"][3:, :-2], atol=1e-5)
        env, wide = self.reset(VoidExplore, calibration=Calibration(fov_deg=120))
        self.assertAlmostEqual(env._world.view.K[0, 0], 8 / np.tan(np.radians(60)), places=6)
        self.assertFalse(np.array_equal(wide["depth"], exact["depth"]))

    def test_a_start_is_moved_as_drawn(self):
        base = self.reset(CrawlerNav)[0]._state["links"][0]
        moved = self.reset(CrawlerNav, poses=Poses(yaw_deg=30, sideways=0.2, away=0.4))[0]._state["links"][0]
        np.testing.assert_allclose(rubble.rotate(base, moved[:3] - base[:3], back=True), [-0.4, 0.2, 0], atol=1e-9)
        self.assertAlmostEqual(rubble.rotate(base, rubble.rotate(moved, [1, 0, 0]), back=True)[1], 0.5, places=6)
        env, observation = self.reset(VoidExplore, poses=Poses(yaw_deg=90))
        np.testing.assert_array_equal(observation["pose"], 0)  # which is since the start
        ahead = rubble.rotate(env._body(), [1, 0, 0])
        np.testing.assert_allclose(ahead, rubble.rotate(self.reset(VoidExplore)[0]._body(), [0, 1, 0]), atol=1e-9)
        near, far = (self.reset(SnakeExplore, poses=Poses(away=away))[0]._to_entrance() for away in (0, 1))
        self.assertGreater(far, near + 0.5)

    def test_friction_is_felt(self):
        def drive(friction):
            env, _ = self.reset(CrawlerNav, materials=Materials(friction=friction))
            return [env.step([1, 0, 0.5, 0.5])[0]["goal"][0] for _ in range(5)][-1]
        self.assertGreater(drive(0.02), drive(0.9) + 0.02)

    def test_light_and_weather_are_seen(self):
        def look(**parts):
            env = VoidExplore(colour=True, randomization=Randomization(**parts), **{**SMALL[VoidExplore], "pile_seeds": [1]})
            return env.reset(seed=3)[0]["rgb"].astype(float)
        low, fog = look(light=Light(elevation_deg=-10, sky="clear")), look(light=Light(elevation_deg=-10, sky="clear"), weather=Weather(fog_density=3))
        self.assertGreater(np.abs(low - fog).mean(), 3)


BITS = ['0x1.e708158150ca0p-6', '0x1.03a04e7e85ab0p-5', '0x1.1222ce81721b6p+0']

if __name__ == "__main__":
    unittest.main()
