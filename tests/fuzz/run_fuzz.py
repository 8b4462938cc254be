#!/usr/bin/env python3
"""Runs every fuzz target for a time: run_fuzz.py BUILD CORPUS SECONDS [TARGET...]

Prints a table of executions, and every finding with the file that makes it. Exit code 1: there was
one. What a target learns stays in BUILD/corpus/TARGET. Environment: JOBS, targets at once, usually 2;
RUNS, executions of each target after which it ends, also before its time.
"""
import concurrent.futures
import os
import re
import subprocess
import sys
from pathlib import Path

# Of targets whose work is done in a child that may crash: its death is no finding.
ISOLATED = ("mesh_dae", "picture_exr", "picture_png", "rawlog")
# The small quarantine and the short stacks of allocations double the speed.
ASAN_OPTIONS = "detect_leaks=0:quarantine_size_mb=8:malloc_context_size=2:max_malloc_fill_size=0"
# A child that runs out of memory gets std::bad_alloc where that can be, and dies without words.
ISOLATED_OPTIONS = (":allocator_may_return_null=1:symbolize=0:handle_segv=0:handle_abort=0"
                    ":handle_sigbus=0:handle_sigfpe=0")
# The longest inputs worth their time, where that is not twice the longest seed. unit: byte
LONGEST = {"override": 256, "mission": 4096, "source_map": 4096}


def longest(corpus, target):
    return LONGEST.get(target, max(512, 2 * max(f.stat().st_size for f in (corpus / target).iterdir())))


def fuzz(build, corpus, seconds, target):
    grown = build / "corpus" / target
    findings = build / "findings" / target
    for folder in (grown, findings):
        folder.mkdir(parents=True, exist_ok=True)
    environment = dict(os.environ, ASAN_OPTIONS=ASAN_OPTIONS, UBSAN_OPTIONS="print_stacktrace=1")
    call = [str(build / f"fuzz_{target}"), f"-max_total_time={seconds}", f"-timeout={120 if target in ISOLATED else 20}",
            # The limit is watched by a thread, which may hold locks of the sanitizer's at a fork.
            f"-rss_limit_mb={0 if target in ISOLATED else 4096}", "-malloc_limit_mb=2048", "-print_final_stats=1",
            f"-max_len={longest(corpus, target)}", "-entropic=0", "-reload=0",
            f"-runs={os.environ.get('RUNS', '-1')}", f"-artifact_prefix={findings}/", str(grown), str(corpus / target)]
    if target in ISOLATED:
        environment["ASAN_OPTIONS"] += ISOLATED_OPTIONS
        call[1:1] = ["-handle_segv=0", "-handle_abrt=0", "-handle_bus=0", "-handle_fpe=0",
                     "-handle_ill=0", "-handle_xfsz=0"]
    done = subprocess.run(call, env=environment, capture_output=True, text=True, errors="replace",
                          preexec_fn=lambda: os.nice(10))
    executed = re.findall(r"number_of_executed_units: (\d+)|^#(\d+)\s", done.stderr, re.MULTILINE)
    count = max((int(a or b) for a, b in executed), default=0)
    (findings / "log").write_text(done.stderr)
    return target, count, done.returncode, sorted(
        f for f in findings.iterdir() if re.match(r"(crash|oom|timeout|leak)-", f.name))


def main():
    build, corpus, seconds = Path(sys.argv[1]), Path(sys.argv[2]), int(sys.argv[3])
    targets = sys.argv[4:] or sorted(p.name[5:] for p in build.glob("fuzz_*") if p.is_file())
    bad, total = False, 0
    with concurrent.futures.ThreadPoolExecutor(int(os.environ.get("JOBS", "2"))) as pool:
        for result in pool.map(lambda t: fuzz(build, corpus, seconds, t), targets):
            target, count, code, findings = result
            total += count
            print(f"{target:16} {count:>12,} executions", "" if code == 0 else f" exit {code}",
                  flush=True)
            for file in findings:
                print(f"  {file}")
            bad = bad or code != 0 or bool(findings)
    print(f"{'all':16} {total:>12,} executions")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
