"""Records episodes of environments as LeRobot datasets, with what was seen beside them: rollouts.py DATA (PYTHONPATH: the package)"""
import sys
from pathlib import Path

import numpy as np

from rubble.envs import Calibration, CrawlerNav, LerobotRecorder, Randomization, Uniform, VoidExplore


def record(path, env, seeds):
    kept = {"depth": [], "state": [], "action": [], "reward": []}
    with LerobotRecorder(env, path) as env:
        env.action_space.seed(1)
        for seed in seeds:
            observation, _ = env.reset(seed=seed)
            over = False
            while not over:
                action = env.action_space.sample()
                kept["depth"].append(observation.get("depth", np.zeros((1, 1, 1), np.uint8)))
                kept["state"].append(np.concatenate([v for v in observation.values() if v.ndim == 1]))
                kept["action"].append(action)
                observation, reward, terminated, truncated, _ = env.step(action)
                kept["reward"].append(reward)
                over = terminated or truncated
    np.savez(str(path) + ".npz", **kept)


if __name__ == "__main__":
    data = Path(sys.argv[1])
    random = Randomization(calibration=Calibration(range_noise=Uniform(0.01, 0.05)))
    record(data / "rollouts_void", VoidExplore(pile_seeds=[1], size=48, max_steps=7, randomization=random), [3, 4, 5])
    record(data / "rollouts_crawler", CrawlerNav(pile_seeds=[1], rays=16, max_steps=5), [3, 4])
