#!/usr/bin/python3
"""Lets Cycles, the path tracer of Blender, judge ours: judge_scenes traces views with plain surfaces and
writes them, Cycles draws the same, and this prints how far the images are apart (docs/development/reference_renderer.md).

usage: bench/images/cycles_judge.py [--only NAME] [--size PIXELS] [--samples N] [--out DIR] [--document]

Exit status: 0 every view is within the limit; 1 a view is not, or a program failed; 2 bad usage.
"""
import argparse
import json
import os
import pathlib
import shutil
import subprocess
import sys
import time

from judge_measures import compare, read_pfm

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
PAGE = ROOT / "docs/development/reference_renderer.md"
sys.path.insert(0, str(ROOT / "tools"))
import document_marks  # noqa: E402

# One view again, with mirrors in place of matt surfaces.
MIRROR_VIEW, MIRROR_ROUGHNESS = "heap_noon", "0.2"
HEAD = """| view | mean error | mean difference | largest error | time of ours / of Cycles |
|---|---|---|---|---|
"""


def parse():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--only", default="", help="only views whose name has this in it")
    p.add_argument("--size", type=int, default=256, help="side of the square images, pixels; default: 256")
    p.add_argument("--samples", type=int, default=512, help="paths a pixel, of both; default: 512")
    p.add_argument("--limit", type=float, default=3, help="of the mean error, per cent; default: 3")
    p.add_argument("--threads", type=int, default=0, help="of both; default: all processors")
    p.add_argument("--out", default=str(ROOT / "out" / "judge"), help="default: out/judge")
    p.add_argument("--build", default=str(ROOT / "build" / "release"), help="where judge_scenes is")
    p.add_argument("--blender", default="blender", help="the program")
    p.add_argument("--document", nargs="?", const=str(PAGE), metavar="PAGE",
                   help="write the table of docs/development/reference_renderer.md, or of another page")
    return p.parse_args()


def find_program(name, advice):
    found = shutil.which(name)
    if not found:
        sys.exit("cycles_judge: there is no program %s: %s" % (name, advice))
    return found


def run_blender(blender, *words):
    """With nobody's settings."""
    return subprocess.run([blender, "--background", "--factory-startup", "--python-exit-code", "1", *words],
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)


def check_cycles(blender):
    """Debian builds Blender with Cycles and the importer of glTF; other builds may lack them."""
    code = "import bpy; bpy.context.scene.render.engine = 'CYCLES'; bpy.ops.import_scene.gltf.get_rna_type()"
    run = run_blender(blender, "--python-expr", code)
    if run.returncode != 0:
        sys.exit("cycles_judge: %s lacks Cycles or the importer of glTF, which Debian's packages blender, "
                 "blender-data and python3-numpy have:\n%s" % (blender, run.stdout))


def trace_ours(options):
    """The names of the views."""
    names = run_judge_scenes(options, "--only", options.only)
    if options.only in MIRROR_VIEW + "_mirror":
        names += run_judge_scenes(options, "--only", MIRROR_VIEW, "--mirror", MIRROR_ROUGHNESS)
    if not names:
        sys.exit("cycles_judge: no view has %r in its name" % options.only)
    return names


def run_judge_scenes(options, *words):
    program = find_program(str(pathlib.Path(options.build) / "judge_scenes"),
                           "build it by cmake --build build/release --target judge_scenes")
    numbers = [word for key in ("size", "samples", "threads") for word in ("--" + key, str(getattr(options, key)))]
    run = subprocess.run([program, "--out", options.out, *numbers, *words], cwd=ROOT, stdout=subprocess.PIPE,
                         text=True)
    if run.returncode != 0:
        sys.exit("cycles_judge: judge_scenes ended with status %d" % run.returncode)
    return run.stdout.split()


def draw_by_cycles(blender, view, out, samples, threads):
    """Seconds that it took, with loading."""
    start = time.monotonic()
    run = run_blender(blender, "--threads", str(threads), "--python", str(HERE / "cycles_render.py"), "--",
                      str(view), str(out), str(samples))
    if run.returncode != 0 or not os.path.exists(out):
        sys.exit("cycles_judge: Blender did not draw %s:\n%s" % (view, run.stdout[-4000:]))
    return time.monotonic() - start


def judge(blender, name, options):
    """What compare() gives, and the times."""
    folder = pathlib.Path(options.out)
    view = json.loads((folder / (name + ".json")).read_text())
    theirs = folder / (name + "_cycles.pfm")
    theirs.unlink(missing_ok=True)
    seconds = draw_by_cycles(blender, folder / (name + ".json"), theirs, options.samples, options.threads)
    found = compare(read_pfm(folder / view["ours"]), read_pfm(theirs))
    return dict(found, ours_s=view["seconds"], cycles_s=seconds)


def row(name, found):
    errors = tuple(100 * found[key] for key in ("mean", "signed", "worst"))
    return "| `%s` | %.2f %% | %+.2f %% | %.1f %% | %.0f s / %.0f s |\n" % (
        name, *errors, found["ours_s"], found["cycles_s"])


def main():
    options = parse()
    blender = find_program(options.blender, "install Debian's package blender (tools/packages-nightly.txt)")
    check_cycles(blender)
    found = {}
    names = trace_ours(options)
    print(HEAD, end="", flush=True)
    for name in names:
        found[name] = judge(blender, name, options)
        print(row(name, found[name]), end="", flush=True)
    if options.document:
        text = HEAD + "".join(row(name, each) for name, each in found.items())
        document_marks.write_between_marks(options.document, "cycles", text)
    beyond = [name for name, each in found.items() if not 100 * each["mean"] <= options.limit]
    if beyond:
        sys.exit("cycles_judge: beyond the limit of %g %%: %s" % (options.limit, ", ".join(beyond)))


if __name__ == "__main__":
    main()
