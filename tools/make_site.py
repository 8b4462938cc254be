#!/usr/bin/env python3
"""Gathers the documents as the sources of a site, with every link checked and led within it:
README.md becomes its first page, docs/ the others, and files of the tree that a page links to are
copied. What a measured table is of (stale_tables.py) stands above it. `make site` then runs mkdocs on them.

usage: tools/make_site.py FOLDER     # made anew; exit code 1 names each link that leads nowhere
"""
import os
import re
import shutil
import sys

import stale_tables

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
PAGES = {"README.md": "index.md", "assets/README.md": "assets.md", "CHANGELOG.md": "changelog.md"}
LINK = re.compile(r"(!?\[[^\]]*\])\(([^()\s]+)\)")
# A list right below a sentence: mkdocs wants an empty line between.
LIST = re.compile(r"^((?!- |\d+\. |#)\S[^\n]*)\n(?=- |\d+\. )", re.M)
CODE = re.compile(r"(^```[\s\S]*?^```$|^    [^\n]*$)", re.M)


def page_of(path):
    """The name in the site of a document of the tree; None: it is no page."""
    if path in PAGES:
        return PAGES[path]
    return path[len("docs/"):] if path.startswith("docs/") and path.endswith(".md") else None


def slug(heading):
    text = re.sub(r"[`*_]", lambda m: "_" if m.group() == "_" else "", heading.strip().lower())
    return re.sub(r"[-\s]+", "-", re.sub(r"[^\w\s-]", "", text))


def anchors_of(path):
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        return {slug(h) for h in re.findall(r"^#+ +(.*)$", file.read(), re.M)}


class Site:
    def __init__(self, folder):
        self.folder, self.broken = folder, []

    def lead(self, path, target):
        """The link as it is written in the site; None: only its text stays."""
        if re.match(r"[a-z]+:", target):
            return target
        name, _, anchor = target.partition("#")
        to = os.path.normpath(os.path.join(os.path.dirname(path), name)) if name else path
        if not os.path.exists(os.path.join(ROOT, to)):
            self.broken.append(f"{path}: {target} leads nowhere")
            return None
        page, here = page_of(to), os.path.dirname(page_of(path)) or "."
        if page:
            if anchor and anchor not in anchors_of(to):
                self.broken.append(f"{path}: {target}: no such heading in {to}")
            return (os.path.relpath(page, here) if name else "") + ("#" + anchor if anchor else "")
        if os.path.isdir(os.path.join(ROOT, to)):
            return None
        own = to[len("docs/"):] if to.startswith("docs/") else "files/" + to
        copy = os.path.join(self.folder, own)
        os.makedirs(os.path.dirname(copy), exist_ok=True)
        shutil.copyfile(os.path.join(ROOT, to), copy)
        return os.path.relpath(own, here)

    def add(self, path):
        with open(os.path.join(ROOT, path), encoding="utf-8") as file:
            text = file.read()

        def replace(match):
            to = self.lead(path, match.group(2))
            return f"{match.group(1)}({to})" if to else match.group(1).lstrip("!")[1:-1]
        text = stale_tables.MARK.sub(lambda mark: f"\n*{stale_tables.caption(mark)}*\n", text)
        parts = CODE.split(text)  # code is every second part
        parts[::2] = [LIST.sub(r"\1\n\n", LINK.sub(replace, part)) for part in parts[::2]]
        page = os.path.join(self.folder, page_of(path))
        os.makedirs(os.path.dirname(page), exist_ok=True)
        with open(page, "w", encoding="utf-8") as file:
            file.write("".join(parts))


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    site = Site(sys.argv[1])
    shutil.rmtree(site.folder, ignore_errors=True)
    os.makedirs(site.folder)
    documents = sorted(PAGES) + sorted(os.path.relpath(os.path.join(folder, name), ROOT)
                                       for folder, _, names in os.walk(os.path.join(ROOT, "docs"))
                                       for name in names if name.endswith(".md"))
    for path in documents:
        site.add(path)
    shutil.copyfile(os.path.join(ROOT, "tools", "site.css"), os.path.join(site.folder, "site.css"))
    for sentence in site.broken:
        print(sentence, file=sys.stderr)
    return 1 if site.broken else 0


if __name__ == "__main__":
    sys.exit(main())
