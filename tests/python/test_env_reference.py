"""docs/reference/environments.md is what tools/environments_page.py makes of the environments."""
import importlib.util
import json
import os
import re
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


def load_tool():
    spec = importlib.util.spec_from_file_location("environments_page", os.path.join(ROOT, "tools", "environments_page.py"))
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


class Reference(unittest.TestCase):
    def test_document_is_up_to_date(self):
        with open(os.path.join(ROOT, "docs", "reference", "environments.md")) as file:
            self.assertEqual(file.read(), load_tool().make_page(),
                             "run: cmake --build build/release --target environments_reference")

    def test_blocks_of_python_run(self):
        with open(os.path.join(ROOT, "docs", "reference", "environments.md")) as file:
            blocks = re.findall(r"^```python\n(.*?)^```", file.read(), re.DOTALL | re.MULTILINE)
        self.assertEqual(len(blocks), 3)
        before = os.getcwd()
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            try:
                for block in blocks:
                    exec(compile(block, "docs/reference/environments.md", "exec"), {})
            finally:
                os.chdir(before)
            with open("%s/out/episodes/meta/info.json" % folder) as file:
                self.assertEqual(json.load(file)["total_episodes"], 2)

    def test_entries_that_do_not_exist_are_refused(self):
        tool = load_tool()
        tool.check_names("x", "Observation", ["depth"], {"depth": 0})
        for described in ([], ["depth", "dept"]):
            with self.assertRaisesRegex(ValueError, "describes"):
                tool.check_names("x", "Observation", described, {"depth": 0})

    def test_docstrings_without_their_form_are_refused(self):
        tool = load_tool()
        with self.assertRaisesRegex(ValueError, "no section"):
            tool.parse("x/Y-v0: a title.\n\nAction:\n  0  forwards\n")
        with self.assertRaisesRegex(ValueError, "expected lines"):
            tool.parse("x/Y-v0: a title.\n\nAction:\n  forwards\n")


if __name__ == "__main__":
    unittest.main()
