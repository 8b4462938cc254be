#!/usr/bin/env python3
"""Measures how the code is written: the length of files and functions, include cycles, comments, and
how many members of headers say what they mean. docs/development/contributing.md shows the table.

usage: tools/style_table.py [--members] [folders...]   (default: kernel render io scripting app)
    --members: lists the header members that have no comment, too
"""
import os
import re
import statistics
import subprocess
import sys

CONTROL = re.compile(r"^\s*(else\s+)?(if|for|while|switch|catch|do|else|try)\b")


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def list_files(folders):
    names = subprocess.run(["git", "ls-files", "--cached", "--others", "--exclude-standard", *folders],
                           check=True, capture_output=True, text=True).stdout.split("\n")
    return [name for name in names if name.endswith((".h", ".cpp")) and os.path.exists(name)]


def blank_out(text):
    """The text with comments and literals as spaces, so that braces and lines stay where they are."""
    pattern = re.compile(r'R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|(?<![0-9A-Fa-f])\'(?:\\.|[^\'\\\n])*\''
                         r"|//[^\n]*|/\*.*?\*/", re.S)
    return pattern.sub(lambda m: re.sub(r"[^\n]", " ", m.group(0)), text)


def function_lengths(text):
    """Lines from the first of the head to the closing brace, of every function that has a body."""
    text = re.sub(r"^[ \t]*#.*$", "", blank_out(text), flags=re.M)
    lengths, stack, head = [], [], 0
    for i, c in enumerate(text):
        if c == "{":
            before = text[head:i].strip()
            inside = any(kind == "function" for kind, _ in stack)
            body = re.search(r"\)\s*(const|noexcept|override|final|mutable|->[^;{}]*|:[^;{}]*|\s)*$", before)
            kind = "block"
            if not inside and body and not CONTROL.match(before) and "=" not in before.split("(")[0]:
                kind = "function"
            start = head + len(text[head:i]) - len(text[head:i].lstrip())
            stack.append((kind, start))
            head = i + 1
        elif c == "}":
            if stack:
                kind, start = stack.pop()
                if kind == "function":
                    lengths.append(text.count("\n", start, i) + 1)
            head = i + 1
        elif c == ";":
            head = i + 1
    return lengths


def count_cycles(files):
    known = set(files)
    graph = {f: [t for t in re.findall(r'^#include "([^"]+)"', read(f), re.M) if t in known] for f in files}
    state, cycles = {}, 0

    def visit(node):
        nonlocal cycles
        state[node] = 1
        for other in graph[node]:
            if state.get(other) == 1:
                cycles += 1
            elif other not in state:
                visit(other)
        state[node] = 2

    sys.setrecursionlimit(10000)
    for file in files:
        if file not in state:
            visit(file)
    return cycles


def members_of(path):
    """(line number, declaration, whether it has a comment) of the data members of a header."""
    text = read(path)
    raw, plain = text.split("\n"), blank_out(text).split("\n")
    members, depth, outer = [], [], []  # depth: kinds of the open braces; outer: whether private there
    private = False
    for number, (line, code) in enumerate(zip(raw, plain), 1):
        if re.match(r"\s*(private|protected):", code):
            private = True
        if re.match(r"\s*public:", code):
            private = False
        statement = code.strip()
        in_type = bool(depth) and depth[-1] in ("struct", "class")
        is_member = in_type and not private and re.match(
            r"^[A-Za-z_:][\w:<>,*&\s\[\]]*\s[\w\[\], ]+(\s*=[^;]*|\{[^;]*\})?(\s*,[^;()]*)?;$", statement)
        head = re.split(r"[={]", statement)[0]
        # The end of a parameter list and `operator=(...) = delete` are no members.
        whole = statement.count("(") == statement.count(")") and "operator" not in statement
        if is_member and whole and "(" not in head and not re.match(
                r"(using|typedef|friend|return|static|struct|class|enum|template|public|private)\b", statement):
            above = raw[number - 2].strip() if number > 1 else ""
            members.append((number, statement, "//" in line or above.startswith("//")))
        for at, c in enumerate(code):
            if c == "{":
                before = code[:at]
                kind = "other"
                for word in ("struct", "class"):
                    if re.search(r"\b" + word + r"\s+\w+", before) and "enum" not in before and "(" not in before:
                        kind = word
                outer.append(private)
                private = private or kind == "class"
                depth.append(kind)
            elif c == "}" and depth:
                depth.pop()
                private = outer.pop()
    return members


def main():
    show = "--members" in sys.argv
    folders = [a for a in sys.argv[1:] if not a.startswith("--")]
    folders = folders or ["kernel", "render", "io", "scripting", "app"]
    files = list_files(folders)
    headers = [f for f in files if f.endswith(".h")]
    sources = [f for f in files if f.endswith(".cpp")]
    lines = {f: read(f).count("\n") for f in files}
    functions = [(n, f) for f in files for n in function_lengths(read(f))]
    comments = sum(1 for f in files for line in read(f).split("\n") if "//" in line and line.strip())
    filled = sum(1 for f in files for line in read(f).split("\n") if line.strip())
    tests = sum(read(f).count("\n") for f in list_files(["tests"]))
    members = [(f, *m) for f in headers for m in members_of(f)]
    said = sum(1 for m in members if m[3])
    rooms = {}
    for f in files:
        rooms[os.path.dirname(f)] = rooms.get(os.path.dirname(f), 0) + 1
    largest_room = max(rooms, key=rooms.get)
    largest_header = max(headers, key=lines.get)
    largest_source = max(sources, key=lines.get)
    longest = max(functions)
    rows = [
        ("headers; lines, median and largest", f"{len(headers)}; {statistics.median(lines[f] for f in headers):.0f}"
         f" and {lines[largest_header]} ({largest_header})"),
        ("sources; lines, median and largest", f"{len(sources)}; {statistics.median(lines[f] for f in sources):.0f}"
         f" and {lines[largest_source]} ({largest_source})"),
        ("functions; lines, median and largest", f"{len(functions)}; "
         f"{statistics.median(n for n, _ in functions):.0f} and {longest[0]} ({longest[1]})"),
        ("functions longer than 20 lines", f"{100 * sum(n > 20 for n, _ in functions) / len(functions):.0f} %"),
        ("largest folder, files", f"{rooms[largest_room]} ({largest_room})"),
        ("include cycles", str(count_cycles(files))),
        ("lines with a comment", f"{100 * comments / filled:.0f} %"),
        ("members of headers with a comment", f"{100 * said / len(members):.0f} % of {len(members)}"),
        ("lines of tests, relative to the code", f"{100 * tests / sum(lines.values()):.0f} %"),
    ]
    print("| of `" + "`, `".join(folders) + "` | |\n|---|---|")
    for name, value in rows:
        print(f"| {name} | {value} |")
    if show:
        for file, number, declaration, has in members:
            if not has:
                print(f"{file}:{number}: {declaration}")


if __name__ == "__main__":
    main()
