#!/usr/bin/env python3
"""Tables of the documents and what they were measured from. A comment beside a table states its commit, its command, the
folders that its figures depend on, and a hash of these folders at that commit:

    <!-- measured: COMMIT, COMMAND, folders: kernel render, HASH -->

usage: tools/stale_tables.py [--strict]           lists tables whose folders have changed since; --strict: exit code 1 for any
       tools/stale_tables.py --stamp COMMIT COMMAND FOLDER...   prints the comment of a table that was measured at a commit
"""
import argparse
import hashlib
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
# How files are read in a child, and numbers in tables of text: no figure depends on it.
NEUTRAL = ("kernel/base/system/isolated_worker", "kernel/base/tables/")
MARK = re.compile(r"<!-- measured: ([0-9a-f]{7,40}), (.+?), folders: (.+?), ([0-9a-f]{12}) -->")


def git(*words):
    return subprocess.run(["git", "-C", str(ROOT), *words], check=True, stdout=subprocess.PIPE, text=True).stdout


def digest(blobs):
    """blobs: {path: object name}"""
    lines = ("%s %s\n" % item for item in sorted(blobs.items()) if not item[0].startswith(NEUTRAL))
    return hashlib.sha256("".join(lines).encode()).hexdigest()[:12]


def blobs_at(commit, folders):
    entries = (line.split(None, 3) for line in git("ls-tree", "-r", commit, "--", *folders).splitlines())
    return {path: name for _, _, name, path in entries}


def blobs_now(folders):
    """Of the working tree: tracked files as they are."""
    entries = (line.split(None, 3) for line in git("ls-files", "-s", "--", *folders).splitlines())
    blobs = {path: name for _, name, _, path in entries}
    for path in git("diff", "--name-only", "--", *folders).splitlines():
        blobs.pop(path, None)
        if (ROOT / path).exists():
            blobs[path] = git("hash-object", path).strip()
    return blobs


def stamp(command, folders, commit=None):
    """The comment, with the end of its line. commit: not given: of the working tree."""
    blobs = blobs_at(commit, folders) if commit else blobs_now(folders)
    if not blobs:
        sys.exit("no files in %s at %s" % (" ".join(folders), commit or "the working tree"))
    return "<!-- measured: %s, %s, folders: %s, %s -->\n" % (
        git("rev-parse", commit or "HEAD").strip()[:8], command, " ".join(folders), digest(blobs))


def stamp_again(text, commit=None):
    """The comment of a table that is measured anew: that of its old text, with today's commit and hash; "" without one.
    Without git the old one stays, and the table counts as stale."""
    found = MARK.search(text)
    if not found:
        return ""
    try:
        return stamp(found[2], found[3].split(), commit)
    except (OSError, subprocess.CalledProcessError):
        return found[0] + "\n"


def caption(found):
    """What a reader should know of a table. found: a match of MARK."""
    commit, command, folders, kept = found.groups()
    text = "Measured at commit %s by `%s`." % (commit, command)
    if (ROOT / ".git").exists() and digest(blobs_now(folders.split())) != kept:
        text += " The code that it depends on (%s) has changed since." % ", ".join("`%s`" % f for f in folders.split())
    return text


def find_stale():
    """All marks, and a sentence for each stale one."""
    marks, stale = 0, []
    for path in [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]:
        for number, line in enumerate(path.read_text().splitlines(), 1):
            for commit, command, folders, kept in MARK.findall(line):
                marks += 1
                if digest(blobs_now(folders.split())) != kept:
                    stale.append("%s:%d: measured at %s; changed since: %s; again: %s" % (
                        path.relative_to(ROOT), number, commit, folders, command))
    return marks, stale


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--strict", action="store_true")
    parser.add_argument("--stamp", nargs="+", metavar="WORD")
    options = parser.parse_args()
    if not (ROOT / ".git").exists():
        print("tables of the documents: no git history here, not checked")
        return 1 if options.strict else 0
    if options.stamp:
        if len(options.stamp) < 3:
            parser.error("--stamp: expected COMMIT COMMAND FOLDER...")
        commit, command, *folders = options.stamp
        print(stamp(command, folders, commit), end="")
        return 0
    marks, stale = find_stale()
    for sentence in stale:
        print("stale table: " + sentence)
    print("%d tables of the documents state what they were measured from; %d are stale" % (marks, len(stale)))
    return 1 if stale and options.strict else 0


if __name__ == "__main__":
    sys.exit(main())
