#!/usr/bin/python3
"""Trains a policy that explores voids by depth, by proximal policy optimization (PPO, Schulman et al. 2017), and
writes its weights for agent.py, and how it learned.

usage: PYTHONPATH=build/release/python /usr/bin/python3 examples/search/ppo/train.py scripts/search.lua weights.npz
       [--steps 400000] [--piles 101..116] [--seed 1] [--curve curve.csv]

It learns in rubble/VoidExplore-v0, in the piles of the mission at those seeds, to see much of the void. It never sees
a victim. Needs PyTorch (Debian: python3-torch). One thread; the same seed gives the same weights on one machine.
"""
import argparse
import csv
import os
import tempfile
import time

import numpy as np
import torch

from rubble.envs import VoidExplore
from senses import ACTIONS, COLUMNS, FAR, HOLD, ROWS, SIZE, Senses

ENVIRONMENTS, ROLLOUT = 8, 256
DISCOUNT, TRACE, CLIP, ENTROPY, EPOCHS, BATCH, RATE = 0.99, 0.95, 0.2, 0.01, 4, 512, 3e-4
HIDDEN = 64
ASSESSED = 8  # episodes of each environment, before and after


class Net(torch.nn.Module):
    def __init__(self):
        super().__init__()
        def trunk():
            return torch.nn.Sequential(torch.nn.Linear(SIZE, HIDDEN), torch.nn.Tanh(),
                                       torch.nn.Linear(HIDDEN, HIDDEN), torch.nn.Tanh())
        self.actor = torch.nn.Sequential(*trunk(), torch.nn.Linear(HIDDEN, len(ACTIONS)))
        self.critic = torch.nn.Sequential(*trunk(), torch.nn.Linear(HIDDEN, 1))
        with torch.no_grad():
            self.actor[-1].weight *= 0.01

    def forward(self, seen):
        return torch.distributions.Categorical(logits=self.actor(seen)), self.critic(seen).squeeze(-1)


class Explorer:
    """One environment, begun anew whenever an episode ends."""

    def __init__(self, env, seed):
        self.env, self.seed, self.finished = env, seed, []
        self.begin()

    def begin(self):
        self.seed += ENVIRONMENTS
        self.senses, self.stops, self.gained = Senses(), 0, 0.0
        observation, info = self.env.reset(seed=self.seed)
        self.seen = self.encode(observation, info)

    def encode(self, observation, info):
        x, y, z, yaw = map(float, observation["pose"])
        stopped, self.stops = info["stops"] > self.stops, info["stops"]
        margin = (COLUMNS - ROWS) // 2
        return self.senses.encode(observation["depth"][margin:-margin], (x, y, z), yaw, stopped)

    def step(self, action):
        gained = 0.0
        for _ in range(HOLD):
            observation, reward, terminated, truncated, info = self.env.step(ACTIONS[action])
            gained += reward
            if terminated or truncated or info["stops"] > self.stops:
                break
        self.gained += gained
        self.seen = self.encode(observation, info)
        if terminated or truncated:
            self.finished.append((self.gained, info["coverage"]))
            self.begin()
        return gained, terminated or truncated


def collect(explorers, net):
    """ROLLOUT steps of each: what was seen, done, its logarithm of probability, reward, end, and value."""
    shape = (ROLLOUT, len(explorers))
    seen = torch.zeros(*shape, SIZE)
    done, chance, reward, end, value = (torch.zeros(*shape) for _ in range(5))
    for t in range(ROLLOUT):
        seen[t] = torch.from_numpy(np.stack([e.seen for e in explorers]))
        with torch.no_grad():
            actions, value[t] = net(seen[t])
        drawn = actions.sample()
        done[t], chance[t] = drawn, actions.log_prob(drawn)
        for k, explorer in enumerate(explorers):
            reward[t, k], end[t, k] = explorer.step(int(drawn[k]))
    with torch.no_grad():
        last = net(torch.from_numpy(np.stack([e.seen for e in explorers])))[1]
    advantage, following = torch.zeros(shape), torch.zeros(len(explorers))
    for t in reversed(range(ROLLOUT)):
        after = last if t == ROLLOUT - 1 else value[t + 1]
        off = reward[t] + DISCOUNT * after * (1 - end[t]) - value[t]
        following = off + DISCOUNT * TRACE * (1 - end[t]) * following
        advantage[t] = following
    return [x.flatten(0, 1) for x in (seen, done, chance, advantage, advantage + value)]


def assess(net, explorers, episodes):
    """Mean reward and coverage of so many episodes of each explorer, without learning; the random numbers of training stay as
    they are."""
    with torch.random.fork_rng(), torch.no_grad():
        torch.manual_seed(0)
        for explorer in explorers:
            while len(explorer.finished) < episodes:
                actions, _ = net(torch.from_numpy(explorer.seen[None]))
                explorer.step(int(actions.sample()[0]))
    return np.mean([row for explorer in explorers for row in explorer.finished[:episodes]], axis=0)


def improve(net, optimizer, rollout):
    seen, done, chance, advantage, gain = rollout
    for _ in range(EPOCHS):
        order = torch.randperm(len(seen))
        for k in range(0, len(order), BATCH):
            some = order[k:k + BATCH]
            actions, value = net(seen[some])
            a = advantage[some]
            a = (a - a.mean()) / (a.std() + 1e-8)
            ratio = torch.exp(actions.log_prob(done[some]) - chance[some])
            kept = torch.clamp(ratio, 1 - CLIP, 1 + CLIP)
            loss = (-torch.min(ratio * a, kept * a).mean() + 0.5 * ((value - gain[some]) ** 2).mean()
                    - ENTROPY * actions.entropy().mean())
            optimizer.zero_grad()
            loss.backward()
            torch.nn.utils.clip_grad_norm_(net.parameters(), 0.5)
            optimizer.step()


def write_weights(net, path):
    """To a temporary name first, so that a file that is there is whole."""
    arrays = {}
    for layer, linear in enumerate(m for m in net.actor if isinstance(m, torch.nn.Linear)):
        arrays[f"w{layer}"], arrays[f"b{layer}"] = linear.weight.detach().numpy().T, linear.bias.detach().numpy()
    folder = os.path.dirname(os.path.abspath(path))
    with tempfile.NamedTemporaryFile(dir=folder, suffix=".npz", delete=False) as file:
        np.savez(file, **arrays)
    os.replace(file.name, path)


def seed_range(text):
    first, last = (int(x) for x in text.split(".."))
    return range(first, last + 1)


# Its checks of arguments cost a third of a step.
torch.distributions.Distribution.set_default_validate_args(False)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mission")
    parser.add_argument("weights")
    parser.add_argument("--steps", type=int, default=400_000, help="actions")
    parser.add_argument("--piles", type=seed_range, default=range(101, 117), metavar="FIRST..LAST")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--curve", metavar="CSV",
                        help="a row for each 16 rollouts: steps, reward and coverage of episodes; the first and the last row are "
                             "of the same episodes, before and after")
    args = parser.parse_args()
    torch.manual_seed(args.seed)
    torch.set_num_threads(1)
    with open(args.mission) as file:
        mission = file.read()

    def make_explorers(seed):
        return [Explorer(VoidExplore(mission=mission, pile_seeds=args.piles[k::ENVIRONMENTS], size=COLUMNS,
                                     max_range=FAR, max_steps=1500, metres=True), seed * 1_000_000 + k)
                for k in range(min(ENVIRONMENTS, len(args.piles)))]

    explorers = make_explorers(args.seed)
    net = Net()
    optimizer = torch.optim.Adam(net.parameters(), lr=RATE, eps=1e-5)

    def assess_row(steps):
        reward, coverage = assess(net, make_explorers(0), ASSESSED)
        return [steps, ASSESSED * len(explorers), f"{reward:.2f}", f"{coverage:.3f}"]

    rows, began, updates = [assess_row(0)], time.monotonic(), max(1, args.steps // (len(explorers) * ROLLOUT))
    for update in range(1, updates + 1):
        for group in optimizer.param_groups:
            group["lr"] = RATE * (1 - (update - 1) / updates)
        improve(net, optimizer, collect(explorers, net))
        if update % 16 and update != updates:
            continue
        episodes = [e for explorer in explorers for e in explorer.finished]
        for explorer in explorers:
            explorer.finished.clear()
        reward, coverage = np.mean(episodes, axis=0) if episodes else (float("nan"),) * 2
        rows.append([update * len(explorers) * ROLLOUT, len(episodes), f"{reward:.2f}", f"{coverage:.3f}"])
        left = (time.monotonic() - began) / update * (updates - update)
        if update == updates:
            rows[-1] = assess_row(rows[-1][0])
            _, _, reward, coverage = map(float, rows[-1])
        print(f"{rows[-1][0]} steps, reward {reward:.2f}, coverage {coverage:.3f}, {left:.0f} s left", flush=True)
    write_weights(net, args.weights)
    if args.curve:
        with open(args.curve, "w", newline="") as file:
            csv.writer(file).writerows([["steps", "episodes", "reward", "coverage"], *rows])


if __name__ == "__main__":
    main()
