#!/usr/bin/python3
"""Steps a second of rubble/VoidExplore-v0, by the side of its depth picture, and of rubble/CrawlerNav-v0, and memory
at the end.

usage: PYTHONPATH=build/release/python /usr/bin/python3 bench/envs_bench.py [--steps 500] [--threads 1,2]
"""
import argparse
import resource
import time

import numpy as np

from rubble.envs import CrawlerNav, VoidExplore


def measure(env, steps):
    env.reset(seed=1)
    actions = np.random.default_rng(1).uniform(-1, 1, (steps, 4))
    start = time.perf_counter()
    for action in actions:
        if any(env.step(action)[2:4]):
            env.reset()
    return steps / (time.perf_counter() - start)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--steps", type=int, default=500)
    parser.add_argument("--threads", default="1,2")
    args = parser.parse_args()
    for threads in map(int, args.threads.split(",")):
        for size in (16, 32, 64, 128):
            env = VoidExplore(size=size, threads=threads, max_steps=100, pile_seeds=[1])
            print(f"VoidExplore, {threads} threads, {size:3d} x {size:3d}: {measure(env, args.steps):7.0f} steps/s")
        crawler = CrawlerNav(threads=threads, max_steps=10000, pile_seeds=[1])
        print(f"CrawlerNav, {threads} threads, steps of 0.1 s: {measure(crawler, args.steps):7.0f} steps/s")
    print(f"memory: {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024:.0f} MiB at most")


if __name__ == "__main__":
    main()
