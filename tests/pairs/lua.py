"""Lua source of Python values."""


class Lua(str):
    """An expression that is written as it is."""


def to_lua(value, indent=1):
    if isinstance(value, Lua):
        return str(value)
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, (list, tuple)):
        return "{ " + ", ".join(to_lua(item, indent) for item in value) + " }"
    pad = "  " * indent
    lines = ["%s%s = %s,\n" % (pad, name, to_lua(item, indent + 1)) for name, item in value.items()]
    return "{\n" + "".join(lines) + "  " * (indent - 1) + "}"


def put(table, path, value):
    """Sets table["a"]["b"] for the path "a.b"; a table is merged with what is there."""
    *folders, last = path.split(".")
    for folder in folders:
        table = table.setdefault(folder, {})
    if isinstance(value, dict) and isinstance(table.get(last), dict):
        for name, item in value.items():
            put(table[last], name, item)
    else:
        table[last] = value
