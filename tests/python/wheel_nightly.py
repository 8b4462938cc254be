#!/usr/bin/env python3
"""Makes the wheels and installs each into new environments, as users do: wheel_nightly.py BUILD_FOLDER WORK

Every Python that is there (3.11 and newer, with its headers) gets the wheel that fits it, with the newest numpy and, for the
older Pythons, with numpy 1; each runs check_wheel.py, as does the Python of a bare Debian 13. mypy judges the types.
test_clusters.py runs on Dask, Ray and S3.
Exit code 77, which CTest takes as skipped: no index of packages is reached.
"""
import os
import shutil
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
sys.path.insert(0, str(ROOT / "tools/wheel"))
from find_pythons import find_makers, find_pythons  # noqa: E402

TYPED = """
import rubble
from rubble import missions
mission: rubble.Mission = rubble.Mission(pile=missions.Pile(layers=2), cameras={"a": missions.Camera(width=64)})
pile: rubble.Pile = rubble.settle(mission, seed=3)
hash_of: int = pile.state_hash
rows: list[dict[str, str]] = rubble.batch(mission, range(3), "out").result()
wrong: str = pile.state_hash
missions.Pile(layers="two")
missions.Pile(layer=2)
"""


def run(*words, **more):
    print("+", *words, flush=True)
    return subprocess.run([str(word) for word in words], **more)


def make_environment(folder, python, *packages):
    shutil.rmtree(folder, ignore_errors=True)
    run(python, "-m", "venv", folder, check=True)
    run(folder / "bin/python", "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--only-binary=:all:", *packages, check=True)
    return folder / "bin/python"


def check_types(python, work):
    (work / "typed.py").write_text(TYPED)
    told = run(python, "-m", "mypy", "--strict", work / "typed.py", capture_output=True, text=True, cwd=work).stdout
    lines = [line.split(":", 2) for line in told.splitlines() if ": error:" in line]
    expected = [TYPED.splitlines().index(line) + 1 for line in TYPED.splitlines()[-3:]]
    assert [int(line[1]) for line in lines] == expected, told
    run(python, "-m", "mypy", "-p", "rubble", check=True, cwd=work)
    # nanobind's functions and classes are of types of their own: of these, the members alone are compared.
    (work / "allowed.txt").write_text("rubble\\._core\\.\\w+(\\.__init__)?\n")
    run(python, "-m", "mypy.stubtest", "rubble._core", "--ignore-missing-stub", "--ignore-positional-only", "--allowlist", work / "allowed.txt",
        check=True, cwd=work)


def check_in_bare_debian(work, wheels):
    """Debian 13 with nothing but its Python: no package of ours, no network, and a user who may not write elsewhere."""
    root, tools = work / "debian13", ROOT / "tools/package"
    run(tools / "make_root.sh", root, "", "trixie", check=True)
    run("chroot", root, "/bin/sh", "-c", "python3 -c 'import venv, ensurepip' 2>/dev/null || "
        "(apt-get -q update && apt-get -q -y --no-install-recommends install python3-venv)", check=True, stdout=subprocess.DEVNULL)
    place = root / "tmp/wheel"
    shutil.rmtree(place, ignore_errors=True)
    run(sys.executable, "-m", "pip", "download", "--quiet", "--only-binary=:all:", "--python-version", "3.13", "--dest", place / "packages",
        "--find-links", wheels, "rubble-sim", "numpy", "-r", HERE / "requirements-wheel.txt", check=True)
    shutil.copy(HERE / "check_wheel.py", place)
    place.chmod(0o777)
    run(tools / "run_in_root.sh", root, "cd /tmp/wheel && python3 -m venv made && mkdir try && made/bin/python -m pip install --quiet --no-index "
        "--find-links packages rubble-sim gymnasium && made/bin/python -I check_wheel.py try", check=True)


def main():
    build, work = (Path(word).resolve() for word in sys.argv[1:3])
    work.mkdir(parents=True, exist_ok=True)
    if run(sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", "--dest", work / "reached", "nanobind==3.1.0").returncode:
        print("no index of packages is reached")
        return 77
    pythons, wheels = find_pythons(), work / "wheels"
    shutil.rmtree(wheels, ignore_errors=True)
    run(ROOT / "tools/wheel/make_wheels.sh", build, wheels, *find_makers(pythons), check=True)
    for wheel in wheels.iterdir():
        run(sys.executable, "-m", "zipfile", "-t", wheel, check=True)
    locked = ["-r", HERE / "requirements-wheel.txt"]
    for minor, python in sorted(pythons.items()):
        for numpy in ["numpy>=2"] + ["numpy<2"] * (minor <= 12):
            made = make_environment(work / f"python{minor}", python, "--find-links", wheels, "rubble-sim", numpy, *locked)
            (work / "try").mkdir(exist_ok=True)
            shutil.rmtree(work / "try")
            (work / "try").mkdir()
            run(made, "-I", HERE / "check_wheel.py", work / "try", "--frames", check=True, cwd=work, env={"PATH": "/usr/bin:/bin", "HOME": str(work)})
    if os.geteuid() == 0 and shutil.which("debootstrap"):
        check_in_bare_debian(work, wheels)
    else:
        print("no bare Debian 13: it needs root and debootstrap")
    newest = work / f"python{max(pythons)}" / "bin/python"
    run(newest, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "mypy==2.4.1", check=True)
    check_types(newest, work)
    made = make_environment(work / "clusters", pythons[min(pythons)], "--find-links", wheels, "rubble-sim", "-r", HERE / "requirements-clusters.txt")
    run(made, HERE / "test_clusters.py", "-v", check=True, cwd=work)
    return 0


if __name__ == "__main__":
    sys.exit(main())
