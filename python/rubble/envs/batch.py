"""Many environments of one kind in one process, stepped together."""
import concurrent.futures
import os

import numpy as np

from ..arguments import checked_seed, mistake, whole
from .spaces import AutoresetMode, VectorEnv, batch_space


def join_infos(infos):
    """As gymnasium has them: by key, an array over the environments, and under "_key" which of them have it."""
    joined = {}
    for key in dict.fromkeys(key for info in infos for key in info):
        there = np.array([key in info for info in infos])
        values = [info.get(key) for info in infos]
        kinds = {type(value) for value, has in zip(values, there) if has}
        if kinds == {dict}:
            joined[key] = join_infos([value or {} for value in values])
        elif len(kinds) == 1 and kinds <= {bool, int, float}:
            kind = kinds.pop()
            joined[key] = np.array([value if has else kind() for value, has in zip(values, there)], kind)
        else:
            joined[key] = np.empty(len(infos), object)
            joined[key][:] = values
        joined["_" + key] = there
    return joined


class Batch(VectorEnv):
    """`count` environments that `make()` gives, on `threads` threads, with the interface of gymnasium's vector environments.

        env = rubble.envs.Batch(lambda: CrawlerNav(pile_seeds=range(1, 4)), 64)
        observations, infos = env.reset(seed=3)   # seeds 3, 4, 5, ...
        observations, rewards, terminated, truncated, infos = env.step(env.action_space.sample())

    Environments with the same mission and seeds have each pile in common, which settles once. An environment that has ended
    begins its next episode at its next step, whose action has no effect (AutoresetMode.NEXT_STEP). Results depend on the seeds
    alone, not on `threads`. Each environment stays on one thread.
    """
    metadata = {"autoreset_mode": AutoresetMode.NEXT_STEP}

    def __init__(self, make, count, threads=None):
        """threads: None: all processors."""
        count = whole("count", count, 1)
        threads = min(count, len(os.sched_getaffinity(0)) if threads is None else whole("threads", threads, 1))
        self._workers = [concurrent.futures.ThreadPoolExecutor(1) for _ in range(threads)]
        self.num_envs, self.envs = count, [None] * count
        self._each(lambda i: self.envs.__setitem__(i, make()))
        self.single_action_space, self.single_observation_space = self.envs[0].action_space, self.envs[0].observation_space
        self.action_space = batch_space(self.single_action_space, count)
        self.observation_space = batch_space(self.single_observation_space, count)
        self.render_mode = self.envs[0].render_mode
        self.metadata = {**self.envs[0].metadata, **self.metadata}
        self._ended, self._begun = np.zeros(count, bool), False

    def _each(self, work):
        """[work(0), work(1), ...]"""
        results = [None] * self.num_envs

        def run(first):
            for i in range(first, self.num_envs, len(self._workers)):
                results[i] = work(i)

        # All end before the first mistake is raised.
        runs = [worker.submit(run, first) for first, worker in enumerate(self._workers)]
        concurrent.futures.wait(runs)
        for one in runs:
            one.result()
        return results

    def reset(self, *, seed=None, options=None):
        """seed: of the first environment, and the next numbers of the others; or a list of one for each."""
        try:
            seeds = [None] * self.num_envs if seed is None else [checked_seed(one) for one in seed]
        except TypeError:  # not a list
            first = checked_seed(seed)
            seeds = [first + i for i in range(self.num_envs)]
        if len(seeds) != self.num_envs:
            raise mistake("seed", f"expected a number or a list of {self.num_envs}: found a list of {len(seeds)}")
        results = self._each(lambda i: self.envs[i].reset(seed=seeds[i], options=options))
        self._ended, self._begun = np.zeros(self.num_envs, bool), True
        return self._join([observation for observation, _ in results]), join_infos([info for _, info in results])

    def step(self, actions):
        if not self._begun:
            raise RuntimeError("reset() comes before step()")
        actions = np.asarray(actions)
        if actions.shape[:1] != (self.num_envs,):
            raise mistake("action", f"expected {self.num_envs} rows, one for each environment: found shape {actions.shape}")

        def go(i):
            if not self._ended[i]:
                return self.envs[i].step(actions[i])
            observation, info = self.envs[i].reset()
            return observation, 0.0, False, False, info

        results = self._each(go)
        observations, rewards, terminated, truncated, infos = zip(*results)
        terminated, truncated = np.array(terminated, bool), np.array(truncated, bool)
        self._ended = terminated | truncated
        return self._join(observations), np.array(rewards, float), terminated, truncated, join_infos(infos)

    def render(self):
        return tuple(self._each(lambda i: self.envs[i].render()))

    def _join(self, observations):
        return {name: np.stack([one[name] for one in observations]) for name in self.single_observation_space.spaces}

    def close_extras(self, **_):
        self._each(lambda i: self.envs[i].close())
        for worker in self._workers:
            worker.shutdown()
