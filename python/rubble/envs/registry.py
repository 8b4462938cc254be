"""Tells gymnasium of Rubble's environments. Gymnasium 1 asks no installed package for its own: users import rubble.envs, or
name it, as in gymnasium.make("rubble.envs:rubble/VoidExplore-v0")."""
import functools

STEPS = {"CrawlerNav": 600, "SnakeExplore": 600, "VoidExplore": 500}


def make_batch(name, num_envs, max_episode_steps, batch_threads=None, **options):
    """What gymnasium.make_vec() gives without another vectorization_mode: a rubble.envs.Batch on `batch_threads` threads."""
    from rubble import envs

    return envs.Batch(lambda: getattr(envs, name)(**{**options, "max_steps": max_episode_steps}), num_envs, batch_threads)


def register():
    from gymnasium.envs.registration import register as add, registry

    for name, steps in STEPS.items():
        if f"rubble/{name}-v0" not in registry:
            # gymnasium's own limit ends episodes, so that max_episode_steps of make() holds.
            add(id=f"rubble/{name}-v0", entry_point=f"rubble.envs:{name}", max_episode_steps=steps, kwargs={"max_steps": None},
                vector_entry_point=functools.partial(make_batch, name))
