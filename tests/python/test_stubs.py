"""rubble/_core.pyi has the names of the module, and the package says that it is typed."""
import ast
import importlib
import os
import re
import tomllib
import unittest

import rubble
from rubble import _core

HERE = os.path.dirname(rubble.__file__)


def members(body):
    """{name: members, of a class} of what a stub defines."""
    found = {}
    for one in body:
        if isinstance(one, (ast.FunctionDef, ast.ClassDef)):
            found.setdefault(one.name, members(one.body) if isinstance(one, ast.ClassDef) else {})
        elif isinstance(one, ast.AnnAssign):
            found[one.target.id] = {}
    return found


class Stubs(unittest.TestCase):
    def test_name_what_the_module_has(self):
        with open(os.path.join(HERE, "_core.pyi")) as file:
            stub = members(ast.parse(file.read()).body)
        there = {name for name in vars(_core) if not name.startswith("__")} | {"__version__"}
        self.assertEqual(set(stub), there)
        for name, inside in stub.items():
            kind = getattr(_core, name)
            if isinstance(kind, type) and not issubclass(kind, Exception):
                own = {n for n in vars(kind) if not n.startswith("__") or n in ("__len__", "__init__") and n in inside}
                self.assertEqual(set(inside) - {"__init__"}, own - {"__init__"}, name)

    def test_the_package_is_typed(self):
        self.assertTrue(os.path.exists(os.path.join(HERE, "py.typed")))
        for name in rubble.__all__:
            self.assertTrue(hasattr(rubble, name), name)

    def test_the_metadata_name_what_is_there(self):
        with open("pyproject.toml", "rb") as file:
            about = tomllib.load(file)
        with open(about["tool"]["dynamic-metadata"][0]["input"]) as file:
            found = re.search(about["tool"]["dynamic-metadata"][0]["regex"], file.read())
        self.assertEqual(found["value"], rubble.__version__)
        for place in about["project"]["scripts"].values():
            module, name = place.split(":")
            self.assertTrue(callable(getattr(importlib.import_module(module), name)), place)
        with open("python/requirements.txt") as file:
            locked = re.search(r"^nanobind==\S+", file.read(), re.M).group()
        self.assertIn(locked, about["build-system"]["requires"])


if __name__ == "__main__":
    unittest.main()
