"""Damaged files of other programs: each is refused with its name, or read: damage.py PROGRAM FOLDER

Valid files of plans.py and packs.py are torn, disturbed by bytes, and by numbers and words of their texts. Each is imported in
a process of its own (a fork, as importing the readers takes seconds). Right are exit code 0, with finite numbers written,
and 1, with one message that names the tool and the file; a traceback, a signal and silence are wrong.
"""
import contextlib
import os
import random
import re
import shutil
import sys
import tempfile
from pathlib import Path

TRIES = 25  # of each file and kind of damage
SECONDS = 60
NUMBERS = [b"nan", b"inf", b"-1e300", b"1e30", b"0", b"-1", b"", b"99999999999999999999", b"$", b"'", b"x"]


def need(condition, text, *values):
    if not condition:
        raise AssertionError(text % values if values else text)


def torn(content, chance):
    return content[:chance.randrange(len(content))]


def with_bytes(content, chance):
    changed = bytearray(content)
    for _ in range(chance.choice((1, 3, 30))):
        changed[chance.randrange(len(changed))] = chance.randrange(256)
    return bytes(changed)


def with_numbers(content, chance):
    found = list(re.finditer(rb"-?\d+\.?\d*(?:[eE][-+]?\d+)?", content))
    place = chance.choice(found)
    return content[:place.start()] + chance.choice(NUMBERS) + content[place.end():]


def without_lines(content, chance):
    lines = content.split(b"\n")
    for _ in range(chance.choice((1, 2, 5))):
        del lines[chance.randrange(len(lines))]
        if not lines:
            break
    return b"\n".join(lines)


def with_words(content, chance):
    """Two words of the file change places."""
    found = list(re.finditer(rb"[A-Za-z_#][A-Za-z_0-9]{2,}", content))
    if len(found) < 2:
        return content[1:]
    first, second = sorted(chance.sample(found, 2), key=lambda m: m.start())
    return content[:first.start()] + second.group() + content[first.end():second.start()] + first.group() + content[second.end():]


def call(tool, arguments):
    """(exit status, what it said), of a child."""
    with tempfile.TemporaryFile() as said:
        child = os.fork()
        if child == 0:
            import signal
            signal.alarm(SECONDS)
            os.dup2(said.fileno(), 2)
            os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
            code = 99
            try:
                code = tool(arguments)
            except BaseException as error:  # pylint: disable=broad-except
                os.write(2, f"Traceback: {type(error).__name__}: {error}".encode())
            with contextlib.suppress(Exception):
                sys.stderr.flush()
            os._exit(code if isinstance(code, int) else 98)
        status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        said.seek(0)
        return status, said.read().decode("utf-8", "replace")


def judge(tool, path, out, name):
    """What is wrong, or "" and the exit code."""
    shutil.rmtree(out, ignore_errors=True)
    out.unlink(missing_ok=True)
    status, said = call(tool, [str(path), "-o", str(out)])
    if status not in (0, 1):
        return f"exit status {status}: {said.strip()[-300:]}", status
    if status == 1:
        lines = [line for line in said.splitlines() if line.startswith(name + ":")]
        if len(lines) != 1 or path.name not in lines[0] or "Traceback" in said:
            return f"no message, or none that names the file: {said.strip()[-300:]!r}", status
        return "", status
    for file in out.rglob("*.*") if out.is_dir() else [out]:
        text = file.read_text(encoding="utf-8")
        if re.search(r"(?i)\b(nan|inf)\b", "\n".join(line for line in text.splitlines() if not line.lstrip().startswith(("#", "--")))):
            return f"{file.name} has a number that is none", status
    return "", status


def disturb(folder, path, tool, name, beside=()):
    """One file, damaged in every way; beside: others that it refers to, damaged alike."""
    chance, wrong, codes = random.Random(str(path.name)), [], {0: 0, 1: 0}
    work = folder / "damaged"
    need(judge(tool, path, folder / ("out_" + path.stem), name) == ("", 0), "%s is not read as it is", path.name)
    for file in (path, *beside):
        original = file.read_bytes()
        for damage in (torn, with_bytes, with_numbers, without_lines, with_words):
            for number in range(TRIES):
                shutil.rmtree(work, ignore_errors=True)
                work.mkdir()
                for whole in (path, *beside):
                    shutil.copy(whole, work)
                (work / file.name).write_bytes(damage(original, chance))
                mistake, code = judge(tool, work / path.name, folder / ("out_" + path.stem), name)
                codes[code] = codes.get(code, 0) + 1
                if mistake:
                    kept = folder / f"wrong_{path.stem}_{damage.__name__}_{number}{file.suffix}"
                    shutil.copy(work / file.name, kept)
                    wrong.append(f"{kept.name}: {mistake}")
    print(f"   {path.name}: {codes[0]} read, {codes[1]} refused, {len(wrong)} wrong")
    return wrong


def make_usd(folder, ending):
    import packs
    from pxr import Gf, Usd, UsdGeom
    stage = Usd.Stage.CreateNew(str(folder / f"scene.{ending}"))
    UsdGeom.SetStageMetersPerUnit(stage, 0.01)
    packs.add_box(stage, "/Lump/mesh", (20, 30, 40)).CreateDisplayColorAttr([Gf.Vec3f(0.5, 0.25, 0)])
    packs.add_box(stage, "/Other", (10, 10, 10)).AddScaleOp().Set(Gf.Vec3f(-1, 1, 1))
    stage.Save()
    return folder / f"scene.{ending}"


def make_dxf():
    import plans
    document, space = plans.drawing()
    for low, high_x, high_y in ((0, 8000, 5000), (240, 7760, 4760)):
        space.add_lwpolyline([(low, low), (high_x, low), (high_x, high_y), (low, high_y)], close=True, dxfattribs={"layer": "A-WALL"})
    space.add_line((3940, 240), (3940, 4760), dxfattribs={"layer": "A-WALL"})
    space.add_line((4060, 240), (4060, 4760), dxfattribs={"layer": "A-WALL"})
    return plans.save(document, "room.dxf")


def main():
    folder = Path(sys.argv[2])
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "python" / "rubble"))
    import import_pack
    import import_plan
    import mujoco  # noqa: F401  pylint: disable=unused-import  # once, and not in each fork
    import packs
    import plans
    packs.write_mjcf()
    wrong = []
    for tool, name, path, beside in (
            (import_plan.main, "rubble.import_plan", make_dxf(), ()),
            (import_plan.main, "rubble.import_plan", plans.House().build().save("house.ifc"), ()),
            (import_pack.main, "rubble.import_pack", make_usd(folder, "usda"), ()),
            (import_pack.main, "rubble.import_pack", make_usd(folder, "usdc"), ()),
            (import_pack.main, "rubble.import_pack", folder / "model.xml", (folder / "beam.obj",))):
        wrong += disturb(folder, path, tool, name, beside)
    need(not wrong, "%d files:\n%s", len(wrong), "\n".join(wrong))
    print("right: damaged files")


if __name__ == "__main__":
    main()
