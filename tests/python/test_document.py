"""Every block of Python in docs/reference/python.md runs as it is written, one after the other."""
import os
import re
import subprocess
import tempfile
import unittest

import numpy as np

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
MISTAKE = "return rubble.mission {\n  pile = { layer = 2 },\n}\n"


class Document(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.before = os.getcwd()
        os.chdir(self.folder.name)
        os.symlink(os.path.join(ROOT, "scripts"), "scripts")
        with open("mission.lua", "w") as file:
            file.write(MISTAKE)
        for script, out in (("small", "first_pile"), ("lidar", "lidar")):
            subprocess.run([os.environ["RUBBLE_PROGRAM"], "run", f"scripts/{script}.lua", "--quiet",
                            "--out", f"out/{out}"], check=True)

    def tearDown(self):
        os.chdir(self.before)
        self.folder.cleanup()

    def test_blocks_run(self):
        with open(os.path.join(ROOT, "docs", "reference", "python.md")) as file:
            blocks = re.findall(r"^```python\n(.*?)^```", file.read(), re.DOTALL | re.MULTILINE)
        self.assertGreaterEqual(len(blocks), 6)
        # What the text says is the reader's: places to ask about.
        names = {"origins": np.array([[0.0, 0.0, 5.0]]), "directions": np.array([[0.0, 0.0, -1.0]]),
                 "points": np.array([[0.0, 0.0, 5.0]])}
        for block in blocks:
            exec(compile(block, "docs/reference/python.md", "exec"), names)
        self.assertEqual(names["frame"]["rgb"].shape, (480, 640, 3))
        self.assertGreater(len(names["images"]), 0)
        self.assertIn("sample", names, "the session gave samples")
        self.assertGreater(len(names["clouds"]), 0)
        self.assertGreater(names["hits"]["distance"][0], 0)


if __name__ == "__main__":
    unittest.main()
