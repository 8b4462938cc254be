#!/usr/bin/python3
"""What dpkg-shlibdeps would say of a program for another processor: prints the packages that its libraries are in, with the
versions that these packages' `shlibs` files ask for (Debian Policy 8.6.4), for the field Depends.

usage: tools/package/library_depends.py PROGRAM PACKAGE.deb...
"""
import re
import subprocess
import sys


def run(*words):
    return subprocess.run(words, check=True, stdout=subprocess.PIPE, text=True).stdout


def read_shlibs(package):
    """{(library, version): what depends on it} of a package."""
    if "./shlibs" not in run("sh", "-c", 'dpkg-deb --ctrl-tarfile "$0" | tar -t', package).split():
        return {}
    found = {}
    for line in run("dpkg-deb", "-I", package, "shlibs").splitlines():
        words = line.split(maxsplit=2)
        if len(words) == 3 and not words[0].endswith(":"):
            found[words[0], words[1]] = words[2].strip()
    return found


def split_soname(soname):
    """libfoo.so.3 and libfoo-3.so as shlibs files name them."""
    match = re.fullmatch(r"(.+)\.so\.(.+)", soname) or re.fullmatch(r"(.+)-([\d.]+)\.so", soname)
    return match.groups() if match else None


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    known = {}
    for package in sys.argv[2:]:
        known.update(read_shlibs(package))
    needed = re.findall(r"\(NEEDED\).*\[(.+)\]", run("readelf", "-d", sys.argv[1]))
    unknown = [name for name in needed if split_soname(name) not in known and not name.startswith("ld-linux")]
    if unknown:
        sys.exit("no package says who has " + ", ".join(unknown))
    print(", ".join(sorted({known[split_soname(name)] for name in needed if not name.startswith("ld-linux")})))


if __name__ == "__main__":
    main()
