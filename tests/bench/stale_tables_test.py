#!/usr/bin/python3
"""tools/stale_tables.py in a small tree of its own: what it finds, and what it does not."""
import pathlib
import shutil
import subprocess
import sys
import tempfile

TOOLS = pathlib.Path(__file__).resolve().parent.parent.parent / "tools"


def run(root, *command):
    done = subprocess.run([str(word) for word in command], cwd=root, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    return done.returncode, done.stdout


def check(root, *options):
    return run(root, sys.executable, "tools/stale_tables.py", *options)


def shown_in_site(root):
    """The page as readers get it."""
    code, text = run(root, sys.executable, "tools/make_site.py", "site")
    assert code == 0, text
    return (root / "site" / "page.md").read_text()


def main():
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name in ("tools", "docs", "kernel", "io", "assets"):
            (root / name).mkdir()
        for name in ("stale_tables.py", "document_marks.py", "make_site.py", "site.css"):
            shutil.copy(TOOLS / name, root / "tools")
        for name in ("README.md", "CHANGELOG.md", "assets/README.md"):
            (root / name).write_text("# Tree\n")
        (root / "kernel" / "a.cpp").write_text("int a;\n")
        (root / "io" / "b.cpp").write_text("int b;\n")
        git = ["git", "-c", "user.name=t", "-c", "user.email=t@example.org"]
        run(root, "git", "init", "-q")
        run(root, "git", "add", ".")
        run(root, *git, "commit", "-q", "-m", "Add")
        code, mark = check(root, "--stamp", "HEAD", "bench/x", "kernel")
        assert code == 0 and mark.startswith("<!-- measured: "), mark
        page = root / "docs" / "page.md"
        page.write_text("<!-- begin x -->\n" + mark + "| 1 |\n<!-- end x -->\n")
        assert check(root, "--strict")[0] == 0, check(root)
        shown = shown_in_site(root)
        assert "*Measured at commit " in shown and "by `bench/x`.*" in shown, shown
        (root / "io" / "b.cpp").write_text("int c;\n")  # it does not depend on this
        assert check(root, "--strict")[0] == 0, check(root)
        (root / "kernel" / "a.cpp").write_text("int d;\n")
        code, text = check(root, "--strict")
        assert code == 1 and "docs/page.md:2" in text and "again: bench/x" in text, text
        assert check(root)[0] == 0  # a warning
        assert "has changed since" in shown_in_site(root)
        # Whoever writes the table anew states what it was measured from.
        code, text = run(root, sys.executable, "-c", "import sys; sys.path.insert(0, 'tools'); import document_marks as d; "
                         "d.write_between_marks('docs/page.md', 'x', '| 2 |\\n')")
        assert code == 0, text
        assert "| 2 |" in page.read_text() and check(root, "--strict")[0] == 0, page.read_text()
        (root / "kernel" / "a.cpp").unlink()
        assert check(root, "--strict")[0] == 1
        assert check(root, "--stamp", "HEAD", "x", "nothing")[0] != 0


if __name__ == "__main__":
    main()
