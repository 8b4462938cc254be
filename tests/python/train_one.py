"""Trains PPO of stable-baselines3 in an environment for some time, or measures its policy: train_one.py WHAT ENVIRONMENT SEED
FOLDER SECONDS

WHAT: train (goes on where it was, for SECONDS more of processor time, so that a busy machine trains as much as a quiet one; it
ends after SECONDS of the clock, too), measure (writes FOLDER/result.json), random (that of random actions). FOLDER has model.zip,
scales.pkl and state.json of the training, and curve.csv: steps, seconds, episodes since the last row and their mean return.
"""
import csv
import json
import os
import sys
import time

import numpy as np
import torch
from stable_baselines3 import PPO
from stable_baselines3.common.callbacks import BaseCallback
from stable_baselines3.common.monitor import Monitor
from stable_baselines3.common.vec_env import DummyVecEnv, VecNormalize

import rubble.envs

# The episodes are shorter than usual, so that forty minutes have some hundred; pictures are as small as the network takes.
OPTIONS = {"CrawlerNav": {"max_steps": 300}, "SnakeExplore": {"max_steps": 200}, "VoidExplore": {"max_steps": 200, "size": 36}}
COUNT = 8          # environments of a training
MEASURED = 24      # episodes of a result
FIRST_SEED = 5000  # of their resets
SAVE_S = 60


def make(name):
    return getattr(rubble.envs, name)(**OPTIONS[name])


def make_many(name, count):
    return DummyVecEnv([lambda: Monitor(make(name))] * count)


def scaled_keys(env):
    """All but pictures, which the network scales itself."""
    return [name for name, space in env.observation_space.spaces.items() if len(space.shape) == 1]


def write_json(path, value):
    with open(path + ".part", "w") as file:
        json.dump(value, file, indent=1)
    os.replace(path + ".part", path)


class Clock(BaseCallback):
    """Ends the training in time, and saves it now and then."""

    def __init__(self, folder, seconds, used, scales):
        super().__init__()
        self.folder, self.seconds, self.used, self.scales = folder, seconds, used, scales
        self.returns = []

    def _on_training_start(self):
        self.begin = self.saved = time.process_time()
        self.wall = time.monotonic()

    def _on_step(self):
        self.returns += [info["episode"]["r"] for info in self.locals["infos"] if "episode" in info]
        return max(time.process_time() - self.begin, time.monotonic() - self.wall) < self.seconds

    def _on_rollout_end(self):
        if time.process_time() - self.saved > SAVE_S:
            self.save()

    def _on_training_end(self):
        self.save()

    def save(self):
        self.saved = time.process_time()
        used = self.used + self.saved - self.begin
        with open(os.path.join(self.folder, "curve.csv"), "a") as file:
            csv.writer(file).writerow([self.model.num_timesteps, round(used), len(self.returns), np.mean(self.returns) if self.returns else ""])
        self.returns = []
        self.model.save(os.path.join(self.folder, "model.part.zip"))
        os.replace(os.path.join(self.folder, "model.part.zip"), os.path.join(self.folder, "model.zip"))
        self.scales.save(os.path.join(self.folder, "scales.pkl"))
        write_json(os.path.join(self.folder, "state.json"), {"seconds": used, "steps": self.model.num_timesteps})


def load(name, folder, count):
    many = make_many(name, count)
    scales = VecNormalize.load(os.path.join(folder, "scales.pkl"), many)
    return PPO.load(os.path.join(folder, "model.zip"), scales, device="cpu"), scales


def train(name, seed, folder, seconds):
    torch.set_num_threads(1)
    os.makedirs(folder, exist_ok=True)
    used = 0.0
    if os.path.exists(os.path.join(folder, "state.json")):
        with open(os.path.join(folder, "state.json")) as file:
            used = json.load(file)["seconds"]
        model, scales = load(name, folder, COUNT)
    else:
        many = make_many(name, COUNT)
        scales = VecNormalize(many, norm_obs_keys=scaled_keys(many))
        model = PPO("MultiInputPolicy", scales, n_steps=128, batch_size=256, ent_coef=0.003, seed=seed, device="cpu")
    model.learn(10 ** 9, Clock(folder, seconds, used, scales), reset_num_timesteps=False)


def play(name, choose):
    """Returns of episodes; choose(observation) gives an action."""
    env, returns = make(name), []
    for i in range(MEASURED):
        observation, _ = env.reset(seed=FIRST_SEED + i)
        total, over = 0.0, False
        while not over:
            observation, reward, terminated, truncated, _ = env.step(choose(observation))
            total, over = total + float(reward), terminated or truncated
        returns.append(total)
    return returns


def measure(name, seed, folder):
    """As in the training, actions are drawn."""
    model, scales = load(name, folder, 1)
    scales.training = False
    torch.manual_seed(seed)
    returns = play(name, lambda seen: np.clip(model.predict(scales.normalize_obs({k: v[None] for k, v in seen.items()}))[0][0], -1, 1))
    with open(os.path.join(folder, "state.json")) as file:
        write_json(os.path.join(folder, "result.json"), {**json.load(file), "returns": returns})


def play_random(name, folder):
    space = make(name).action_space
    space.seed(1)
    os.makedirs(folder, exist_ok=True)
    write_json(os.path.join(folder, "result.json"), {"returns": play(name, lambda _: space.sample())})


if __name__ == "__main__":
    what, environment, seed, folder, seconds = sys.argv[1:]
    if what == "train":
        train(environment, int(seed), folder, float(seconds))
    elif what == "measure":
        measure(environment, int(seed), folder)
    else:
        play_random(environment, folder)
