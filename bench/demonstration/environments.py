"""Virtual environments of locked packages from PyPI, each made once."""
import shutil
import subprocess
import sys


class NoIndex(Exception):
    """The packages of a list cannot be had here."""


def environment(folder, requirements):
    """The Python of the packages of `requirements`, a list with versions and hashes; made anew when the list changes."""
    python, stamp, lock = folder / "bin" / "python", folder / "installed.txt", requirements.read_text()
    if stamp.exists() and stamp.read_text() == lock:
        return python
    shutil.rmtree(folder, ignore_errors=True)
    # The Python of Debian lacks ensurepip unless python3-venv is there.
    subprocess.run([sys.executable, "-m", "venv", folder], check=True)
    done = subprocess.run([python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--require-hashes", "--no-deps",
                           "--only-binary=:all:", "-r", requirements], stderr=subprocess.PIPE, text=True)
    if done.returncode:
        shutil.rmtree(folder, ignore_errors=True)
        raise NoIndex("the packages of %s cannot be installed here: %s" % (requirements, done.stderr.strip()[-300:]))
    stamp.write_text(lock)
    return python
