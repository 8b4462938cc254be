"""train_nightly.py goes on where it stopped, begins anew for other sources, and says what learned; its trainings are stand-ins."""
import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

HERE = Path(__file__).resolve().parent

# Trains SECONDS at once; its policies are better than chance by 3 in CrawlerNav alone.
STAND_IN = """#!/usr/bin/env python3
import json, sys
from pathlib import Path
if sys.argv[1] == "-m":
    sys.exit(0)
what, name, seed, folder, seconds = sys.argv[2:]
folder = Path(folder)
folder.mkdir(exist_ok=True)
state = folder / "state.json"
used = json.loads(state.read_text())["seconds"] if state.exists() else 0
if what == "train":
    state.write_text(json.dumps({"seconds": used + float(seconds), "steps": 100}))
    with open(folder / "curve.csv", "a") as file:
        file.write(f"100,{used + float(seconds)},40,1.5\\n")
else:
    better = 3 if what == "measure" and name == "CrawlerNav" else 0
    (folder / "result.json").write_text(json.dumps({"steps": 100, "returns": [better + 0.1 * int(seed), better + 0.2]}))
"""


class TrainNightly(unittest.TestCase):
    def setUp(self):
        self._folder = tempfile.TemporaryDirectory()
        self.folder = Path(self._folder.name)
        self.python = self.folder / "python"
        self.python.write_text(STAND_IN)
        self.python.chmod(0o755)
        (self.folder / "build/python/rubble/envs").mkdir(parents=True)

    def tearDown(self):
        self._folder.cleanup()

    def call(self, *options):
        return subprocess.run([sys.executable, HERE / "train_nightly.py", self.folder / "build", self.folder / "work", "--python", self.python,
                               "--seeds", "2", "--environments", "CrawlerNav,SnakeExplore", *options], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)

    def trained(self, name):
        return json.loads((self.folder / f"work/trained/{name}/state.json").read_text())["seconds"]

    def test_it_goes_on_where_it_stopped(self):
        first = self.call("--budget", "1")
        self.assertEqual(first.returncode, 77, first.stdout)
        self.assertIn("0 of 4 trainings are complete; CrawlerNav, seed 1 has trained for 0 of 40 minutes", first.stdout)
        self.python.write_text(STAND_IN.replace("used = json", "sys.exit(1) if state.exists() else 0; used = json"))
        self.assertEqual(self.call("--budget", "2").returncode, 1)
        self.assertAlmostEqual(self.trained("CrawlerNav_1"), 90, delta=5)
        self.python.write_text(STAND_IN)
        last = self.call()
        self.assertEqual(last.returncode, 0, last.stdout)
        self.assertAlmostEqual(self.trained("CrawlerNav_1"), 2400, places=3)
        self.assertEqual((self.folder / "work/trained/CrawlerNav_1/curve.csv").read_text().count("\n"), 2)
        self.assertIn("|`CrawlerNav`|100 to 100|3.18 ± 0.02|0.10 ± 0.10|yes|", last.stdout)
        self.assertIn("|`SnakeExplore`|100 to 100|0.18 ± 0.02|0.10 ± 0.10|no|", last.stdout)
        self.assertEqual((self.folder / "work/curves.svg").read_text().count("<polyline"), 6)

    def test_it_writes_into_a_document(self):
        (self.folder / "docs/pictures").mkdir(parents=True)
        (self.folder / "docs/development").mkdir()
        document = self.folder / "docs/development/robots.md"
        document.write_text("before\n<!-- begin learning -->\nold\n<!-- end learning -->\nafter\n")
        ran = self.call("--minutes", "1.5", "--write", document)
        self.assertEqual(ran.returncode, 0, ran.stdout)
        self.assertIn("1.5 min", document.read_text())
        self.assertNotIn("old", document.read_text())
        self.assertIn("CrawlerNav", (self.folder / "docs/pictures/learning.svg").read_text())

    def test_other_sources_begin_anew(self):
        self.call()
        (self.folder / "build/python/rubble/envs/new.py").write_text("")
        self.assertEqual(self.call("--budget", "1").returncode, 77)
        self.assertFalse((self.folder / "work/trained/CrawlerNav_2").exists())

    def test_an_environment_that_should_learn_and_does_not_fails(self):
        self.python.write_text(STAND_IN.replace("better = 3", "better = -3"))
        ran = self.call()
        self.assertEqual(ran.returncode, 1, ran.stdout)


if __name__ == "__main__":
    unittest.main()
