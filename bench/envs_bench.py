#!/usr/bin/python3
"""Steps a second of the environments: rubble/VoidExplore-v0 by the side of its depth picture, and with colour,
rubble/CrawlerNav-v0 and rubble/SnakeExplore-v0; and memory at the end. A step of the last two is 0.1 s.

usage: PYTHONPATH=build/release/python /usr/bin/python3 bench/envs_bench.py [--steps 500] [--threads 1,2]
       ... --colour --write docs/development/robots.md   writes the table into a document, between its marks
       ... --batch 64 [--write ...]                      instead: a batch of so many beside one, and resets
"""
import argparse
import os
import resource
import sys
import time

import numpy as np

from rubble.envs import Batch, CrawlerNav, SnakeExplore, VoidExplore

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "tools"))
from document_marks import write_between_marks  # noqa: E402


def measure(env, steps):
    """Steps in a second of the clock, and in a second of processor."""
    env.reset(seed=1)
    actions = np.random.default_rng(1).uniform(-1, 1, (steps, *env.action_space.shape))
    start = time.perf_counter(), time.process_time()
    for action in actions:
        if any(env.step(action)[2:4]):
            env.reset()
    return steps / (time.perf_counter() - start[0]), steps / (time.process_time() - start[1])


def measure_batch(make, count, threads, steps):
    """As measure(), of a Batch: steps of its environments."""
    batch = Batch(make, count, threads)
    batch.reset(seed=1)
    rounds = max(steps // count, 2)
    actions = np.random.default_rng(1).uniform(-1, 1, (rounds, *batch.action_space.shape))
    start = time.perf_counter(), time.process_time()
    for action in actions:
        batch.step(action)
    times = time.perf_counter() - start[0], time.process_time() - start[1]
    batch.close()
    return [rounds * count / taken for taken in times]


def measure_reset(make, count=20):
    """Milliseconds of processor that a reset takes where the pile is settled."""
    env = make()
    env.reset(seed=1)
    start = time.process_time()
    for seed in range(count):
        env.reset(seed=seed)
    return 1000 * (time.process_time() - start) / count


def compare_batch(count, steps):
    """Lines of a table."""
    lines = [f"|environment|reset, ms of processor|one: steps in a second of processor|{count}, 1 thread|{count}, 2 threads|"
             f"one: in a second of the clock|{count}, 1 thread|{count}, 2 threads|", "|---|---|---|---|---|---|---|---|"]
    for kind, options in ((VoidExplore, {"size": 32}), (CrawlerNav, {}), (SnakeExplore, {"size": 16})):
        def make():
            return kind(max_steps=100, pile_seeds=[1], **options)
        own = make()  # keeps the pile
        # The middle of three turns, for what else the machine does meanwhile.
        turns = [[measure(own, steps), *(measure_batch(make, count, threads, steps) for threads in (1, 2))] for _ in range(3)]
        found = np.median(turns, axis=0)
        lines.append(f"|`{kind.__name__}`|{measure_reset(make):.1f}|" + "".join(f"{rate:.0f}|" for rate in [*found[:, 1], *found[:, 0]]))
    return lines


def list_cases(threads, colour):
    options = {"threads": threads, "pile_seeds": [1]}
    for size in (16, 32, 64, 128):
        yield f"`VoidExplore`, depth {size} x {size}", VoidExplore(size=size, max_steps=100, **options)
    if colour:
        yield "`VoidExplore`, depth and colour 128 x 128", VoidExplore(size=128, colour=True, max_steps=100, **options)
    yield "`CrawlerNav`", CrawlerNav(max_steps=10000, **options)
    yield "`SnakeExplore`, depth 16 x 16", SnakeExplore(size=16, max_steps=10000, **options)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--steps", type=int, default=500)
    parser.add_argument("--threads", default="1,2")
    parser.add_argument("--colour", action="store_true", help="with pictures in colour too, whose light is baked first")
    parser.add_argument("--batch", type=int, metavar="COUNT")
    parser.add_argument("--write", metavar="DOCUMENT")
    args = parser.parse_args()
    if args.batch:
        lines = compare_batch(args.batch, args.steps)
        print("\n".join(lines))
        if args.write:
            write_between_marks(args.write, "batch", "\n".join(lines) + "\n")
        return
    lines = ["| environment | threads | steps in a second | in a second of processor |", "|---|---|---|---|"]
    for threads in map(int, args.threads.split(",")):
        for name, env in list_cases(threads, args.colour):
            clock, processor = measure(env, args.steps)
            lines.append(f"| {name} | {threads} | {clock:.0f} | {processor:.0f} |")
            print(lines[-1], flush=True)
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(f"memory: {memory:.0f} MiB at most, for all of them together")
    if args.write:
        write_between_marks(args.write, "envs", "\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
