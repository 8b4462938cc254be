#!/usr/bin/env python3
"""Writes rubble/missions.py: a dataclass for each table of a mission, from the schema that the program prints.

usage: make_missions.py PROGRAM OUTPUT
"""
import json
import keyword
import subprocess
import sys
import textwrap

HEAD = '''"""Missions as Python objects: a class for each table of a mission, with its keys. Written by the build from
`rubble check --schema`; docs/reference/missions.md describes the keys. A key that is not given has the default of the program.
"""
from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal, Mapping, Optional, Sequence, Union

from .mission_text import Keys, MissionText
'''
SCALARS = {"number": "float", "integer": "int", "string": "str", "boolean": "bool", "null": "None"}


def camel(name):
    return "".join(part.capitalize() for part in name.split("_"))


def singular(name):
    if name.endswith("ies"):
        return name[:-3] + "y"
    return name[:-1] if name.endswith("s") and not name.endswith("ss") else name


def use_the_wider_class(properties):
    """`camera` has the class of `cameras`, which has all of its keys and where the camera is; so have others."""
    for key, one in properties.items():
        for part in properties.get(key + "s", {}).get("anyOf", []):
            wide = part.get("additionalProperties")
            for narrow in [one, *one.get("anyOf", [])]:
                keys = narrow.get("properties", {})
                if isinstance(wide, dict) and keys and all(bare(wide["properties"].get(k, {})) == bare(v) for k, v in keys.items()):
                    narrow["properties"] = wide["properties"]


def bare(schema):
    """Without what does not change the class."""
    def strip(part):
        if isinstance(part, dict):
            return {key: strip(value) for key, value in part.items() if key == "properties" or key not in ("description", "default")}
        return [strip(one) for one in part] if isinstance(part, list) else part

    return json.dumps(strip(schema), sort_keys=True)


class Writer:
    def __init__(self):
        self.classes, self.known = [], {}  # texts, in order; names by schema

    def name_of(self, wished, parent, schema):
        key = bare(schema)
        if key in self.known:
            return self.known[key]
        taken = set(self.known.values())
        name = wished if wished not in taken else parent + wished
        if name in taken:
            sys.exit(f"make_missions.py: two tables would be called {name}")
        self.known[key] = name
        self.write_class(name, schema)
        return name

    @staticmethod
    def described(part, whole):
        return {"description": whole.get("description", ""), **part}

    def type_of(self, schema, key, parent):
        """(type as text, classes of parts: how and of what class, or None)."""
        if "anyOf" in schema:
            kinds = [self.type_of(self.described(one, schema), key, parent) for one in schema["anyOf"]]
            texts = list(dict.fromkeys(text for text, _ in kinds if text != "None"))
            part = next((part for _, part in kinds if part), None)
            return (texts[0] if len(texts) == 1 else "Union[" + ", ".join(texts) + "]"), part
        if "enum" in schema:
            return "Literal[" + ", ".join(json.dumps(value) for value in schema["enum"]) + "]", None
        kind = schema.get("type")
        if kind == "array":
            text, part = self.type_of(self.described(schema["items"], schema), singular(key), parent)
            return f"Sequence[{text}]", ("list", part[1]) if part else None
        if kind == "object":
            more = schema.get("additionalProperties")
            if isinstance(more, dict) and not schema.get("properties"):
                text, part = self.type_of(self.described(more, schema), singular(key), parent)
                return f"Mapping[str, {text}]", ("map", part[1]) if part else None
            if set(schema.get("properties", {})) == {"x", "y", "z"}:
                return "Mapping[str, float]", None
            if not schema.get("properties"):
                return "Mapping[str, Any]", None
            name = self.name_of(camel(key), parent, schema)
            return name, ("one", name)
        if kind not in SCALARS:
            sys.exit(f"make_missions.py: {key}: unknown type {kind!r}")
        return SCALARS[kind], None

    def write_class(self, name, schema, base="Keys"):
        lines, parts = [], {}
        for key, value in schema["properties"].items():
            about = value.get("description", "")
            if about.startswith("Another name of "):
                continue
            field = key + "_" if keyword.iskeyword(key) else key
            text, part = self.type_of(value, key, name)
            if part:
                parts[field] = part
            lines += [f"    # {line}" for line in textwrap.wrap(about, 112)]
            lines.append(f"    {field}: Optional[{text}] = None")
        about = schema.get("description", "").replace("\\", "\\\\").replace('"""', "'''") or "Keys of a mission."
        head = textwrap.wrap(about, 112)
        text = [f"@dataclass(kw_only=True)\nclass {name}({base}):", '    """' + "\n    ".join(head) + ('\n    """' if len(head) > 1 else '"""'), ""]
        kept = "{" + ", ".join(f'"{field}": ("{how}", {of})' for field, (how, of) in parts.items()) + "}"
        self.classes.append("\n".join(text + lines) + f"\n\n\n{name}._parts = {kept}\n")


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    program, output = sys.argv[1:]
    schema = json.loads(subprocess.run([program, "check", "--schema"], check=True, stdout=subprocess.PIPE).stdout)
    use_the_wider_class(schema["properties"])
    writer = Writer()
    writer.known["Mission"] = "Mission"
    writer.write_class("Mission", {**schema, "description": "A whole mission. rubble.settle(), run() and batch() take it."}, "MissionText")
    with open(output, "w", encoding="utf-8") as file:
        file.write("\n\n".join([HEAD, *writer.classes]))


if __name__ == "__main__":
    main()
