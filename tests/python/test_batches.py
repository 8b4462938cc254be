"""rubble.batch: the table of `rubble batch`, whoever starts the runs and wherever the results go."""
import os
import subprocess
import tempfile
import unittest
from concurrent.futures import Future, ThreadPoolExecutor

import rubble
from rubble.program import find_program

MISSION = "return rubble.mission { pile = { layers = 1, pieces_per_layer = 3 } }"


def read(path):
    with open(path, "rb") as file:
        return file.read()


class Refusing:
    """An executor none of whose runs may be started."""

    def submit(self, work, *given):
        raise AssertionError("a run was started again")


class OnThisMachine(unittest.TestCase):
    def setUp(self):
        self.folder = self.enterContext(tempfile.TemporaryDirectory())

    def test_it_gives_the_table_of_the_program(self):
        script = os.path.join(self.folder, "mission.lua")
        with open(script, "w") as file:
            file.write(MISSION)
        ours, theirs = (os.path.join(self.folder, name) for name in ("ours", "theirs"))
        words = ["--seeds", "2", "--vary", "wetness=0,0.5", "--pile-only", "--quiet"]
        subprocess.run([find_program(), "batch", script, *words, "--out", theirs], check=True, stdout=subprocess.DEVNULL)
        with rubble.batch(script, "2", ours, vary=["wetness=0,0.5"], settle=True) as batch:
            self.assertEqual(list(batch.futures), ["v1_seed_2", "v2_seed_2"])
            self.assertEqual({future.result() for future in batch.futures.values()}, {"done"})
        self.assertEqual(read(os.path.join(ours, "index.csv")), read(os.path.join(theirs, "index.csv")))
        # Either of them continues what the other began, and there is nothing left to do.
        rows = rubble.batch(script, "2", theirs, vary=["wetness=0,0.5"], settle=True, executor=Refusing()).result()
        self.assertEqual([row["status"] for row in rows], ["done"] * 2)
        with self.assertRaisesRegex(rubble.InputError, "another batch"):
            rubble.batch(script, "2..3", ours, settle=True, executor=Refusing())

    def test_a_run_that_fails_is_tried_again(self):
        out = os.path.join(self.folder, "out")
        os.makedirs(os.path.join(out, "seed_2"))
        with open(os.path.join(out, "seed_2", "in_the_way"), "w"):
            pass
        batch = rubble.batch(MISSION, [1, 2], out, settle=True)
        with self.assertRaisesRegex(rubble.InputError, "seed_2"):
            batch.futures["seed_2"].result()
        self.assertEqual([row["status"] for row in batch.result()], ["done", "failed"])
        os.remove(os.path.join(out, "seed_2", "in_the_way"))
        self.assertEqual([row["status"] for row in rubble.batch(MISSION, [1, 2], out, settle=True).result()], ["done", "done"])

    def test_seeds_are_whole_numbers(self):
        for seeds in ([1.7], [1, -1], ["1"], [True]):
            with self.assertRaises(rubble.InputError, msg=repr(seeds)) as raised:
                rubble.batch(MISSION, seeds, os.path.join(self.folder, "out"), settle=True, executor=Refusing())
            self.assertEqual(raised.exception.key, "seeds")

    def test_results_go_to_any_file_system(self):
        try:
            import fsspec
        except ImportError:
            with self.assertRaisesRegex(rubble.InputError, "pip install fsspec"):
                rubble.batch(MISSION, [1], "memory://batch")
            self.skipTest("fsspec is not there")
        with ThreadPoolExecutor(2) as pool:
            rows = rubble.batch(MISSION, "1..2", "memory://batch", settle=True, executor=pool).result()
        self.assertEqual([row["status"] for row in rows], ["done", "done"])
        rubble.batch(MISSION, "1..2", os.path.join(self.folder, "here"), settle=True).result()
        files = fsspec.filesystem("memory")
        self.assertEqual(files.cat_file("/batch/index.csv"), read(os.path.join(self.folder, "here", "index.csv")))
        files.rm_file("/batch/seed_2/manifest.json")
        begun = []

        class Counting:
            def submit(self, work, job):
                begun.append(job["name"])
                future = Future()
                future.set_result(work(job))
                return future

        rubble.batch(MISSION, "1..2", "memory://batch", settle=True, executor=Counting()).result()
        self.assertEqual(begun, ["seed_2"])


if __name__ == "__main__":
    unittest.main()
