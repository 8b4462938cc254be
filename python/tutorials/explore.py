"""Explore a void at random, three times from one seed: python3 explore.py"""
import numpy as np

from rubble.envs import VoidExplore

env = VoidExplore(max_steps=50)
for episode in range(3):
    observation, info = env.reset(seed=11)
    chance = np.random.default_rng(5)
    total, done = 0.0, False
    while not done:
        observation, reward, terminated, truncated, info = env.step(chance.uniform(-1, 1, 4))
        total += reward
        done = terminated or truncated
    print(f"episode {episode}: return {total:.4f}, {info['coverage']:.0%} of the void seen, {info['stops']} stops")
