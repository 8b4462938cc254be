#!/usr/bin/env python3
"""Makes libraries that stand in for some of which other libraries take names, but call nothing here: each function ends the
process with a message. So a wheel does not carry what those libraries need in turn.

usage: stub_library.py PROGRAM FOLDER NAME...   writes FOLDER/SONAME for each library NAME (libGLU) that the program loads
"""
import functools
import os
import re
import subprocess
import sys
import tempfile


@functools.lru_cache(None)
def run(*words):
    return subprocess.run(words, check=True, stdout=subprocess.PIPE, text=True).stdout


def symbols(path, which):
    """{name: (version, kind, size)} of what a library defines or wants."""
    found = {}
    for line in run("readelf", "--dyn-syms", "--wide", path).splitlines():
        words = line.split()
        if len(words) < 8 or not words[0][:-1].isdigit() or words[4] == "LOCAL" or (words[6] == "UND") != (which == "wanted"):
            continue
        name, _, version = words[7].partition("@")
        found[name] = (version.lstrip("@"), words[3], int(words[2], 0))
    return found


def write_stub(soname, taken, folder):
    """taken: {name: (version, kind, size)}."""
    text = ["#include <stdio.h>", "#include <stdlib.h>",
            "static void stop(const char* name) {",
            f'  fprintf(stderr, "rubble: this wheel has no {soname}, of which %s was called\\n", name);', "  abort();", "}"]
    versions = {}
    for name, (version, kind, size) in sorted(taken.items()):
        versions.setdefault(version, []).append(name)
        # Lists of virtual functions and types are only pointed to.
        text.append(f'void {name}(void) {{ stop("{name}"); }}' if kind in ("FUNC", "IFUNC", "NOTYPE") else f"char {name}[{max(size, 8)}];")
    with tempfile.TemporaryDirectory() as work:
        source, script = os.path.join(work, "stub.c"), os.path.join(work, "stub.map")
        with open(source, "w") as file:
            file.write("\n".join(text) + "\n")
        with open(script, "w") as file:
            for version, names in versions.items():
                file.write((version + " " if version else "") + "{ global: " + " ".join(n + ";" for n in names) + " };\n")
        scripted = ["-Wl,--version-script=" + script] if any(versions) else []
        subprocess.run(["gcc", "-shared", "-fPIC", "-w", "-fno-builtin", "-Wl,-soname," + soname, *scripted, source, "-o",
                        os.path.join(folder, soname)], check=True)


def main():
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    program, folder, *names = sys.argv[1:]
    loaded = sorted(set(re.findall(r"=> (/\S+) ", run("ldd", program))))
    for library in loaded:
        if os.path.basename(library).split(".so")[0] not in names:
            continue
        soname = re.search(r"\(SONAME\).*\[(.+)\]", run("readelf", "-d", library)).group(1)
        there, taken = symbols(library, "defined"), {}
        for user in [program, *loaded]:
            if f"Shared library: [{soname}]" in run("readelf", "-d", user):
                taken.update({name: there[name] for name in symbols(user, "wanted") if name in there})
        write_stub(soname, taken, folder)


if __name__ == "__main__":
    main()
