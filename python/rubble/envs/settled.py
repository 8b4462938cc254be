"""Piles of missions that are texts."""
import tempfile

from .. import _core


def settle_text(mission, seed, threads):
    with tempfile.NamedTemporaryFile("w", suffix=".lua") as script:
        script.write(mission)
        script.flush()
        return _core.settle(script.name, seed, [], threads)
